#pragma once

#include <array>

namespace tissue_ros {

/// Red, green and blue, from 0 to 1.
using Colour = std::array<float, 3>;

/// 0 is red, 1 green, 2 blue; finer ones get lighter.
Colour level_colour(int level);

/// From dark blue over brown to yellow, for shares from 0 to 1.
Colour share_colour(float share);

}  // namespace tissue_ros
