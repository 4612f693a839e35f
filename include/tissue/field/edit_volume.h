#pragma once

#include "tissue/field/volume.h"

namespace tissue {

/// A ball of one value, put into a volume to stand for a tumour. World frame, metres.
struct Tumour {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;
  double value = 255.0;
};

/// Sets every voxel whose centre lies within the ball. Throws InputError E_PARAM if a number is not
/// finite, the radius is not positive, no voxel lies within, or the voxel type cannot hold the
/// value.
void insert_tumour(Volume& volume, const Tumour& tumour);

/// Sets every voxel. Throws InputError E_PARAM if the voxel type cannot hold the value.
void fill_volume(Volume& volume, double value);

/// An axis-aligned box in the world [m].
struct Box {
  Vec3 low = Vec3::Zero();
  Vec3 high = Vec3::Zero();
};

/// The smallest part of the grid that holds every voxel centre within the box. Throws InputError
/// E_PARAM if the box is not one or holds no voxel.
Volume crop_volume(const Volume& volume, const Box& box);

}  // namespace tissue
