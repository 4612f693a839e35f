#include "solver_choice.h"

#include "tissue/simulate/multigrid_system.h"
#include "tissue/simulate/quadratic_system.h"

#include <utility>

namespace tissue {

Constitution constitution_of(Model model) {
  switch (model) {
    case Model::kLinear: return Constitution::kLinear;
    case Model::kCorotational: return Constitution::kCorotational;
    default: return Constitution::kNeoHookean;
  }
}

std::unique_ptr<Equilibrium> equilibrium_for(const SceneDescription& scene,
                                             const FiniteElements& elements,
                                             std::vector<const Energy*> energies, bool is_quadratic,
                                             const Run& run) {
  constexpr std::size_t kFewNodes = 500;
  const LinearSystemMaker direct = [&elements] { return direct_system(elements); };
  std::unique_ptr<LinearSystem> iterative;
  if (elements.node_count() >= kFewNodes && (!is_quadratic || scene.has<InertiaOptions>())) {
    // What Newton's iterations need; their own tolerance may be finer.
    constexpr double kTolerance = 1e-3;
    iterative = elements.order() == 1
                    ? multigrid_system(elements, kTolerance, run)
                    : quadratic_system(elements, constitution_of(scene.model), kTolerance, run);
  }
  if (!iterative) {
    return std::make_unique<Equilibrium>(std::move(energies), direct(), nullptr, is_quadratic);
  }
  return std::make_unique<Equilibrium>(std::move(energies), std::move(iterative), direct,
                                       is_quadratic);
}

}  // namespace tissue
