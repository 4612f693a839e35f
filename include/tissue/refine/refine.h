#pragma once

#include "tissue/base/quality.h"
#include "tissue/base/run.h"
#include "tissue/base/topology.h"
#include "tissue/lattice/stuffing.h"

#include <vector>

namespace tissue {

/// The lattice mesh with its neighbourhoods, ready to be refined.
struct RefinableLattice {
  LatticeMesh mesh;
  FaceTopology faces;
  EdgeTopology edges;
};

/// Orders the corners of every cut tet so that refinement keeps its shape best, and finds the
/// neighbourhoods.
RefinableLattice refinable(LatticeMesh mesh, const Run& run = {});

/// A conforming refined mesh.
struct RefinedMesh {
  /// Places in the grid's frame [m]; the lattice's vertices come first, in their order.
  std::vector<Vec3f> vertices;
  std::vector<Tet> tets;
  /// Level of each tet's lattice tet.
  std::vector<std::uint8_t> levels;
  /// Boundary triangles, outward.
  std::vector<Triangle> surface;
  /// The ends of the edge that each vertex after the lattice's halves.
  std::vector<Edge> parents;
  /// Final level of each lattice tet.
  std::vector<std::uint8_t> lattice_levels;
  DihedralRange dihedral;
};

/// Splits every lattice tet into 8^level parts by Bey's rule and closes the jumps between levels by
/// splitting parts along their halved edges, for all 64 patterns of them. Levels are raised first
/// until tets that share an edge differ by at most one, and where a cut tet would fall below 10° or
/// above 165°.
///
/// `levels` holds one level per lattice tet. Throws InputError E_TOO_MANY_TETS if more than
/// `max_tets` tets would come out, before they are allocated.
RefinedMesh refine(const RefinableLattice& lattice, std::vector<std::uint8_t> levels,
                   std::uint64_t max_tets, const Run& run = {});

}  // namespace tissue
