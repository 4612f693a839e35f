#include "tissue/simulate/spring_energy.h"

#include "tissue/base/topology.h"

namespace tissue {
namespace {

Vec3 node(const Eigen::VectorXd& positions, std::uint32_t i) {
  return positions.segment<3>(3 * Eigen::Index{i});
}

}  // namespace

SpringEnergy::SpringEnergy(const FiniteElements& elements, const std::vector<double>& young) {
  std::vector<Tet> tets(elements.element_count());
  for (std::size_t t = 0; t < tets.size(); ++t) {
    std::copy_n(elements.nodes(t), 4, tets[t].begin());
  }
  const EdgeTopology topology = edge_topology(tets, elements.node_count());
  for (const Edge& ends : topology.edges) {
    springs_.push_back({ends, (elements.rest()[ends[1]] - elements.rest()[ends[0]]).norm(), 0.0});
  }
  for (std::size_t t = 0; t < tets.size(); ++t) {
    for (const std::uint32_t edge : topology.tet_edges[t]) {
      Spring& spring = springs_[edge];
      spring.stiffness += young[t] * elements.volume(t) / (spring.length * spring.length);
    }
  }
}

double SpringEnergy::evaluate(const Eigen::VectorXd& positions, Eigen::VectorXd* gradient,
                              Hessian* hessian) const {
  double sum = 0.0;
  for (const Spring& spring : springs_) {
    const Vec3 span = node(positions, spring.ends[1]) - node(positions, spring.ends[0]);
    const double length = span.norm(), longer = length - spring.length;
    sum += 0.5 * spring.stiffness * longer * longer;
    // Which way a spring without length pushes nobody can say.
    if (gradient != nullptr && length > 0.0) {
      const Vec3 pull = spring.stiffness * longer / length * span;
      gradient->segment<3>(3 * Eigen::Index{spring.ends[0]}) -= pull;
      gradient->segment<3>(3 * Eigen::Index{spring.ends[1]}) += pull;
    }
    if (hessian == nullptr) continue;
    Mat3 block = spring.stiffness * Mat3::Identity();
    if (length > 0.0) {
      const Mat3 along = span * span.transpose() / (length * length);
      const double across = std::max(0.0, longer / length);
      block = spring.stiffness * (along + across * (Mat3::Identity() - along));
    }
    hessian->add(spring.ends[0], spring.ends[0], block);
    hessian->add(spring.ends[1], spring.ends[1], block);
    hessian->add(spring.ends[1], spring.ends[0], -block);
  }
  return sum;
}

}  // namespace tissue
