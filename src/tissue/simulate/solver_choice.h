#pragma once

#include "tissue/base/run.h"
#include "tissue/simulate/constitutive.h"
#include "tissue/simulate/equilibrium.h"
#include "tissue/simulate/scene_description.h"

namespace tissue {

Constitution constitution_of(Model model);

/// What finds a scene's equilibria or steps: one factorisation that serves all of them where the
/// model is linear and at rest, or for each what is cheapest. `is_quadratic`: whether all energies
/// are. `elements` and `energies` must outlive it.
std::unique_ptr<Equilibrium> equilibrium_for(const SceneDescription& scene,
                                             const FiniteElements& elements,
                                             std::vector<const Energy*> energies, bool is_quadratic,
                                             const Run& run);

}  // namespace tissue
