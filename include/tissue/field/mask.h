#pragma once

#include "tissue/field/volume.h"

namespace tissue {

/// A mask is a volume of 8-bit voxels on the grid of what it masks: labels 0 and 1, or after
/// smoothing a coverage from 0 to 255 (quantity `density`).

/// 1 where the volume's value is above `value`, else 0.
Volume threshold_mask(const Volume& volume, double value);

/// Opening by a ball: removes what is thinner than about `radius` voxels. Throws InputError E_PARAM
/// unless `radius` is within 1 to 50.
Volume open_mask(const Volume& mask, int radius);

/// The coverage after blurring with a Gaussian of standard deviation `sigma` voxels; its contour at
/// half the maximum is the smoothed surface. Throws InputError E_PARAM unless 0 < sigma <= 20,
/// E_TOO_SMALL for fewer than 4 voxels along an axis.
Volume smooth_mask(const Volume& mask, double sigma);

/// Distance to the surface half-way between set and unset voxels [m], negative inside, as 32FC1.
/// Values above 0 are set.
Volume signed_distance_map(const Volume& mask);

}  // namespace tissue
