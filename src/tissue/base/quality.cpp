#include "tissue/base/quality.h"

namespace tissue {

namespace {

// Normals of a tet's faces, their lengths twice the areas, and what angles between faces come from.
struct Faces {
  std::array<Vec3, 4> normals;
  std::array<double, 4> squared_lengths;
  double determinant;

  Faces(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const Vec3 ab = b - a, ac = c - a, ad = d - a;
    normals[1] = ad.cross(ac);
    normals[2] = ab.cross(ad);
    normals[3] = ac.cross(ab);
    normals[0] = -(normals[1] + normals[2] + normals[3]);
    for (int i = 0; i < 4; ++i) squared_lengths[i] = normals[i].squaredNorm();
    determinant = -normals[3].dot(ad);
  }
  // cos·|cos| of the angle between faces i and j, times the squares of their lengths.
  double signed_square(int i, int j) const {
    const double cosine = -normals[i].dot(normals[j]);
    return cosine * std::abs(cosine);
  }
};

}  // namespace

DihedralRange dihedral_range(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Faces faces(a, b, c, d);
  std::array<double, 4> inverse;
  for (int i = 0; i < 4; ++i) {
    if (!(faces.squared_lengths[i] > 0.0)) return {-1.0, 1.0};
    inverse[i] = 1.0 / faces.squared_lengths[i];
  }
  DihedralRange range;
  for (const auto& [i, j] : kTetEdges) {
    const double square = faces.signed_square(i, j) * inverse[i] * inverse[j];
    range.lowest = std::min(range.lowest, square);
    range.highest = std::max(range.highest, square);
  }
  return range;
}

AngleBounds::AngleBounds(double min_deg, double max_deg) {
  const auto signed_square = [](double degrees) {
    const double cosine = std::cos(degrees * 3.14159265358979323846 / 180.0);
    return cosine * std::abs(cosine);
  };
  highest = signed_square(min_deg);
  lowest = signed_square(max_deg);
}

double shape_score(const DihedralRange& range) {
  constexpr double degree = 3.14159265358979323846 / 180.0;
  return std::min(range.min_angle() / (10.0 * degree), (180.0 - range.max_angle() / degree) / 15.0);
}

}  // namespace tissue
