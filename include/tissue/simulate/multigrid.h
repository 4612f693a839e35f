#pragma once

#include "tissue/simulate/finite_elements.h"
#include "tissue/simulate/linear_solver.h"

namespace tissue {

/// Conjugate gradients over a matrix in single precision, with vectors in double, preconditioned by
/// one V-cycle over the hierarchy from which the nodes were made: one symmetric sweep of Gauss and
/// Seidel a level, Galerkin's coarse matrices, a factorisation on the coarsest. For quadratic
/// elements the hierarchy starts at the linear ones.
///
/// Nothing for elements whose nodes have no parents. `tolerance`: ‖b − A x‖ ≤ tolerance ‖b‖.
std::unique_ptr<LinearSolver> multigrid_solver(const FiniteElements& elements, double tolerance);

}  // namespace tissue
