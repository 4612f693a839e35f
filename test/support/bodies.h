#pragma once

#include "tissue/simulate/body.h"

#include <array>
#include <functional>

namespace tissue_test {

/// A block from the origin to `size` [m], `cells` cubes along each axis, each of six Kuhn tets. It
/// knows its hierarchy as far as it was made by `halvings` of a coarser block.
tissue::Body kuhn_block(const std::array<int, 3>& cells, const tissue::Vec3& size,
                        int halvings = 0);

/// Where the middle of a tet is [m].
tissue::Vec3 centroid(const tissue::Body& body, std::size_t tet);

/// Tets whose centroid lies within `radius` of `centre` [m] get the density `inside`, the others
/// `outside`.
tissue::Body with_core(tissue::Body body, const tissue::Vec3& centre, double radius, float inside,
                       float outside);

/// A density-refined ball of 30 mm radius around the origin with a dense ball of a third of that in
/// it: coarse tets of density 255 in the middle, fine ones of density 60 around. Smaller `spacing`
/// [m], finer mesh.
tissue::TetMesh refined_ball(double spacing, int sections = 3);

/// The body of a mesh from the mesher, with a core of `radius` [m] around the origin.
tissue::Body ball_body(const tissue::TetMesh& mesh, double radius, float inside, float outside);

/// One flag for each of a body's vertices or an element's nodes.
std::vector<std::uint8_t> nodes_where(const std::vector<tissue::Vec3>& places,
                                      const std::function<bool(const tissue::Vec3&)>& chosen);

}  // namespace tissue_test
