#include "support/shapes.h"

#include "tissue/field/read_volume.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <random>

namespace tissue_test {
namespace {

template <class T, class Convert>
VolumePtr make_volume(std::uint32_t size, const std::function<double(double, double, double)>& f,
                      const Convert& convert) {
  auto volume = std::make_shared<tissue::Volume>();
  volume->grid.size = {size, size, size};
  volume->grid.spacing = tissue::Vec3::Constant(1e-3);
  std::vector<T> values;
  for (std::uint32_t z = 0; z < size; ++z) {
    for (std::uint32_t y = 0; y < size; ++y) {
      for (std::uint32_t x = 0; x < size; ++x) values.push_back(convert(f(x, y, z)));
    }
  }
  volume->voxels = std::move(values);
  return volume;
}

double norm(double x, double y, double z) { return std::sqrt(x * x + y * y + z * z); }

// Value noise: random numbers on a coarse grid, blended smoothly.
double noise(double x, double y, double z) {
  const auto random = [](int i, int j, int k) {
    std::mt19937 generator(static_cast<unsigned>(i * 73856093 ^ j * 19349663 ^ k * 83492791));
    return std::uniform_real_distribution<double>(-1.0, 1.0)(generator);
  };
  const int i = static_cast<int>(x), j = static_cast<int>(y), k = static_cast<int>(z);
  const auto smooth = [](double t) { return t * t * (3.0 - 2.0 * t); };
  const double u = smooth(x - i), v = smooth(y - j), w = smooth(z - k);
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const int a = corner & 1, b = corner >> 1 & 1, c = corner >> 2;
    sum += (a != 0 ? u : 1 - u) * (b != 0 ? v : 1 - v) * (c != 0 ? w : 1 - w) *
           random(i + a, j + b, k + c);
  }
  return sum;
}

std::string real_data(const std::string& name) {
  return std::string(TISSUE_SOURCE_DIR) + "/../shared/data/" + name;
}

}  // namespace

VolumePtr float_volume(std::uint32_t size, const std::function<double(double, double, double)>& f) {
  return make_volume<float>(size, f, [](double value) { return static_cast<float>(value); });
}

VolumePtr byte_volume(std::uint32_t size, const std::function<double(double, double, double)>& f) {
  return make_volume<std::uint8_t>(size, f, [](double value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
  });
}

VolumePtr organ_phantom(const tissue::GridSize& size) {
  auto volume = std::make_shared<tissue::Volume>();
  volume->grid.size = size;
  volume->grid.spacing = tissue::Vec3::Constant(1e-3);
  std::vector<std::uint8_t> values;
  values.reserve(volume->grid.voxel_count());
  std::mt19937 generator(7);
  const double width = *std::min_element(size.begin(), size.end());
  for (std::uint32_t z = 0; z < size[2]; ++z) {
    for (std::uint32_t y = 0; y < size[1]; ++y) {
      for (std::uint32_t x = 0; x < size[0]; ++x) {
        // From −1 to 1 across the volume.
        const double u = 2.0 * x / size[0] - 1.0, v = 2.0 * y / size[1] - 1.0,
                     w = 2.0 * z / size[2] - 1.0;
        const double folds = 0.03 * std::sin(17.0 * u) * std::sin(15.0 * v) * std::sin(13.0 * w);
        const double depth = 0.5 * width * (0.88 + folds - norm(u, v, w));
        const double texture = 90.0 + 25.0 * std::sin(5.0 * u + 3.0 * v) * std::cos(6.0 * w);
        const double grain = static_cast<double>(generator() % 32u) - 16.0;
        const double inside = std::clamp(0.5 + 0.5 * depth, 0.0, 1.0);
        double value = inside * (texture + grain);
        const double to_tumour =
            norm(0.5 * size[0] * (u - 0.2), 0.5 * size[1] * v, 0.5 * size[2] * w);
        if (to_tumour < width / 7.0) value = 255.0;
        values.push_back(static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0)));
      }
    }
  }
  volume->voxels = std::move(values);
  return volume;
}

static std::vector<Shape> make_synthetic_shapes() {
  const double c = 31.5;
  return {
      {"ball",
       float_volume(64, [c](double x, double y,
                            double z) { return 100.0 + 4.0 * (24.3 - norm(x - c, y - c, z - c)); }),
       100.0},
      {"torus",
       float_volume(64,
                    [c](double x, double y, double z) {
                      const double ring = std::hypot(x - c, y - c) - 17.2;
                      return 100.0 + 4.0 * (9.4 - std::hypot(ring, z - c));
                    }),
       100.0},
      {"sheet",
       float_volume(64,
                    [c](double x, double y, double z) {
                      const double thin = 2.6 - std::abs(z - c - 0.2 * (x - c));
                      return 100.0 + 10.0 * std::min(thin, 25.0 - std::hypot(x - c, y - c));
                    }),
       100.0},
      {"touching_balls",
       float_volume(64,
                    [c](double x, double y, double z) {
                      const double left = 12.4 - norm(x - c + 12.4, y - c, z - c);
                      const double right = 12.4 - norm(x - c - 12.4, y - c, z - c);
                      return 100.0 + 4.0 * std::max(left, right);
                    }),
       100.0},
      {"blob",
       byte_volume(64,
                   [c](double x, double y, double z) {
                     return 100.0 + 4.0 * (20.0 - norm(x - c, y - c, z - c)) +
                            90.0 * noise(x / 9.0, y / 9.0, z / 9.0);
                   }),
       100.0},
      // Its faces lie on planes of lattice points at a spacing of 4 mm.
      {"cube",
       float_volume(
           64,
           [c](double x, double y, double z) {
             const double reach = std::max({std::abs(x - c), std::abs(y - c), std::abs(z - c)});
             return 100.0 + 5.0 * (20.0 - reach);
           }),
       100.0},
      // Blocks of three values, the middle one the iso value itself.
      {"ties",
       byte_volume(64,
                   [c](double x, double y, double z) {
                     const double depth = 22.0 - norm(x - c, y - c, z - c);
                     return depth > 3.0 ? 140.0 : depth > 0.0 ? 100.0 : 60.0;
                   }),
       100.0},
  };
}

const std::vector<Shape>& synthetic_shapes() {
  static const std::vector<Shape> shapes = make_synthetic_shapes();
  return shapes;
}

std::vector<Shape> real_volumes() {
  std::vector<Shape> shapes = {{"ch2bet", shipped_brain(), 20.0}};
  for (const std::string name :
       {"seg3d_mr_brain.nii.gz", "invesalius_brain_u8_tumour_r10.nii.gz"}) {
    if (!std::ifstream(real_data(name))) {
      std::cout << "[   NOTE   ] " << name << " is not at hand and is skipped\n";
      continue;
    }
    shapes.push_back(
        {name, std::make_shared<tissue::Volume>(tissue::read_volume(real_data(name))), 40.0});
  }
  return shapes;
}

VolumePtr shipped_brain() {
  return std::make_shared<tissue::Volume>(
      tissue::read_volume(std::string(TISSUE_SOURCE_DIR) + "/data/ch2bet.nii.gz"));
}

}  // namespace tissue_test
