#include "tissue/field/edit_volume.h"

#include "tissue/base/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tissue {
namespace {

struct IndexBox {
  std::array<std::int64_t, 3> low, high;
};

// The indices, cut to the grid, whose places may lie within the world box.
IndexBox indices_around(const Grid& grid, const Box& box) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = -low;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 world((corner & 1) != 0 ? box.high.x() : box.low.x(),
                     (corner & 2) != 0 ? box.high.y() : box.low.y(),
                     (corner & 4) != 0 ? box.high.z() : box.low.z());
    const Vec3 index = grid.to_grid(world).cwiseQuotient(grid.spacing);
    low = low.cwiseMin(index);
    high = high.cwiseMax(index);
  }
  IndexBox indices{};
  for (int axis = 0; axis < 3; ++axis) {
    const double last = static_cast<double>(grid.size[axis]) - 1.0;
    indices.low[axis] =
        static_cast<std::int64_t>(std::ceil(std::clamp(low[axis] - 1e-6, 0.0, last + 1.0)));
    indices.high[axis] =
        static_cast<std::int64_t>(std::floor(std::clamp(high[axis] + 1e-6, -1.0, last)));
  }
  return indices;
}

template <class Body>
void for_each_index(const IndexBox& box, const Body& body) {
  for (std::int64_t z = box.low[2]; z <= box.high[2]; ++z) {
    for (std::int64_t y = box.low[1]; y <= box.high[1]; ++y) {
      for (std::int64_t x = box.low[0]; x <= box.high[0]; ++x) body(x, y, z);
    }
  }
}

Vec3 place_of(const Grid& grid, std::int64_t x, std::int64_t y, std::int64_t z) {
  return Vec3(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z))
      .cwiseProduct(grid.spacing);
}

// The voxel that stands for a value.
template <class T>
T voxel_for(const Volume& volume, double value, const char* what) {
  double raw = (value - volume.intercept) / volume.slope;
  if (!std::is_floating_point_v<T>) raw = std::round(raw);
  if (raw >= static_cast<double>(std::numeric_limits<T>::lowest()) &&
      raw <= static_cast<double>(std::numeric_limits<T>::max())) {
    return static_cast<T>(raw);
  }
  throw InputError(ErrorCode::kParam, std::string(what) + ": value " + to_text(value) +
                                          " does not fit into voxels of " +
                                          encoding_name(volume.voxels));
}

}  // namespace

void fill_volume(Volume& volume, double value) {
  std::visit(
      [&](auto& values) {
        using T = typename std::decay_t<decltype(values)>::value_type;
        std::fill(values.begin(), values.end(), voxel_for<T>(volume, value, "tissue"));
      },
      volume.voxels);
}

void insert_tumour(Volume& volume, const Tumour& tumour) {
  if (!tumour.centre.allFinite() || !std::isfinite(tumour.value)) {
    throw InputError(ErrorCode::kParam, "tumour: its centre or value is not finite");
  }
  if (!(tumour.radius > 0.0 && std::isfinite(tumour.radius))) {
    throw InputError(ErrorCode::kParam,
                     "tumour: radius " + to_text(tumour.radius) + " m is not positive");
  }
  const Grid& grid = volume.grid;
  const Vec3 centre = grid.to_grid(tumour.centre);
  const Vec3 reach = Vec3::Constant(tumour.radius);
  const IndexBox box = indices_around(grid, {tumour.centre - reach, tumour.centre + reach});
  const std::int64_t row = grid.size[0], slice = row * grid.size[1];
  std::visit(
      [&](auto& values) {
        using T = typename std::decay_t<decltype(values)>::value_type;
        const T raw = voxel_for<T>(volume, tumour.value, "tumour");
        bool hit = false;
        for_each_index(box, [&](std::int64_t x, std::int64_t y, std::int64_t z) {
          if ((place_of(grid, x, y, z) - centre).norm() > tumour.radius) return;
          values[static_cast<std::size_t>(x + y * row + z * slice)] = raw;
          hit = true;
        });
        if (!hit) {
          throw InputError(ErrorCode::kParam,
                           "tumour: no voxel lies within " + to_text(tumour.radius) + " m of " +
                               to_text(tumour.centre.x()) + ", " + to_text(tumour.centre.y()) +
                               ", " + to_text(tumour.centre.z()));
        }
      },
      volume.voxels);
}

Volume crop_volume(const Volume& volume, const Box& box) {
  if (!box.low.allFinite() || !box.high.allFinite() || (box.high - box.low).minCoeff() <= 0.0) {
    throw InputError(ErrorCode::kParam, "crop: its corners do not span a box");
  }
  const Grid& grid = volume.grid;
  const IndexBox indices = indices_around(grid, box);
  Volume cropped = volume;
  for (int axis = 0; axis < 3; ++axis) {
    if (indices.high[axis] < indices.low[axis]) {
      throw InputError(ErrorCode::kParam, "crop: the box holds no voxel of the volume");
    }
    cropped.grid.size[axis] =
        static_cast<std::uint32_t>(indices.high[axis] - indices.low[axis] + 1);
  }
  cropped.grid.origin =
      grid.to_world(place_of(grid, indices.low[0], indices.low[1], indices.low[2]));
  const std::int64_t row = grid.size[0], slice = row * grid.size[1];
  std::visit(
      [&](auto& kept) {
        const auto& all = std::get<std::decay_t<decltype(kept)>>(volume.voxels);
        kept.clear();
        for_each_index(indices, [&](std::int64_t x, std::int64_t y, std::int64_t z) {
          kept.push_back(all[static_cast<std::size_t>(x + y * row + z * slice)]);
        });
      },
      cropped.voxels);
  return cropped;
}

}  // namespace tissue
