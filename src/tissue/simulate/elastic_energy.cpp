#include "tissue/simulate/elastic_energy.h"

#include "tissue/base/parallel.h"

namespace tissue {
namespace {

constexpr int kMaxNodes = FiniteElements::kMaxNodes;
// Forces on an element's nodes, a row for each.
using ElementForces = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor, kMaxNodes, 3>;
// Elements whose results are kept until they are added up in order.
constexpr std::size_t kPiece = 512;

template <class Sum>
Mat3 gradient_of(const FiniteElements& elements, std::size_t element, const Sum& shape_gradients,
                 const Eigen::VectorXd& positions) {
  const std::uint32_t* nodes = elements.nodes(element);
  Mat3 f = Mat3::Zero();
  for (int a = 0; a < elements.nodes_per_element(); ++a) {
    f += positions.segment<3>(3 * Eigen::Index{nodes[a]}) * shape_gradients.row(a);
  }
  return f;
}

}  // namespace

Mat3 ElasticEnergy::deformation_gradient(std::size_t element, const QuadraturePoint& point,
                                         const Eigen::VectorXd& positions) const {
  FiniteElements::Gradients gradients;
  elements_.gradients(element, point, gradients);
  return gradient_of(elements_, element, gradients, positions);
}

double ElasticEnergy::value(const Eigen::VectorXd& positions) const {
  const std::size_t count = elements_.element_count();
  std::vector<double> parts((count + kPiece - 1) / kPiece, 0.0);
  parallel_ranges(parts.size(), 1, run_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t part = begin; part < end; ++part) {
      for (std::size_t e = part * kPiece; e < std::min(count, (part + 1) * kPiece); ++e) {
        for (const QuadraturePoint& point : elements_.quadrature()) {
          parts[part] +=
              point.weight * elements_.volume(e) *
              energy_density(constitution_, lame_[e], deformation_gradient(e, point, positions));
        }
      }
    }
  });
  double sum = 0.0;
  for (const double part : parts) sum += part;
  return sum;
}

void ElasticEnergy::add_gradient(const Eigen::VectorXd& positions,
                                 Eigen::VectorXd& gradient) const {
  const auto nodes_per_element = static_cast<std::size_t>(elements_.nodes_per_element());
  std::vector<Vec3> forces(elements_.element_count() * nodes_per_element);
  parallel_ranges(elements_.element_count(), kPiece, run_, [&](std::size_t begin, std::size_t end) {
    FiniteElements::Gradients gradients;
    ElementForces sum;
    for (std::size_t e = begin; e < end; ++e) {
      sum.setZero(elements_.nodes_per_element(), 3);
      for (const QuadraturePoint& point : elements_.quadrature()) {
        elements_.gradients(e, point, gradients);
        const Mat3 f = gradient_of(elements_, e, gradients, positions);
        sum.noalias() += point.weight * elements_.volume(e) *
                         (gradients * stress(constitution_, lame_[e], f).transpose());
      }
      for (std::size_t a = 0; a < nodes_per_element; ++a) {
        forces[e * nodes_per_element + a] = sum.row(static_cast<Eigen::Index>(a));
      }
    }
  });
  const std::vector<std::size_t>& first = elements_.incidence_begin();
  parallel_ranges(elements_.node_count(), 4 * kPiece, run_,
                  [&](std::size_t begin, std::size_t end) {
                    for (std::size_t node = begin; node < end; ++node) {
                      Vec3 sum = Vec3::Zero();
                      for (std::size_t k = first[node]; k < first[node + 1]; ++k) {
                        sum += forces[elements_.incidence()[k]];
                      }
                      gradient.segment<3>(static_cast<Eigen::Index>(3 * node)) += sum;
                    }
                  });
}

void ElasticEnergy::add_hessian(const Eigen::VectorXd& positions, BlockMatrix& hessian) const {
  const int n = elements_.nodes_per_element();
  const auto pairs = static_cast<std::size_t>(n * (n + 1) / 2);
  std::vector<Mat3> blocks(kPiece * pairs);
  for (std::size_t first = 0; first < elements_.element_count(); first += kPiece) {
    const std::size_t count = std::min(kPiece, elements_.element_count() - first);
    parallel_ranges(count, 32, run_, [&](std::size_t begin, std::size_t end) {
      FiniteElements::Gradients gradients;
      for (std::size_t i = begin; i < end; ++i) {
        Mat3* const own = &blocks[i * pairs];
        std::fill(own, own + pairs, Mat3::Zero());
        const std::size_t e = first + i;
        for (const QuadraturePoint& point : elements_.quadrature()) {
          elements_.gradients(e, point, gradients);
          const Mat3 f = gradient_of(elements_, e, gradients, positions);
          const Mat9 stiff =
              point.weight * elements_.volume(e) * convex_stiffness(constitution_, lame_[e], f);
          Mat3* block = own;
          for (int a = 0; a < n; ++a) {
            // The stress that a displacement of node a along each axis makes.
            Eigen::Matrix<double, 9, 3> pull = Eigen::Matrix<double, 9, 3>::Zero();
            for (int axis = 0; axis < 3; ++axis) {
              pull += gradients(a, axis) * stiff.middleCols<3>(3 * axis);
            }
            for (int b = 0; b <= a; ++b) {
              for (int axis = 0; axis < 3; ++axis) {
                *block += gradients(b, axis) * pull.middleRows<3>(3 * axis).transpose();
              }
              ++block;
            }
          }
        }
      }
    });
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t* nodes = elements_.nodes(first + i);
      const Mat3* block = &blocks[i * pairs];
      for (int a = 0; a < n; ++a) {
        for (int b = 0; b <= a; ++b) hessian.add(nodes[a], nodes[b], *block++);
      }
    }
  }
}

}  // namespace tissue
