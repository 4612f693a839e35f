#pragma once

#include "tissue/field/voxels.h"

#include <string>

namespace tissue {

// All that is asked of ITK, in plain types: ITK brings an Eigen of its own, and the two cannot meet
// in one source file.

/// An image file as ITK delivers it: millimetres, LPS.
struct ImageFile {
  GridSize size;
  std::array<double, 3> spacing;
  std::array<double, 3> origin;
  /// direction[i][j]: component i of the grid's axis j.
  std::array<std::array<double, 3>, 3> direction;
  Voxels voxels;
};

/// Voxels keep the file's type, or get the next that holds all its values. Throws InputError
/// E_FILE, E_ENCODING, E_DIMS.
ImageFile read_image(const std::string& path);

/// Binary opening by a ball of `radius` voxels.
std::vector<std::uint8_t> opened(const GridSize& size, const std::vector<std::uint8_t>& set,
                                 unsigned int radius);

/// Gaussian blur with a standard deviation of `sigma` voxels; every axis has at least 4 voxels.
std::vector<float> blurred(const GridSize& size, const std::vector<std::uint8_t>& set,
                           double sigma);

/// Distance of every unset voxel's centre to the nearest set one's, in the unit of `spacing`; 0 or
/// less at set voxels.
std::vector<float> distance_to_set(const GridSize& size, const std::array<double, 3>& spacing,
                                   const std::vector<std::uint8_t>& set);

}  // namespace tissue
