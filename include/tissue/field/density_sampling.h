#pragma once

#include "tissue/base/run.h"
#include "tissue/base/tet_mesh.h"
#include "tissue/field/density_window.h"

namespace tissue {

/// Densities at the places from number `begin` on [m, in the grid's frame], written behind the
/// `densities` of those before.
std::vector<float> sample_densities(const Volume& volume, const DensityWindow& window,
                                    const std::vector<Vec3f>& places, std::size_t begin,
                                    std::vector<float> densities, const Run& run);

/// The mean density over every tet, by sampling it at 1, 4 or n³ places (n up to 8): as many as it
/// takes for each to stand for no more than about five voxels, of which a trilinear sample blends
/// eight. `vertices` are in the grid's frame; a tet of level l has long edges of about `spacing` /
/// 2^l [m].
std::vector<float> sample_tet_densities(const Volume& volume, const DensityWindow& window,
                                        const std::vector<Vec3f>& vertices,
                                        const std::vector<Tet>& tets,
                                        const std::vector<std::uint8_t>& levels, double spacing,
                                        const Run& run);

}  // namespace tissue
