#pragma once

#include "tissue/base/types.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tissue {

/// Extremes of the dihedral angles of one or more tets, as cosines: cheap to gather, turned into
/// angles once.
struct DihedralRange {
  /// Of the largest angle.
  double lowest_cosine = 1.0;
  /// Of the smallest angle.
  double highest_cosine = -1.0;

  double min_angle() const { return std::acos(std::clamp(highest_cosine, -1.0, 1.0)); }
  double max_angle() const { return std::acos(std::clamp(lowest_cosine, -1.0, 1.0)); }
  void include(const DihedralRange& other) {
    lowest_cosine = std::min(lowest_cosine, other.lowest_cosine);
    highest_cosine = std::max(highest_cosine, other.highest_cosine);
  }
};

/// The six dihedral angles of a tet of positive volume. A flat tet gives 0 and 180 degrees.
DihedralRange dihedral_range(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// min(smallest angle / 10°, (180° − largest angle) / 15°): below 1 a tet falls short of the bounds
/// that refinement keeps.
double shape_score(const DihedralRange& range);

}  // namespace tissue
