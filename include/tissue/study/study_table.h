#pragma once

#include "tissue/study/row_result.h"

namespace tissue {

/// By how much one result differs from another.
struct Difference {
  /// ‖u − v‖ / ‖v‖ of the displacements of all points at all instants, as a fraction.
  double displacement = 0.0;
  /// The largest distance of the tumour's two centroids at any instant [m].
  double tumour = 0.0;
  /// ‖F − G‖ / ‖G‖ of the forces on the tools at all instants, as a fraction; nothing where one of
  /// the two knows none.
  std::optional<double> force;
  /// Of the changes of volume, in percentage points.
  double volume_change = 0.0;
};

/// Throws InputError E_SIZE_MISMATCH if the two were not taken at the same points and instants.
Difference difference(const RowResult& result, const RowResult& reference);

/// The error that a reference claims for itself: twice its difference from the check, which has an
/// eighth of its tets. Right wherever halving edges takes at least a third off the error.
Difference claimed_error(const RowResult& reference, const RowResult& check);

/// The study as one tidy CSV, a head and a line per row that is there, its errors and those of what
/// they were measured against.
std::string study_table(const Study& study, const std::vector<std::optional<RowResult>>& results);

/// How far apart step times of the same row, run again, were: (largest − smallest) / median;
/// nothing where none was repeated.
std::optional<double> noise(const Study& study,
                            const std::vector<std::optional<RowResult>>& results);

}  // namespace tissue
