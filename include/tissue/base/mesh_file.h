#pragma once

#include "tissue/base/tet_mesh.h"

#include <string>

namespace tissue {

/// Further values per tet to write beside the mesh's own.
struct TetField {
  std::string name;
  std::vector<double> values;
};

/// Writes a VTU file that ParaView opens: point data `density` and `parents` (−1 −1 for a lattice
/// vertex; absent without a hierarchy), cell data `level` and `density`, then `further`, which
/// replaces a field of the same name. Written to a temporary file beside `path` and renamed. Throws
/// InputError E_IO if it cannot be written.
void write_mesh(const TetMesh& mesh, const std::string& path,
                const std::vector<TetField>& further = {});

}  // namespace tissue
