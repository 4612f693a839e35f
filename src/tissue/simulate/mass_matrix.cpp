#include "tissue/simulate/mass_matrix.h"

#include "element_lanes.h"

namespace tissue {

double MassMatrix::quadratic_share(int a, int b) {
  const bool corner_a = a < 4, corner_b = b < 4;
  if (corner_a && corner_b) return a == b ? 6.0 : 1.0;
  const auto touches = [](const auto& edge, int corner) {
    return edge[0] == corner || edge[1] == corner;
  };
  if (corner_a || corner_b) {
    const int corner = corner_a ? a : b, middle = corner_a ? b : a;
    return touches(kTetEdges[middle - 4], corner) ? -4.0 : -6.0;
  }
  if (a == b) return 32.0;
  const auto& edge = kTetEdges[b - 4];
  return touches(kTetEdges[a - 4], edge[0]) || touches(kTetEdges[a - 4], edge[1]) ? 16.0 : 8.0;
}

MassMatrix::MassMatrix(const FiniteElements& elements, double density)
    : elements_(elements), density_(density), lumped_(elements.vertex_count(), 0.0) {
  for (std::size_t e = 0; e < elements.element_count(); ++e) {
    for (int a = 0; a < 4; ++a)
      lumped_[elements.nodes(e)[a]] += 0.25 * density * elements.volume(e);
  }
  for (std::size_t v = 0; v < elements.rigid_volumes().size(); ++v) {
    lumped_[v] += rigid_at_vertex(v);
  }
}

Eigen::VectorXd MassMatrix::times(const Eigen::VectorXd& x) const {
  Eigen::VectorXd result(x.size());
  if (elements_.order() == 1) {
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      result[i] = lumped_[static_cast<std::size_t>(i / 3)] * x[i];
    }
    return result;
  }
  result.setZero();
  for (std::size_t v = 0; v < elements_.rigid_volumes().size(); ++v) {
    const auto i = static_cast<Eigen::Index>(3 * v);
    result.segment<3>(i) = rigid_at_vertex(v) * x.segment<3>(i);
  }
  for (std::size_t pack = 0; pack < elements_.pack_count(); ++pack) {
    Lanes at_nodes[10][3], forces[10][3] = {};
    gather<2>(elements_, pack, x, at_nodes);
    const Lanes unit = density_ / 420.0 * elements_.pack(pack).volumes;
    add_quadratic_mass(at_nodes, unit, forces);
    scatter<2>(elements_, pack, forces, result);
  }
  return result;
}

}  // namespace tissue
