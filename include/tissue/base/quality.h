#pragma once

#include "tissue/base/types.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tissue {

/// Extremes of the dihedral angles of one or more tets, as cos·|cos|: that grows as the angle
/// falls, needs no root to be found, and is turned into an angle once.
struct DihedralRange {
  /// Of the largest angle.
  double lowest = 1.0;
  /// Of the smallest angle.
  double highest = -1.0;

  double min_angle() const { return angle(highest); }
  double max_angle() const { return angle(lowest); }
  void include(const DihedralRange& other) {
    lowest = std::min(lowest, other.lowest);
    highest = std::max(highest, other.highest);
  }
  static double angle(double signed_square) {
    const double cosine = std::copysign(std::sqrt(std::abs(signed_square)), signed_square);
    return std::acos(std::clamp(cosine, -1.0, 1.0));
  }
};

/// The six dihedral angles of a tet, whichever way it is turned. A flat one gives 0 and 180 degrees.
DihedralRange dihedral_range(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Bounds on dihedral angles, as cos·|cos|.
struct AngleBounds {
  double lowest, highest;
  AngleBounds(double min_deg, double max_deg);
};

/// min(smallest angle / 10°, (180° − largest angle) / 15°): below 1 a tet falls short of the bounds
/// that refinement keeps.
double shape_score(const DihedralRange& range);

}  // namespace tissue
