#pragma once

#include "tissue/study/study.h"

#include <memory>

namespace tissue {

/// What a row found, and what it cost.
struct RowResult {
  /// Empty unless the row failed: then why.
  std::string failure;
  std::uint64_t tetrahedra = 0, vertices = 0, nodes = 0;
  /// CPU time from the volume to the mesh, without the search for the number of tets.
  double meshing_seconds = 0.0;
  /// Making the scene and its first step.
  double setup_seconds = 0.0;
  /// Of all steps in which something was to move.
  double step_median = 0.0, step_p99 = 0.0;
  std::size_t steps = 0;
  /// Resident memory of the scene at its peak, above that of the mesh; the samples that are taken
  /// of it are among it, some 5 MB.
  double bytes = 0.0;
  /// Making the scene and all steps; what each effect had of that.
  double run_seconds = 0.0;
  std::vector<EffectCost> effects;
  /// Of the last step.
  int iterations = 0;
  std::string solver;
  double min_det_f = 1.0;
  std::size_t inverted = 0;
  /// Of the body, at the end [%].
  double volume_change = 0.0;
  /// At up to four instants, the last among them: displacements of the points in the organ [m], one
  /// instant after the other, their mean over the tumour, and the force of the tissue on all tools
  /// together [N], none for models that know none.
  std::vector<Vec3> displacements, tumour, force;
};

/// Runs one row of a study. What goes wrong with it is part of the result: bad input, no
/// convergence, no memory.
RowResult run_row(const Study& study, const StudyRow& row, const Run& run = {});

}  // namespace tissue
