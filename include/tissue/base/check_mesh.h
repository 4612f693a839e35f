#pragma once

#include "tissue/base/tet_mesh.h"

namespace tissue {

/// Refuses a mesh that cannot be simulated. Throws InputError:
/// E_SIZE_MISMATCH where arrays disagree in length or an index points beyond the vertices,
/// E_NONFINITE for positions or densities that are not finite, E_PARAM for a density that is not
/// positive, E_MESH_QUALITY with the count and the first of the tets that are flat or inverted,
/// E_CONFORMITY where a face belongs to more than two tets, a vertex hangs in the middle of an
/// edge, or the boundary is no 2-manifold.
void check_mesh(const TetMesh& mesh);

}  // namespace tissue
