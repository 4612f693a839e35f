#pragma once

#include "tissue/field/volume.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace tissue_test {

using VolumePtr = std::shared_ptr<const tissue::Volume>;

/// A cube of `size`³ voxels of 1 mm whose values are f(x, y, z) at voxel indices, as floats.
VolumePtr float_volume(std::uint32_t size, const std::function<double(double, double, double)>& f);

/// The same, rounded and clamped to 8 bits.
VolumePtr byte_volume(std::uint32_t size, const std::function<double(double, double, double)>& f);

/// An organ of noisy tissue with a hard ball (255) of a seventh of its width in it, 8 bits, voxels
/// of 1 mm: the volume on which benchmarks run. Its surface lies at 20; any size.
VolumePtr organ_phantom(const tissue::GridSize& size);

/// A volume with the surface that is meant by it.
struct Shape {
  std::string name;
  VolumePtr volume;
  double iso;
};

/// Ball, torus, thin sheet, two touching balls, noise blob, a cube aligned with the lattice, exact
/// ties with the iso value.
const std::vector<Shape>& synthetic_shapes();

/// The shipped brain, and where they are at hand the two other brains that were measured.
std::vector<Shape> real_volumes();

/// The brain that the repository ships.
VolumePtr shipped_brain();

}  // namespace tissue_test
