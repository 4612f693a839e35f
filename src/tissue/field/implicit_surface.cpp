#include "tissue/field/implicit_surface.h"

#include "tissue/base/error.h"
#include "tissue/field/mask.h"

#include <cmath>

namespace tissue {
namespace {

// Counts the voxels that are inside, in the type in which they are stored.
std::size_t voxels_inside(const ImplicitSurface& surface) {
  const Volume& volume = *surface.field;
  return std::visit(
      [&](const auto& values) {
        std::size_t inside = 0;
        for (const auto raw : values) {
          const double value = volume.slope * static_cast<double>(raw) + volume.intercept;
          inside += surface.inside_above ? value > surface.iso : value < surface.iso;
        }
        return inside;
      },
      volume.voxels);
}

}  // namespace

ImplicitSurface surface_at_iso(std::shared_ptr<const Volume> volume, double iso) {
  if (!std::isfinite(iso)) {
    throw InputError(ErrorCode::kParam, "iso_value: " + to_text(iso) + " is not finite");
  }
  const std::array<double, 2> range = value_range(*volume);
  if (!(range[1] > iso)) {
    throw InputError(ErrorCode::kEmptySurface, "iso_value: " + to_text(iso) +
                                                   " leaves nothing inside; the data reach from " +
                                                   to_text(range[0]) + " to " + to_text(range[1]));
  }
  return {std::move(volume), iso, true, range};
}

ImplicitSurface surface_of_mask(const std::shared_ptr<const Volume>& mask) {
  const std::array<double, 2> range = value_range(*mask);
  if (!(range[1] > 0.0)) {
    throw InputError(ErrorCode::kEmptySurface, "mask: nothing is set; its values reach from " +
                                                   to_text(range[0]) + " to " + to_text(range[1]));
  }
  if (mask->quantity != Quantity::kLabel) return {mask, 0.5 * range[1], true, range};
  const auto distance = std::make_shared<Volume>(signed_distance_map(*mask));
  return {distance, 0.0, false, value_range(*distance)};
}

double voxel_volume_inside(const ImplicitSurface& surface) {
  return static_cast<double>(voxels_inside(surface)) * surface.field->grid.spacing.prod();
}

}  // namespace tissue
