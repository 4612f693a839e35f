#include "tissue/base/quality.h"

#include "tissue/base/tet_shape.h"

namespace tissue {

DihedralRange dihedral_range(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 ab = b - a, ac = c - a, ad = d - a;
  const TetShape<double> shape =
      tet_shape(ab[0], ab[1], ab[2], ac[0], ac[1], ac[2], ad[0], ad[1], ad[2]);
  if (shape.determinant == 0.0) return {-1.0, 1.0};
  return {shape.lowest, shape.highest};
}

void TetBatch::measure(float* __restrict__ lowest, float* __restrict__ highest) const {
  const int padded = (count_ + 7) / 8 * 8;
  for (int i = 0; i < padded; ++i) {
    const auto& e = edges_;
    const TetShape<float> shape =
        tet_shape(e[0][i], e[1][i], e[2][i], e[3][i], e[4][i], e[5][i], e[6][i], e[7][i], e[8][i]);
    lowest[i] = shape.determinant != 0.0f ? shape.lowest : -1.0f;
    highest[i] = shape.determinant != 0.0f ? shape.highest : 1.0f;
  }
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
