#pragma once

#include "tissue/field/implicit_surface.h"

#include <string>

namespace tissue {

/// Triangles in the world [m]; closed ones have an inside.
struct TriangleSurface {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
};

/// Reads PLY, STL, OBJ or VTP. Numbers are taken as they are. Throws InputError E_FILE.
TriangleSurface read_surface(const std::string& path);

/// Writes PLY, STL or VTP by the ending of `path`. Throws InputError E_PARAM for another ending and
/// E_IO if it cannot be written.
void write_surface(const TriangleSurface& surface, const std::string& path);

/// The organ inside a closed surface, as its signed distance on `grid`. Surface files have no unit:
/// one that is more than 30 times as large as the grid is taken to be in millimetres.
///
/// Throws InputError E_CONFORMITY for a surface with open edges (of an odd number of triangles),
/// with their number, E_EMPTY_SURFACE if no voxel of the grid lies inside.
ImplicitSurface surface_of_triangles(TriangleSurface surface, const Grid& grid);

/// The isosurface by marching cubes (what the paper's meshes start from), in the world.
TriangleSurface marching_cubes(const ImplicitSurface& surface);

/// The surface with about `keep` (0 to 1) of its triangles, keeping its topology.
/// Throws InputError E_PARAM unless 0 < keep <= 1.
TriangleSurface decimated(const TriangleSurface& surface, double keep);

}  // namespace tissue
