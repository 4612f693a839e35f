#include "tissue/simulate/constitutive.h"

#include "material_tensor.h"

namespace tissue {
namespace {

using Matrix = LaneMatrix<Lanes>;

LameLanes in_all_lanes(const Lame& lame) { return {all_lanes(lame.mu), all_lanes(lame.lambda)}; }

Matrix in_all_lanes(const Mat3& f) {
  Matrix result;
  for_entries([&](int i, int j) { result[i][j] = all_lanes(f(i, j)); });
  return result;
}

Mat3 first_lane(const Matrix& m) {
  Mat3 result;
  for_entries([&](int i, int j) { result(i, j) = m[i][j][0]; });
  return result;
}

Mat9 any_stiffness(Constitution constitution, const Lame& lame, const Mat3& f, bool convex) {
  MaterialTensor tensor;
  law_of(constitution)(in_all_lanes(lame), in_all_lanes(f), nullptr, &tensor, convex);
  Mat9 result;
  for (int column = 0; column < 9; ++column) {
    Matrix change = {};
    change[column % 3][column / 3] = all_lanes(1.0);
    const Mat3 answer = first_lane(product(tensor, change));
    result.col(column) = Eigen::Map<const Eigen::Matrix<double, 9, 1>>(answer.data());
  }
  return result;
}

}  // namespace

Lame lame_of(double young, double poisson) {
  return {young / (2.0 * (1.0 + poisson)),
          young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson))};
}

Mat3 nearest_rotation(const Mat3& f) { return first_lane(rotation_of(in_all_lanes(f))); }

double energy_density(Constitution constitution, const Lame& lame, const Mat3& f) {
  return law_of(constitution)(in_all_lanes(lame), in_all_lanes(f), nullptr, nullptr, true)[0];
}

Mat3 stress(Constitution constitution, const Lame& lame, const Mat3& f) {
  Matrix result;
  law_of(constitution)(in_all_lanes(lame), in_all_lanes(f), &result, nullptr, true);
  return first_lane(result);
}

Mat9 stiffness(Constitution constitution, const Lame& lame, const Mat3& f) {
  return any_stiffness(constitution, lame, f, false);
}

Mat9 convex_stiffness(Constitution constitution, const Lame& lame, const Mat3& f) {
  return any_stiffness(constitution, lame, f, true);
}

}  // namespace tissue
