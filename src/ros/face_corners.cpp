#include "ros/face_corners.h"

#include <algorithm>
#include <array>
#include <limits>

namespace tissue_ros {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// Which corner of a face is its own, and which kind the one after it is of and the one after that.
struct Choice {
  int own, first, second;
};

constexpr Choice kChoices[] = {{2, 0, 1}, {2, 1, 2}, {2, 2, 0}, {2, 1, 0}, {2, 2, 1}, {2, 0, 2},
                               {0, 0, 1}, {0, 1, 2}, {0, 2, 0}, {0, 1, 0}, {0, 2, 1}, {0, 0, 2},
                               {1, 0, 1}, {1, 1, 2}, {1, 2, 0}, {1, 1, 0}, {1, 2, 1}, {1, 0, 2}};

}  // namespace

FaceCorners corners_of(const std::vector<SeenFace>& faces) {
  std::uint32_t vertices = 0;
  for (const SeenFace& face : faces)
    vertices = std::max(vertices, 1 + *std::max_element(face.corners.begin(), face.corners.end()));
  FaceCorners result;
  result.vertices.resize(faces.size());
  result.kinds.resize(faces.size());
  result.indices.reserve(3 * faces.size());
  // Of each vertex a corner of each kind.
  std::vector<std::array<std::uint32_t, 3>> corners(vertices, {kNone, kNone, kNone});
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    const auto& face = faces[f].corners;
    // As few corners as can be come new with it.
    const Choice choice = *std::min_element(
        std::begin(kChoices), std::end(kChoices), [&](const Choice& a, const Choice& b) {
          const auto missing = [&](const Choice& c) {
            return (corners[face[(c.own + 1) % 3]][c.first] == kNone) +
                   (corners[face[(c.own + 2) % 3]][c.second] == kNone);
          };
          return missing(a) < missing(b);
        });
    const int kinds[] = {choice.first, choice.second};
    for (int i = 0; i < 2; ++i) {
      const std::uint32_t vertex = face[(choice.own + 1 + i) % 3];
      std::uint32_t& corner = corners[vertex][kinds[i]];
      if (corner == kNone) {
        corner = static_cast<std::uint32_t>(result.vertices.size());
        result.vertices.push_back(vertex);
        result.kinds.push_back(static_cast<std::uint8_t>(kinds[i]));
      }
      result.indices.push_back(corner);
    }
    const int own = 3 - choice.first - choice.second;
    result.vertices[f] = face[choice.own];
    result.kinds[f] = static_cast<std::uint8_t>(own);
    result.indices.push_back(f);
    if (corners[face[choice.own]][own] == kNone) corners[face[choice.own]][own] = f;
  }
  return result;
}

}  // namespace tissue_ros
