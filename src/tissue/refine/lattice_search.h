#pragma once

#include "tissue/lattice/stuffing.h"

#include <functional>

namespace tissue {

/// Looks for the spacing and offset of the lattice at which `count` comes nearest to `wished` tets,
/// and stops as soon as it is within `tolerance` of it (a fraction) or after a dozen rounds. The
/// number falls with the cube of the spacing, on the whole; close by it jumps, and there offsets
/// are tried, always the same. Begins at the spacing of `start`.
StuffingOptions search_lattice(StuffingOptions start, double wished, double tolerance,
                               const std::function<double(const StuffingOptions&)>& count);

}  // namespace tissue
