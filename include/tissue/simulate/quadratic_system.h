#pragma once

#include "tissue/base/run.h"
#include "tissue/simulate/constitutive.h"
#include "tissue/simulate/linear_system.h"

namespace tissue {

/// For elements of order 2, nothing for others: conjugate gradients, with vectors in double, over
/// what the elements do to vectors, which is never a matrix. Preconditioned by a step of Jacobi's
/// over all nodes before and after a multigrid cycle over the vertices alone.
///
/// `constitution` must be that of the energies. `tolerance`: ‖b − A x‖ ≤ tolerance ‖b‖; `run` says
/// how many threads assemble. Elements must outlive it.
std::unique_ptr<LinearSystem> quadratic_system(const FiniteElements& elements,
                                               Constitution constitution, double tolerance,
                                               Run run = {});

}  // namespace tissue
