#pragma once

#include "tissue/base/types.h"

namespace tissue {

/// All that is within `radius` of the line between two places [m]; a ball where they are the same.
struct Capsule {
  Vec3 tip = Vec3::Zero(), end = Vec3::Zero();
  double radius = 0.0;

  bool is_ball() const { return tip == end; }
};

}  // namespace tissue
