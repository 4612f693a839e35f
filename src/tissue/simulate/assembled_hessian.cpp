#include "tissue/simulate/assembled_hessian.h"

#include "pair_blocks.h"
#include "tissue/simulate/mass_matrix.h"

namespace tissue {
namespace {

std::vector<std::uint32_t> nodes_of(const FiniteElements& elements) {
  const std::uint32_t* nodes = elements.nodes(0);
  const auto count =
      elements.element_count() * static_cast<std::size_t>(elements.nodes_per_element());
  return {nodes, nodes + count};
}

}  // namespace

AssembledHessian::AssembledHessian(const FiniteElements& elements)
    : elements_(elements),
      matrix_(elements.node_count(), nodes_of(elements), elements.nodes_per_element()) {}

void AssembledHessian::add_mass(const MassMatrix& mass, double factor) {
  mass.for_each_pair([&](std::uint32_t a, std::uint32_t b, double kilograms) {
    matrix_.add(a, b, factor * kilograms * Mat3::Identity());
  });
}

void AssembledHessian::add_elements(std::size_t first_pack,
                                    const std::vector<MaterialTensor>& tensors) {
  elements_.order() == 1 ? add_elements_of_order<1>(first_pack, tensors)
                         : add_elements_of_order<2>(first_pack, tensors);
}

template <int order>
void AssembledHessian::add_elements_of_order(std::size_t first_pack,
                                             const std::vector<MaterialTensor>& tensors) {
  const std::vector<QuadraturePoint>& points = elements_.quadrature();
  for (std::size_t i = 0; i < tensors.size() / points.size(); ++i) {
    const std::size_t pack = first_pack + i;
    PairBlocks<order> blocks;
    for (std::size_t q = 0; q < points.size(); ++q) {
      blocks.add(points[q], elements_.pack(pack).gradients, tensors[i * points.size() + q]);
    }
    for (std::size_t lane = 0; lane < elements_.lanes_in_use(pack); ++lane) {
      const std::uint32_t* nodes = elements_.nodes(kLanes * pack + lane);
      const LaneMatrix<Lanes>* block = blocks.of;
      for (int a = 0; a < kNodes<order>; ++a) {
        for (int b = 0; b < a; ++b, ++block) {
          Mat3 one;
          for_entries([&](int r, int c) { one(r, c) = (*block)[r][c][lane]; });
          matrix_.add(nodes[a], nodes[b], one);
          matrix_.add(nodes[a], nodes[a], -one);
          matrix_.add(nodes[b], nodes[b], -one.transpose());
        }
      }
    }
  }
}

}  // namespace tissue
