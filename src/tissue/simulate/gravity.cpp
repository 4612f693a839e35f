#include "tissue/simulate/gravity.h"

namespace tissue {

GravityEnergy::GravityEnergy(const FiniteElements& elements, double mass_density,
                             const Vec3& gravity)
    : weight_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * elements.node_count()))) {
  for (std::size_t e = 0; e < elements.element_count(); ++e) {
    const Vec3 weight = mass_density * elements.volume(e) * gravity;
    for (int a = 0; a < elements.nodes_per_element(); ++a) {
      weight_.segment<3>(3 * Eigen::Index{elements.nodes(e)[a]}) +=
          elements.node_weight(a) * weight;
    }
  }
  for (std::size_t v = 0; v < elements.rigid_volumes().size(); ++v) {
    weight_.segment<3>(static_cast<Eigen::Index>(3 * v)) +=
        mass_density * elements.rigid_volumes()[v] * gravity;
  }
}

}  // namespace tissue
