#include "tissue/field/mask.h"

#include "itk_bridge.h"
#include "tissue/base/error.h"

#include <algorithm>
#include <cmath>

namespace tissue {
namespace {

std::vector<std::uint8_t> set_voxels(const Volume& volume, double above) {
  return std::visit(
      [&](const auto& values) {
        std::vector<std::uint8_t> set(values.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
          set[i] = volume.slope * static_cast<double>(values[i]) + volume.intercept > above;
        }
        return set;
      },
      volume.voxels);
}

Volume mask_like(const Volume& volume, Voxels voxels, Quantity quantity) {
  return {volume.grid, std::move(voxels), 1.0, 0.0, quantity, volume.frame_id};
}

}  // namespace

Volume threshold_mask(const Volume& volume, double value) {
  return mask_like(volume, set_voxels(volume, value), Quantity::kLabel);
}

Volume open_mask(const Volume& mask, int radius) {
  if (radius < 1 || radius > 50) {
    throw InputError(ErrorCode::kParam,
                     "mask_opening: " + std::to_string(radius) + " voxels is not within 1 to 50");
  }
  return mask_like(mask,
                   opened(mask.grid.size, set_voxels(mask, 0.0), static_cast<unsigned>(radius)),
                   Quantity::kLabel);
}

Volume smooth_mask(const Volume& mask, double sigma) {
  if (!(sigma > 0.0 && sigma <= 20.0)) {
    throw InputError(ErrorCode::kParam,
                     "mask_smoothing: " + to_text(sigma) + " voxels is not within 0 to 20");
  }
  for (int axis = 0; axis < 3; ++axis) {
    // The recursive filter needs four voxels along every axis.
    if (mask.grid.size[axis] < 4) {
      throw InputError(ErrorCode::kTooSmall, "mask_smoothing: the mask has only " +
                                                 std::to_string(mask.grid.size[axis]) +
                                                 " voxels along an axis, 4 are needed");
    }
  }
  const std::vector<float> blur = blurred(mask.grid.size, set_voxels(mask, 0.0), sigma);
  std::vector<std::uint8_t> coverage(blur.size());
  for (std::size_t i = 0; i < blur.size(); ++i) {
    coverage[i] = static_cast<std::uint8_t>(std::lround(std::clamp(blur[i], 0.0f, 1.0f) * 255));
  }
  return mask_like(mask, std::move(coverage), Quantity::kDensity);
}

Volume signed_distance_map(const Volume& mask) {
  std::vector<std::uint8_t> set = set_voxels(mask, 0.0);
  const std::array<double, 3> spacing = {mask.grid.spacing[0], mask.grid.spacing[1],
                                         mask.grid.spacing[2]};
  std::vector<float> distance = distance_to_set(mask.grid.size, spacing, set);
  for (std::uint8_t& voxel : set) voxel = voxel == 0;
  const bool any_unset = std::find(set.begin(), set.end(), 1) != set.end();
  const std::vector<float> inner =
      any_unset ? distance_to_set(mask.grid.size, spacing, set)
                : std::vector<float>(set.size(), static_cast<float>(mask.grid.spacing.maxCoeff()));
  // Half of either distance puts zero half-way between neighbours, along every axis alike.
  for (std::size_t i = 0; i < set.size(); ++i) {
    distance[i] = 0.5f * (set[i] != 0 ? std::max(distance[i], 0.0f) : -std::max(inner[i], 0.0f));
  }
  return mask_like(mask, std::move(distance), Quantity::kDensity);
}

}  // namespace tissue
