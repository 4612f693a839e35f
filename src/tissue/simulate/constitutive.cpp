#include "tissue/simulate/constitutive.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

#include <cmath>
#include <optional>

namespace tissue {
namespace {

Mat3 cofactor(const Mat3& f) {
  Mat3 result;
  result.col(0) = f.col(1).cross(f.col(2));
  result.col(1) = f.col(2).cross(f.col(0));
  result.col(2) = f.col(0).cross(f.col(1));
  return result;
}

// R of F = R S by Newton's iteration (Higham, Computing the Polar Decomposition, 1986), which costs
// less than a singular value decomposition. Nothing where F is nearly singular or inside out.
std::optional<Mat3> rotation_by_newton(const Mat3& f) {
  constexpr double kFarFromSingular = 1e-3;
  const double size = f.norm();
  if (!(f.determinant() > kFarFromSingular * size * size * size)) return std::nullopt;
  Mat3 rotation = f;
  for (int i = 0; i < 20; ++i) {
    const Mat3 inverse_transpose = cofactor(rotation) / rotation.determinant();
    // Scaled, so that stretches that are alike vanish at once.
    const double scale = std::sqrt(inverse_transpose.norm() / rotation.norm());
    const Mat3 next = 0.5 * (scale * rotation + inverse_transpose / scale);
    const double change = (next - rotation).squaredNorm();
    rotation = next;
    // It converges quadratically: what is left is the square of the last change.
    if (change < 1e-16) return rotation;
  }
  return std::nullopt;
}

// F = U diag(σ) Vᵀ with rotations U and V; one σ is negative where F turns inside out.
struct RotationSvd {
  Mat3 u, v;
  Vec3 sigma;
};

RotationSvd svd_by_jacobi(const Mat3& f) {
  const Eigen::JacobiSVD<Mat3> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
  RotationSvd result = {svd.matrixU(), svd.matrixV(), svd.singularValues()};
  for (Mat3* basis : {&result.u, &result.v}) {
    if (basis->determinant() >= 0.0) continue;
    basis->col(2) *= -1.0;
    result.sigma[2] *= -1.0;
  }
  return result;
}

RotationSvd rotation_svd(const Mat3& f) {
  const std::optional<Mat3> rotation = rotation_by_newton(f);
  if (!rotation) return svd_by_jacobi(f);
  const Mat3 stretch = rotation->transpose() * f;
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(0.5 * (stretch + stretch.transpose()));
  Mat3 axes = eigen.eigenvectors();
  if (axes.determinant() < 0.0) axes.col(0) *= -1.0;
  return {*rotation * axes, axes, eigen.eigenvalues()};
}

// What an isotropic energy is in terms of the principal stretches: Kim and Eberle, Dynamic
// Deformables, SIGGRAPH 2020 Courses, section 7. The stiffness has the block `scaling` on
// stretches, and for each pair of axes one eigenvalue for the flip and one for the twist in their
// plane. Pair k leaves axis k out.
struct PrincipalStiffness {
  Mat3 scaling;
  Vec3 flip, twist;
};

// Parameters of the stable energy that give small strains the stiffness of Lamé's.
struct StableParameters {
  double mu, lambda, alpha;
  explicit StableParameters(const Lame& lame)
      : mu(4.0 / 3.0 * lame.mu),
        lambda(lame.lambda + 5.0 / 6.0 * lame.mu),
        alpha(1.0 + 0.75 * mu / lambda) {}
};

PrincipalStiffness corotational_stiffness(const Lame& lame, const Vec3& sigma) {
  PrincipalStiffness result;
  result.scaling = Mat3::Constant(lame.lambda);
  result.scaling.diagonal().array() += 2.0 * lame.mu;
  result.flip = Vec3::Constant(2.0 * lame.mu);
  const double pull = lame.lambda * (sigma.sum() - 3.0) - 2.0 * lame.mu;
  for (int k = 0; k < 3; ++k) {
    // The rotation is not defined where two stretches cancel; there any steep value will do.
    const double sum = sigma[(k + 1) % 3] + sigma[(k + 2) % 3];
    const double least = 1e-9 * (1.0 + sigma.cwiseAbs().maxCoeff());
    result.twist[k] =
        2.0 * lame.mu + 2.0 * pull / std::copysign(std::max(std::abs(sum), least), sum);
  }
  return result;
}

PrincipalStiffness neo_hookean_stiffness(const Lame& lame, const Vec3& sigma) {
  const StableParameters p(lame);
  const double rest = sigma.squaredNorm() + 1.0, shear = p.mu * (1.0 - 1.0 / rest);
  const double j = sigma.prod(), pressure = p.lambda * (j - p.alpha);
  const Vec3 minors(sigma[1] * sigma[2], sigma[2] * sigma[0], sigma[0] * sigma[1]);
  PrincipalStiffness result;
  result.scaling = shear * Mat3::Identity() +
                   2.0 * p.mu / (rest * rest) * sigma * sigma.transpose() +
                   p.lambda * minors * minors.transpose();
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j_axis = (k + 2) % 3;
    result.scaling(i, j_axis) += pressure * sigma[k];
    result.scaling(j_axis, i) += pressure * sigma[k];
    result.flip[k] = shear - pressure * sigma[k];
    result.twist[k] = shear + pressure * sigma[k];
  }
  return result;
}

Mat9 assembled(const RotationSvd& svd, PrincipalStiffness principal, bool convex) {
  if (convex) {
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(principal.scaling);
    principal.scaling = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() *
                        eigen.eigenvectors().transpose();
    principal.flip = principal.flip.cwiseMax(0.0);
    principal.twist = principal.twist.cwiseMax(0.0);
  }
  using Vec9 = Eigen::Matrix<double, 9, 1>;
  // u_i v_jᵀ, column by column.
  const auto mode = [&](int i, int j) {
    Vec9 result;
    for (int column = 0; column < 3; ++column) {
      result.segment<3>(3 * column) = svd.v(column, j) * svd.u.col(i);
    }
    return result;
  };
  Eigen::Matrix<double, 9, 9> modes, weighted;
  for (int i = 0; i < 3; ++i) modes.col(i) = mode(i, i);
  weighted.leftCols<3>() = modes.leftCols<3>() * principal.scaling;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const Vec9 ij = mode(i, j), ji = mode(j, i);
    modes.col(3 + k) = std::sqrt(0.5) * (ij + ji);
    modes.col(6 + k) = std::sqrt(0.5) * (ij - ji);
    weighted.col(3 + k) = principal.flip[k] * modes.col(3 + k);
    weighted.col(6 + k) = principal.twist[k] * modes.col(6 + k);
  }
  return weighted * modes.transpose();
}

Mat9 linear_stiffness(const Lame& lame) {
  Mat9 result = Mat9::Zero();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      // Row and column of F go to 3 column + row.
      result(3 * j + i, 3 * j + i) += lame.mu;
      result(3 * j + i, 3 * i + j) += lame.mu;
      result(4 * i, 4 * j) += lame.lambda;
    }
  }
  return result;
}

Mat9 any_stiffness(Constitution constitution, const Lame& lame, const Mat3& f, bool convex) {
  if (constitution == Constitution::kLinear) return linear_stiffness(lame);
  const RotationSvd svd = rotation_svd(f);
  return assembled(svd,
                   constitution == Constitution::kCorotational
                       ? corotational_stiffness(lame, svd.sigma)
                       : neo_hookean_stiffness(lame, svd.sigma),
                   convex);
}

}  // namespace

Lame lame_of(double young, double poisson) {
  return {young / (2.0 * (1.0 + poisson)),
          young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson))};
}

Mat3 nearest_rotation(const Mat3& f) {
  if (const std::optional<Mat3> rotation = rotation_by_newton(f)) return *rotation;
  const RotationSvd svd = svd_by_jacobi(f);
  return svd.u * svd.v.transpose();
}

double energy_density(Constitution constitution, const Lame& lame, const Mat3& f) {
  switch (constitution) {
    case Constitution::kLinear: {
      const Mat3 strain = 0.5 * (f + f.transpose()) - Mat3::Identity();
      return lame.mu * strain.squaredNorm() + 0.5 * lame.lambda * strain.trace() * strain.trace();
    }
    case Constitution::kCorotational: {
      const Mat3 rotation = nearest_rotation(f);
      const double trace = rotation.cwiseProduct(f).sum() - 3.0;
      return lame.mu * (f - rotation).squaredNorm() + 0.5 * lame.lambda * trace * trace;
    }
    case Constitution::kNeoHookean: {
      const StableParameters p(lame);
      const auto at = [&](double squares, double j) {
        return 0.5 * p.mu * (squares - 3.0 - std::log(squares + 1.0)) +
               0.5 * p.lambda * (j - p.alpha) * (j - p.alpha);
      };
      return at(f.squaredNorm(), f.determinant()) - at(3.0, 1.0);
    }
  }
  return 0.0;
}

Mat3 stress(Constitution constitution, const Lame& lame, const Mat3& f) {
  switch (constitution) {
    case Constitution::kLinear: {
      const Mat3 strain = 0.5 * (f + f.transpose()) - Mat3::Identity();
      return 2.0 * lame.mu * strain + lame.lambda * strain.trace() * Mat3::Identity();
    }
    case Constitution::kCorotational: {
      const Mat3 rotation = nearest_rotation(f);
      return 2.0 * lame.mu * (f - rotation) +
             lame.lambda * (rotation.cwiseProduct(f).sum() - 3.0) * rotation;
    }
    case Constitution::kNeoHookean: {
      const StableParameters p(lame);
      return p.mu * (1.0 - 1.0 / (f.squaredNorm() + 1.0)) * f +
             p.lambda * (f.determinant() - p.alpha) * cofactor(f);
    }
  }
  return Mat3::Zero();
}

Mat9 stiffness(Constitution constitution, const Lame& lame, const Mat3& f) {
  return any_stiffness(constitution, lame, f, false);
}

Mat9 convex_stiffness(Constitution constitution, const Lame& lame, const Mat3& f) {
  return any_stiffness(constitution, lame, f, true);
}

}  // namespace tissue
