#pragma once

#include "tissue/base/types.h"
#include "tissue/field/voxels.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tissue {

/// Where the voxels lie. A point has an index (voxel units), a place in the grid's own frame
/// (index · spacing [m], axes along the grid) and a place in the world (origin + axes · grid
/// place). Meshing works in the grid's frame.
struct Grid {
  /// Voxels along each axis.
  GridSize size = {0, 0, 0};
  /// Distance of voxel centres along each axis [m].
  Vec3 spacing = Vec3::Ones();
  /// Centre of voxel (0, 0, 0) in the world [m].
  Vec3 origin = Vec3::Zero();
  /// Columns are the grid's axes in the world: a rotation.
  Mat3 axes = Mat3::Identity();

  std::size_t voxel_count() const { return std::size_t{size[0]} * size[1] * size[2]; }
  Vec3 to_world(const Vec3& grid_place) const { return origin + axes * grid_place; }
  Vec3 to_grid(const Vec3& world) const { return axes.transpose() * (world - origin); }
};

/// Same size, and spacing, origin and axes equal to a thousandth of a voxel.
bool same_grid(const Grid& a, const Grid& b);

/// What the voxels' values mean.
enum class Quantity { kDensity, kHounsfield, kLabel };

/// A checked volume: dimensions, spacing and axes are sound, and every value is finite.
struct Volume {
  Grid grid;
  Voxels voxels;
  /// value = slope · voxel + intercept.
  double slope = 1.0;
  double intercept = 0.0;
  Quantity quantity = Quantity::kDensity;
  std::string frame_id = "patient";
};

/// Smallest and largest value (after slope and intercept).
std::array<double, 2> value_range(const Volume& volume);

/// A volume as it arrives from outside: nothing in it has been checked.
struct RawVolume {
  GridSize size = {0, 0, 0};
  Vec3 spacing = Vec3::Ones();
  Vec3 origin = Vec3::Zero();
  /// x, y, z, w of the rotation from the grid's axes to the world's.
  std::array<double, 4> orientation = {0.0, 0.0, 0.0, 1.0};
  std::string encoding;
  bool is_bigendian = false;
  double slope = 1.0;
  double intercept = 0.0;
  std::string quantity = "density";
  std::string frame_id = "patient";
  const std::uint8_t* data = nullptr;
  std::size_t data_size = 0;
};

/// Checks and copies. Throws InputError: E_DIMS, E_TOO_LARGE, E_SPACING, E_ENCODING,
/// E_SIZE_MISMATCH, E_NONFINITE, E_DIRECTION, E_FRAME, E_PARAM; nothing is allocated before
/// dimensions and length have been found to agree.
Volume decode_volume(const RawVolume& raw);

/// Throws what decode_volume throws where a volume that was put together otherwise is not sound.
void check_volume(const Volume& volume);

/// The encoding's name as in sensor_msgs, such as "16SC1".
std::string encoding_name(const Voxels& voxels);

/// The quantity's name in messages: "density", "hounsfield" or "label".
std::string quantity_name(Quantity quantity);

}  // namespace tissue
