#include "tissue/field/density_window.h"

#include "support/shapes.h"
#include "tissue/field/density_sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using namespace tissue;
using tissue_test::VolumePtr;

TEST(DensityWindow, V17_MakesEveryDensityPositive) {
  // Hounsfield units: the window spans what is inside the organ, and nothing falls below 1.
  auto volume = std::make_shared<Volume>(
      *tissue_test::float_volume(16, [](double x, double, double) { return -1024.0 + 273.0 * x; }));
  volume->quantity = Quantity::kHounsfield;
  const ImplicitSurface surface = surface_at_iso(volume, -500.0);
  const DensityWindow window = default_window(*volume, surface, 255.0);
  const double low = -1024.0 + 273.0 * 2, high = -1024.0 + 273.0 * 15;
  EXPECT_NEAR(window.density(low + (high - low) / 255.0 * 7.0), 7.0, 1e-9);
  EXPECT_EQ(window.density(-1024.0), 1.0);
  EXPECT_EQ(window.density(high), 255.0);
  EXPECT_EQ(window.density(5000.0), 255.0);
  EXPECT_NEAR(window.density(0.5 * (low + high)), 127.5, 1e-9);
}

TEST(DensityWindow, LeavesEightBitValuesAsTheyAreWhateverTheEncoding) {
  const auto ramp = [](double x, double, double) { return 10.0 * x; };
  for (const auto& volume :
       {tissue_test::byte_volume(16, ramp), tissue_test::float_volume(16, ramp)}) {
    const DensityWindow window = default_window(*volume, surface_at_iso(volume, 20.0), 255.0);
    EXPECT_EQ(window.density(73.0), 73.0);
    EXPECT_EQ(window.density(0.0), 1.0);
  }
}

// One tet, alone in a volume of 1 mm voxels, sampled as one with long edges of `edge` [m].
float sampled(const VolumePtr& volume, const std::vector<Vec3f>& corners, double edge) {
  const DensityWindow identity(0.0, 255.0, 255.0);
  return sample_tet_densities(*volume, identity, corners, {{0, 1, 2, 3}}, {0}, edge, {})[0];
}

TEST(SampleTetDensities, IntegratesALinearDensityExactlyAtEverySize) {
  const auto density = [](double x, double y, double z) { return 30.0 + 2.0 * x - y + 0.5 * z; };
  const auto volume = tissue_test::float_volume(40, density);
  const std::vector<Vec3f> corners = {{0.002f, 0.003f, 0.004f},
                                      {0.034f, 0.005f, 0.001f},
                                      {0.003f, 0.031f, 0.006f},
                                      {0.007f, 0.004f, 0.036f}};
  const Vec3f mean = 1000.0f / 4.0f * (corners[0] + corners[1] + corners[2] + corners[3]);
  for (const double edge : {0.0005, 0.004, 0.005, 0.011, 0.03, 0.1}) {
    EXPECT_NEAR(sampled(volume, corners, edge), density(mean.x(), mean.y(), mean.z()), 1e-3);
  }
}

TEST(SampleTetDensities, SeesAStepInsideALargeTet) {
  // Half of the tet has density 10: a sample at the centroid alone would say 1 or 10.
  const auto volume =
      tissue_test::float_volume(40, [](double x, double, double) { return x < 8.25 ? 10.0 : 1.0; });
  const std::vector<Vec3f> corners = {{0, 0, 0}, {0.039f, 0, 0}, {0, 0.039f, 0}, {0, 0, 0.039f}};
  EXPECT_NEAR(sampled(volume, corners, 0.02), 5.5, 0.5);
}

TEST(SampleDensities, AgreesWithOneSampleAtATime) {
  // Enough places for whole batches and a rest, some of them beyond the volume, in every type.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(-0.004, 0.024);
  std::vector<Vec3f> places;
  for (int i = 0; i < 501; ++i) {
    places.push_back(Vec3(anywhere(random), anywhere(random), anywhere(random)).cast<float>());
  }
  const auto bytes = tissue_test::byte_volume(20, [](double x, double y, double z) {
    return 128.0 + 100.0 * std::sin(x) * std::cos(2.0 * y) * std::sin(0.7 * z);
  });
  Volume volume = *bytes;
  volume.slope = -0.5;
  volume.intercept = 140.0;
  const auto& raw = std::get<std::vector<std::uint8_t>>(bytes->voxels);
  const DensityWindow window(20.0, 150.0, 255.0);
  const std::vector<Voxels> encodings = {raw,
                                         std::vector<std::uint16_t>(raw.begin(), raw.end()),
                                         std::vector<std::int16_t>(raw.begin(), raw.end()),
                                         std::vector<std::int32_t>(raw.begin(), raw.end()),
                                         std::vector<float>(raw.begin(), raw.end()),
                                         std::vector<double>(raw.begin(), raw.end())};
  for (const Quantity quantity : {Quantity::kDensity, Quantity::kLabel}) {
    for (const Voxels& voxels : encodings) {
      volume.voxels = voxels;
      volume.quantity = quantity;
      const std::vector<float> found = sample_densities(volume, window, places, 0, {}, {});
      with_sampler(volume, [&](const auto& value) {
        for (std::size_t i = 0; i < places.size(); ++i) {
          // A ten-thousandth of a voxel, where a voxel makes up to 255 of difference.
          ASSERT_NEAR(found[i], window.density(value(places[i].cast<double>())), 0.03);
        }
      });
    }
  }
}

TEST(SampleDensities, ReadsVolumesOfOneVoxel) {
  const auto voxel = tissue_test::byte_volume(1, [](double, double, double) { return 77.0; });
  const DensityWindow identity(0.0, 255.0, 255.0);
  EXPECT_EQ(sample_densities(*voxel, identity, {Vec3f(0, 0, 0), Vec3f(1, 1, 1)}, 0, {}, {}),
            (std::vector<float>{77.0f, 77.0f}));
}

}  // namespace
