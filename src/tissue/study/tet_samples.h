#pragma once

#include "tissue/base/types.h"

#include <vector>

namespace tissue {

/// Places that stand for a tet: its centroid and half-way from there to its corners.
inline std::array<Vec3, 5> tet_samples(const std::vector<Vec3>& vertices, const Tet& tet) {
  Vec3 centroid = Vec3::Zero();
  for (const std::uint32_t v : tet) centroid += 0.25 * vertices[v];
  std::array<Vec3, 5> places = {centroid};
  for (std::size_t k = 0; k < 4; ++k) places[k + 1] = 0.5 * (centroid + vertices[tet[k]]);
  return places;
}

}  // namespace tissue
