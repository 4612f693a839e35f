#pragma once

#include "tissue/lattice/stuffing.h"

namespace tissue {

/// Makes the boundary a closed 2-manifold, and lists it: where sheets touch, every class of tets
/// that hangs together at a vertex gets a vertex of its own; where classes hang together elsewhere,
/// the tets that meet only there are dropped, and unless `all_components` what falls off with them.
/// What was done is counted in the mesh. `on_surface` is set for the vertices of boundary faces.
void repair(LatticeMesh& mesh, std::vector<std::uint8_t> on_surface, bool all_components,
            const Run& run);

}  // namespace tissue
