#pragma once

#include "rigid_inclusions.h"
#include "tissue/simulate/linear_system.h"

namespace tissue {

/// A system over the motions that rigid inclusions leave: conjugate gradients, preconditioned by
/// `base` with the inclusions held and by the six motions of each for themselves.
///
/// `tolerance`: ‖b − A x‖ ≤ tolerance ‖b‖. `motions` must outlive it.
std::unique_ptr<LinearSystem> rigid_system(std::unique_ptr<LinearSystem> base,
                                           const RigidMotions& motions, double tolerance);

}  // namespace tissue
