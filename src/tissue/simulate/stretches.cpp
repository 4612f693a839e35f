#include "stretches.h"

#include "tissue/base/types.h"

#include <Eigen/SVD>

#include <limits>

namespace tissue {
namespace {

using Matrix = LaneMatrix<Lanes>;

// R of F = R S by Newton's iteration (Higham, Computing the Polar Decomposition, 1986), which costs
// less than a singular value decomposition. Returns in which lanes it does not serve, because F is
// nearly singular or inside out.
auto rotation_by_newton(const Matrix& f, Matrix& rotation) {
  constexpr double kFarFromSingular = 1e-3;
  const Lanes size = square_root(dot(f, f));
  const auto regular = determinant(f, cofactor(f)) > kFarFromSingular * size * size * size;
  const Matrix one = identity();
  for_entries([&](int i, int j) { rotation[i][j] = regular ? f[i][j] : one[i][j]; });
  Lanes change = all_lanes(1.0);
  // It converges quadratically: what is left is the square of the last change.
  constexpr double kSmallChange = 1e-16;
  for (int step = 0; step < 20 && any(change >= kSmallChange); ++step) {
    const Matrix cofactors = cofactor(rotation);
    const Lanes inverse = 1.0 / determinant(rotation, cofactors);
    Lanes scale = all_lanes(0.5), inverse_scale = 0.5 * inverse;
    if (step == 0) {
      // So that stretches which are alike vanish at once.
      const Lanes ratio = square_root(
          square_root(dot(cofactors, cofactors) * inverse * inverse / dot(rotation, rotation)));
      scale *= ratio;
      inverse_scale /= ratio;
    }
    change = Lanes{};
    for_entries([&](int i, int j) {
      const Lanes next = scale * rotation[i][j] + inverse_scale * cofactors[i][j];
      const Lanes by = next - rotation[i][j];
      change += by * by;
      rotation[i][j] = next;
    });
  }
  const auto serves = change < kSmallChange;
  return ~(regular & serves);
}

struct Svd {
  Mat3 u, v;
  Vec3 sigma;
};

// Seldom needed, and large: not to be inlined.
__attribute__((noinline)) Svd svd_by_jacobi(const Mat3& f) {
  if (!f.allFinite()) {
    const Mat3 unknown = Mat3::Constant(std::numeric_limits<double>::quiet_NaN());
    return {unknown, unknown, unknown.diagonal()};
  }
  const Eigen::JacobiSVD<Mat3> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Svd result = {svd.matrixU(), svd.matrixV(), svd.singularValues()};
  for (Mat3* basis : {&result.u, &result.v}) {
    if (basis->determinant() >= 0.0) continue;
    basis->col(2) *= -1.0;
    result.sigma[2] *= -1.0;
  }
  return result;
}

void svd_of_lane(const Matrix& f, std::size_t lane, Stretches& result) {
  Mat3 one;
  for_entries([&](int i, int j) { one(i, j) = f[i][j][lane]; });
  const Svd svd = svd_by_jacobi(one);
  for (int i = 0; i < 3; ++i) result.sigma[i][lane] = svd.sigma[i];
  for_entries([&](int i, int j) {
    result.u[i][j][lane] = svd.u(i, j);
    result.v[i][j][lane] = svd.v(i, j);
  });
}

// Calls body(lane) where the mask is set.
template <class Mask, class Body>
void for_lanes(const Mask& mask, const Body& body) {
  if (!any(mask)) return;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    if (mask[lane] != 0) body(lane);
  }
}

// One rotation of Jacobi's that takes away the entry (p, q).
template <int p, int q>
inline void rotate(Matrix& s, Matrix& axes) {
  constexpr int r = 3 - p - q;
  const Lanes apart = s[q][q] - s[p][p], twice = 2.0 * s[p][q];
  const Lanes hypotenuse = square_root(apart * apart + twice * twice);
  constexpr double kTiny = 1e-300;
  const Lanes magnitude = (apart < 0.0 ? -apart : apart) + hypotenuse + kTiny;
  const Lanes tangent = (apart < 0.0 ? -twice : twice) / magnitude;
  const Lanes cosine = 1.0 / square_root(1.0 + tangent * tangent), sine = tangent * cosine;
  const Lanes shift = tangent * s[p][q];
  s[p][p] -= shift;
  s[q][q] += shift;
  s[p][q] = s[q][p] = Lanes{};
  const Lanes at_p = s[r][p], at_q = s[r][q];
  s[r][p] = s[p][r] = cosine * at_p - sine * at_q;
  s[r][q] = s[q][r] = sine * at_p + cosine * at_q;
  for (int i = 0; i < 3; ++i) {
    const Lanes old = axes[i][p];
    axes[i][p] = cosine * old - sine * axes[i][q];
    axes[i][q] = sine * old + cosine * axes[i][q];
  }
}

}  // namespace

Matrix diagonalise(Matrix& s) {
  constexpr double kRounding = 1e-22;
  Matrix axes = identity();
  for (int sweep = 0; sweep < 10; ++sweep) {
    const Lanes off = s[0][1] * s[0][1] + s[0][2] * s[0][2] + s[1][2] * s[1][2];
    const Lanes on = s[0][0] * s[0][0] + s[1][1] * s[1][1] + s[2][2] * s[2][2];
    if (!any(off > kRounding * on)) break;
    rotate<0, 1>(s, axes);
    rotate<0, 2>(s, axes);
    rotate<1, 2>(s, axes);
  }
  return axes;
}

Matrix rotation_of(const Matrix& f) {
  Matrix rotation;
  const auto irregular = rotation_by_newton(f, rotation);
  for_lanes(irregular, [&](std::size_t lane) {
    Stretches by_svd;
    svd_of_lane(f, lane, by_svd);
    const Matrix nearest = product_transpose(by_svd.u, by_svd.v);
    for_entries([&](int i, int j) { rotation[i][j][lane] = nearest[i][j][lane]; });
  });
  return rotation;
}

Stretches stretches_of(const Matrix& f) {
  // The axes are those of FᵀF, whose entries are the stretches' squares: exact enough, and quick,
  // where these are not far apart.
  constexpr double kFarApart = 1e-2;
  Matrix squares = transpose_product(f, f);
  const Lanes trace = squares[0][0] + squares[1][1] + squares[2][2];
  Stretches result;
  result.v = diagonalise(squares);
  result.u = product(f, result.v);
  auto irregular = ~(determinant(f, cofactor(f)) > 0.0);
  for (int k = 0; k < 3; ++k) {
    irregular |= ~(squares[k][k] > kFarApart * trace);
    result.sigma[k] = square_root(larger(squares[k][k], Lanes{}));
    for (int i = 0; i < 3; ++i) result.u[i][k] /= result.sigma[k];
  }
  for_lanes(irregular, [&](std::size_t lane) { svd_of_lane(f, lane, result); });
  return result;
}

}  // namespace tissue
