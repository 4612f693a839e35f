#include "tet_strains.h"

#include <Eigen/Eigenvalues>

#include <cmath>

namespace tissue {
namespace {

TetStrain tet_strain(Constitution constitution, const Lame& lame, const Mat3& f) {
  Mat3 cauchy = stress(constitution, lame, f);
  // Small strain does not tell Cauchy's stress from the first Piola-Kirchhoff stress.
  if (constitution != Constitution::kLinear) cauchy = cauchy * f.transpose() / f.determinant();
  const Mat3 deviator = cauchy - cauchy.trace() / 3.0 * Mat3::Identity();
  const Eigen::SelfAdjointEigenSolver<Mat3> stretches(f.transpose() * f, Eigen::EigenvaluesOnly);
  return {std::sqrt(1.5) * deviator.norm(), std::sqrt(stretches.eigenvalues()[2]) - 1.0,
          f.determinant()};
}

}  // namespace

std::vector<TetStrain> tet_strains(const FiniteElements& elements, const ElasticEnergy& tissue,
                                   const Eigen::VectorXd& positions) {
  std::vector<TetStrain> result(elements.element_count());
  for (std::size_t t = 0; t < result.size(); ++t) {
    for (const QuadraturePoint& point : elements.quadrature()) {
      const TetStrain here = tet_strain(tissue.constitution(), tissue.lame(t),
                                        tissue.deformation_gradient(t, point, positions));
      result[t].von_mises += point.weight * here.von_mises;
      result[t].largest_strain += point.weight * here.largest_strain;
      result[t].det_f += point.weight * here.det_f;
    }
  }
  return result;
}

}  // namespace tissue
