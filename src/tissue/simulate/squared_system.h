#pragma once

#include "effect_costs.h"
#include "tissue/simulate/linear_system.h"

namespace tissue {

/// A system that takes sums of squares besides: conjugate gradients over all of it, preconditioned
/// as `base` is without them. Volumes that are kept cost few iterations, however strictly: they
/// make one cluster of eigenvalues far above the others.
///
/// `tolerance`: ‖b − A x‖ ≤ tolerance ‖b‖. Products with squares are counted as `cost`, which must
/// outlive it.
std::unique_ptr<LinearSystem> squared_system(std::unique_ptr<LinearSystem> base, double tolerance,
                                             EffectCost& cost);

}  // namespace tissue
