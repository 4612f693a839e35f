#pragma once

#include "tissue/base/run.h"
#include "tissue/simulate/linear_system.h"

namespace tissue {

/// Conjugate gradients over a matrix in single precision, with vectors in double, preconditioned by
/// one multigrid V-cycle over the hierarchy from which the vertices were made; where there is none,
/// or its coarsest level is not small, over lattices laid over the body.
///
/// For elements of order 1; nothing for a body that is small itself. `tolerance`:
/// ‖b − A x‖ ≤ tolerance ‖b‖. Elements must outlive it.
std::unique_ptr<LinearSystem> multigrid_system(const FiniteElements& elements, double tolerance,
                                               Run run = {});

}  // namespace tissue
