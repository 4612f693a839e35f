#pragma once

#include "tissue/lattice/bcc_lattice.h"
#include "tissue/lattice/stuffing.h"

#include <vector>

namespace tissue {

enum PointState : std::int8_t;

/// Turns the inside points of all but the chosen component to outside. Two inside points are
/// connected if an edge of the lattice joins them; since every tet holds an inside point, and the
/// tets around one are joined by faces, these are the components of the mesh to be. Returns how
/// many were dropped.
std::size_t keep_component(const BccLattice& lattice, const Component& component,
                           std::vector<PointState>& states);

}  // namespace tissue
