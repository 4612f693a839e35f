#include "tissue/field/label_densities.h"

#include "tissue/base/error.h"

#include <cmath>

namespace tissue {

Volume relabelled(const Volume& volume, const std::map<std::int64_t, double>& densities) {
  Volume result;
  result.grid = volume.grid;
  result.quantity = Quantity::kLabel;
  result.frame_id = volume.frame_id;
  std::vector<float> values;
  values.reserve(volume.grid.voxel_count());
  std::visit(
      [&](const auto& labels) {
        auto last = densities.end();
        for (const auto raw : labels) {
          const double value = volume.slope * static_cast<double>(raw) + volume.intercept;
          const auto label = static_cast<std::int64_t>(std::llround(value));
          if (last == densities.end() || last->first != label) last = densities.find(label);
          // Background has no tissue; whatever the surface does there, a density is positive.
          const bool missing = last == densities.end();
          if (missing && label != 0) {
            throw InputError(ErrorCode::kParam, "label_densities: label " + std::to_string(label) +
                                                    " of the volume is not in the table");
          }
          values.push_back(missing ? 1.0f : static_cast<float>(last->second));
        }
      },
      volume.voxels);
  result.voxels = std::move(values);
  return result;
}

}  // namespace tissue
