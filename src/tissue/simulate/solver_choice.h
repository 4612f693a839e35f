#pragma once

#include "rigid_inclusions.h"
#include "tissue/base/run.h"
#include "tissue/simulate/constitutive.h"
#include "tissue/simulate/equilibrium.h"
#include "tissue/simulate/scene_description.h"

namespace tissue {

Constitution constitution_of(Model model);

/// What a scene's energies ask of a linear system.
struct SystemNeeds {
  bool is_quadratic = false;
  /// The cost of what adds sums of squares to it, if anything does.
  EffectCost* squares = nullptr;
  /// Nothing where all motions are free.
  RigidMotions* motions = nullptr;
};

/// What finds a scene's equilibria or steps: one factorisation that serves all of them where the
/// model is linear and at rest, or for each what is cheapest. `elements` and `energies` must
/// outlive it.
std::unique_ptr<Equilibrium> equilibrium_for(const SceneDescription& scene,
                                             const FiniteElements& elements,
                                             std::vector<const Energy*> energies,
                                             const SystemNeeds& needs, const Run& run);

}  // namespace tissue
