#pragma once

#include "tissue/base/tet_mesh.h"

#include <string>

namespace tissue_ros {

/// Writes the vertices with their densities (as intensity) to a binary .pcd file, which appears
/// when it is complete. Throws tissue::InputError E_IO.
void write_points(const tissue::TetMesh& mesh, const std::string& path);

}  // namespace tissue_ros
