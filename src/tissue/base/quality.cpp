#include "tissue/base/quality.h"

namespace tissue {

DihedralRange dihedral_range(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 ab = b - a, ac = c - a, ad = d - a;
  // Outward normals of the faces opposite a, b, c, d; they add up to zero.
  std::array<Vec3, 4> normals;
  normals[1] = ad.cross(ac);
  normals[2] = ab.cross(ad);
  normals[3] = ac.cross(ab);
  normals[0] = -(normals[1] + normals[2] + normals[3]);
  std::array<double, 4> inverse_length;
  for (int i = 0; i < 4; ++i) {
    const double squared_length = normals[i].squaredNorm();
    if (!(squared_length > 0.0)) return {-1.0, 1.0};
    inverse_length[i] = 1.0 / std::sqrt(squared_length);
  }
  DihedralRange range;
  for (const auto& faces : kTetEdges) {
    const int i = faces[0], j = faces[1];
    const double cosine = -normals[i].dot(normals[j]) * inverse_length[i] * inverse_length[j];
    range.lowest_cosine = std::min(range.lowest_cosine, cosine);
    range.highest_cosine = std::max(range.highest_cosine, cosine);
  }
  return range;
}

double shape_score(const DihedralRange& range) {
  constexpr double degree = 3.14159265358979323846 / 180.0;
  return std::min(range.min_angle() / (10.0 * degree), (180.0 - range.max_angle() / degree) / 15.0);
}

}  // namespace tissue
