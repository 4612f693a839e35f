#include "tissue/simulate/elastic_energy.h"

#include "element_lanes.h"
#include "material_tensor.h"
#include "tissue/base/parallel.h"

namespace tissue {
namespace {

// Numbers of packs whose results are kept until they are added up in order.
constexpr std::size_t kPacksAtOnce = 32;

}  // namespace

ElasticEnergy::ElasticEnergy(const FiniteElements& elements, const std::vector<Lame>& lame,
                             Constitution constitution, Run run)
    : elements_(elements),
      lame_(elements.pack_count()),
      constitution_(constitution),
      run_(std::move(run)) {
  for (std::size_t i = 0; i < kLanes * lame_.size(); ++i) {
    const Lame& one = lame[std::min(i, lame.size() - 1)];
    lame_[i / kLanes].mu[i % kLanes] = one.mu;
    lame_[i / kLanes].lambda[i % kLanes] = one.lambda;
  }
}

Mat3 ElasticEnergy::deformation_gradient(std::size_t element, const QuadraturePoint& point,
                                         const Eigen::VectorXd& positions) const {
  FiniteElements::Gradients gradients;
  elements_.gradients(element, point, gradients);
  const std::uint32_t* nodes = elements_.nodes(element);
  Mat3 f = Mat3::Zero();
  for (int a = 0; a < elements_.nodes_per_element(); ++a) {
    f += positions.segment<3>(3 * Eigen::Index{nodes[a]}) * gradients.row(a);
  }
  return f;
}

double ElasticEnergy::evaluate(const Eigen::VectorXd& positions, Eigen::VectorXd* gradient,
                               Hessian* hessian) const {
  return elements_.order() == 1 ? evaluate_order<1>(positions, gradient, hessian)
                                : evaluate_order<2>(positions, gradient, hessian);
}

template <int order>
double ElasticEnergy::evaluate_order(const Eigen::VectorXd& positions, Eigen::VectorXd* gradient,
                                     Hessian* hessian) const {
  struct Forces {
    Lanes at[kNodes<order>][3];
  };
  const std::vector<QuadraturePoint>& points = elements_.quadrature();
  const Respond respond = law_of(constitution_);
  const std::size_t at_once = run_.threads == 1 ? kPacksAtOnce : 16 * kPacksAtOnce;
  std::vector<Lanes> values(at_once);
  std::vector<Forces> forces(gradient != nullptr ? at_once : 0);
  std::vector<MaterialTensor> tensors;
  double sum = 0.0;
  for (std::size_t first = 0; first < elements_.pack_count(); first += at_once) {
    const std::size_t count = std::min(at_once, elements_.pack_count() - first);
    if (hessian != nullptr) tensors.resize(count * points.size());
    parallel_ranges(count, kPacksAtOnce, run_, [&](std::size_t begin, std::size_t end) {
      Lanes nodes[kNodes<order>][3];
      LaneMatrix<Lanes> stress;
      for (std::size_t i = begin; i < end; ++i) {
        const FiniteElements::Pack& pack = elements_.pack(first + i);
        gather<order>(elements_, first + i, positions, nodes);
        values[i] = Lanes{};
        if (gradient != nullptr) forces[i] = {};
        for (std::size_t q = 0; q < points.size(); ++q) {
          const Lanes share = points[q].weight * pack.volumes;
          MaterialTensor* const tensor =
              hessian != nullptr ? &tensors[i * points.size() + q] : nullptr;
          values[i] += share * respond(lame_[first + i],
                                       gradient_at<order>(points[q], pack.gradients, nodes),
                                       gradient != nullptr ? &stress : nullptr, tensor, true);
          if (tensor != nullptr) scale(*tensor, share);
          if (gradient == nullptr) continue;
          for_entries([&](int r, int c) { stress[r][c] *= share; });
          add_forces<order>(points[q], pack.gradients, stress, forces[i].at);
        }
      }
    });
    for (std::size_t i = 0; i < count; ++i) {
      sum += sum_of(values[i]);
      if (gradient != nullptr) scatter<order>(elements_, first + i, forces[i].at, *gradient);
    }
    if (hessian != nullptr) hessian->add_elements(first, tensors);
  }
  return sum;
}

}  // namespace tissue
