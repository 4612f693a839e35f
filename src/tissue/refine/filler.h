#pragma once

#include "plan.h"
#include "vertex_blocks.h"

namespace tissue {

/// Makes what has been planned: every vertex and tet has its place already, so that threads only
/// write what is theirs.
RefinedMesh fill_mesh(const RefinableLattice& lattice, const RefinementPlan& plan,
                      const VertexBlocks& blocks, const Run& run);

}  // namespace tissue
