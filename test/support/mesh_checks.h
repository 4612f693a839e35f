#pragma once

#include "tissue/base/tet_mesh.h"

#include <gtest/gtest.h>

#include <functional>

namespace tissue_test {

/// What an independent look at a mesh finds: slow, literal, and without the code that made it.
struct MeshFindings {
  std::size_t faces_of_three_tets = 0;
  std::size_t not_positive = 0;
  std::size_t unused_vertices = 0;
  /// Vertices that share their place with one of lower number.
  std::size_t twins = 0;
  /// Vertices that lie on the middle of an edge of some tet.
  std::size_t hanging_nodes = 0;
  /// Boundary edges that do not belong to exactly two boundary triangles.
  std::size_t open_or_branching_edges = 0;
  /// Boundary vertices whose triangles form more than one fan.
  std::size_t pinched_vertices = 0;
  /// The mesh's own surface is not the boundary of its tets.
  bool surface_differs = false;
  double tet_volume = 0.0;
  double volume_inside_boundary = 0.0;
  double min_dihedral_deg = 180.0;
  double max_dihedral_deg = 0.0;
};

MeshFindings inspect(const tissue::TetMesh& mesh);

/// Every demand that a mesh must meet, but for its angles: matching faces, positive tets, no
/// hanging or unused vertices, at most `copies` vertices at the place of another, and a closed
/// 2-manifold around the volume of the tets. Returns what was found.
MeshFindings expect_sound(const tissue::TetMesh& mesh, std::size_t copies = 0);

/// The same, and that the mesh's own statistics say so.
void expect_conforming(const tissue::TetMesh& mesh);

/// What is thrown as InputError, as "E_CODE: sentence"; "" if nothing is.
std::string refusal(const std::function<void()>& call);

}  // namespace tissue_test
