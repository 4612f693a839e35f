#include "ros/colours.h"

#include <algorithm>

namespace tissue_ros {

Colour level_colour(int level) {
  if (level == 0) return {0.86f, 0.13f, 0.13f};
  if (level == 1) return {0.20f, 0.70f, 0.25f};
  if (level == 2) return {0.22f, 0.38f, 0.90f};
  const float light = std::min(1.0f, 0.45f + 0.15f * static_cast<float>(level - 3));
  return {light, 0.75f, 1.0f};
}

Colour share_colour(float share) {
  const float s = std::clamp(share, 0.0f, 1.0f);
  return {s, 0.15f + 0.75f * s * s, 0.35f * (1.0f - s)};
}

}  // namespace tissue_ros
