#pragma once

#include "ros/section.h"

#include <cstdint>
#include <vector>

namespace tissue_ros {

/// What faces are drawn with. Shading is flat: colour and normal of a face are those of one of its
/// corners, which is its own, while it borrows the other two from others. That is a third of the
/// corners that faces with nothing in common would have, of which a renderer without hardware has
/// to transform each.
struct FaceCorners {
  /// The vertex of each corner; the first are the faces' own, in their order.
  std::vector<std::uint32_t> vertices;
  /// 0, 1 or 2 for each corner, all three in each face: where each of its edges is can be told
  /// from what is interpolated between them.
  std::vector<std::uint8_t> kinds;
  /// Three corners for each face, counter-clockwise as the face's, its own one last.
  std::vector<std::uint32_t> indices;
};

FaceCorners corners_of(const std::vector<SeenFace>& faces);

}  // namespace tissue_ros
