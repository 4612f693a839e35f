#pragma once

#include "tissue/base/types.h"

#include <array>

namespace tissue {

/// A corner of a tet, or the cut on one of its edges: corner i is i, the cut between corners i and
/// j is 4 + tet_edge(i, j).
using StencilPoint = int;

/// The tets with which a lattice tet is filled.
struct Stencil {
  int count = 0;
  std::array<std::array<StencilPoint, 4>, 3> tets{};
};

/// `signs` is −1, 0 or 1 at each corner; `corners` are the doubled lattice coordinates of the
/// corners, which decide how quads are split. Tets may come out with negative volume.
Stencil fill_tet(const std::array<int, 4>& signs, const std::array<std::array<int, 3>, 4>& corners);

/// The stencil of tet `k` of bcc_tets() under the signs, out of a table.
const Stencil& stencil_for(int k, const std::array<int, 4>& signs);

}  // namespace tissue
