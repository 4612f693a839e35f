#pragma once

#include "tissue/lattice/stuffing.h"

namespace tissue {

/// Keeps the largest component (unless all are wanted) and makes the boundary a closed 2-manifold:
/// where sheets touch in a vertex or an edge, each gets a vertex of its own; where they hang
/// together elsewhere, the tets that meet only there are dropped. What was done is counted in the
/// mesh. Unused vertices are removed.
void repair(LatticeMesh& mesh, bool all_components);

}  // namespace tissue
