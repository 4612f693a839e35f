#include "solver_choice.h"

#include "rigid_system.h"
#include "squared_system.h"
#include "tissue/simulate/multigrid_system.h"
#include "tissue/simulate/quadratic_system.h"

#include <utility>

namespace tissue {

Constitution constitution_of(Model model) {
  switch (model) {
    case Model::kLinear: return Constitution::kLinear;
    case Model::kCorotational: return Constitution::kCorotational;
    // What has no law of its own does not ask for one.
    case Model::kClosedForm:
    case Model::kMassSpring:
    case Model::kNeoHookean: break;
  }
  return Constitution::kNeoHookean;
}

std::unique_ptr<Equilibrium> equilibrium_for(const SceneDescription& scene,
                                             const FiniteElements& elements,
                                             std::vector<const Energy*> energies,
                                             const SystemNeeds& needs, const Run& run) {
  constexpr std::size_t kFewNodes = 500;
  // What Newton's iterations need, their own tolerance may be finer; and what a factorisation
  // gives.
  constexpr double kTolerance = 1e-3, kDirectTolerance = 1e-9;
  const auto adapted = [needs](std::unique_ptr<LinearSystem> system, double tolerance) {
    if (needs.squares != nullptr) {
      system = squared_system(std::move(system), tolerance, *needs.squares);
    }
    if (needs.motions != nullptr) {
      system = rigid_system(std::move(system), *needs.motions, tolerance);
    }
    return system;
  };
  const LinearSystemMaker direct = [&elements, adapted] {
    return adapted(direct_system(elements), kDirectTolerance);
  };
  std::unique_ptr<LinearSystem> iterative;
  if (elements.node_count() >= kFewNodes && (!needs.is_quadratic || scene.has<InertiaOptions>())) {
    iterative = elements.order() == 1
                    ? multigrid_system(elements, kTolerance, run)
                    : quadratic_system(elements, constitution_of(scene.model), kTolerance, run);
  }
  const bool iterates = iterative != nullptr;
  return std::make_unique<Equilibrium>(
      std::move(energies), iterates ? adapted(std::move(iterative), kTolerance) : direct(),
      iterates ? direct : LinearSystemMaker(), needs.is_quadratic, needs.motions);
}

}  // namespace tissue
