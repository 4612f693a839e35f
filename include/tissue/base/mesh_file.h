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
/// replaces a field of the same name. The last line is a hash of all bytes before it. The file
/// appears when it is complete. Throws InputError E_IO if it cannot be written.
/// Where given, `displacements` of the vertices are point data `displacement`.
void write_mesh(const TetMesh& mesh, const std::string& path,
                const std::vector<TetField>& further = {},
                const std::vector<Vec3>& displacements = {});

/// Reads a VTU file of tets. One that write_mesh() made is not parsed before its hash has been
/// checked, and comes back with the uuid that it had. One from elsewhere, unless `only_own`, needs
/// tets and nothing more: level 0 and density 1 stand in for what it does not say.
///
/// Throws InputError E_FILE if the file cannot be read, has been cut or changed or holds other
/// cells than tets, and what check_mesh() throws.
TetMesh read_mesh(const std::string& path, bool only_own = false);

}  // namespace tissue
