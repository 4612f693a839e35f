#pragma once

namespace tissue {

/// When an equilibrium counts as found.
struct EquilibriumOptions {
  /// Of the residual: the norm of the forces on free nodes, by the largest of those of the forces
  /// that hold fixed ones, that were out of balance at the start, penalties left out, and of the
  /// penalties'.
  double tolerance = 1e-3;
  int max_iterations = 200;
};

}  // namespace tissue
