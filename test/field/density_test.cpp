#include "tissue/field/density_window.h"

#include "support/shapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace tissue;

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

TEST(TetSampling, IntegratesALinearDensityExactlyAtEverySize) {
  const Vec3 a(0.1, 0.2, 0.3), b(1.2, 0.1, 0), c(0, 1.1, 0.2), d(0.3, 0.2, 1.4);
  const auto density = [](const Vec3& p) { return 3.0 + 2.0 * p.x() - p.y() + 0.5 * p.z(); };
  for (const double edge : {0.5, 4.0, 11.0, 100.0}) {
    EXPECT_NEAR(TetSampling(edge, Vec3::Ones()).mean(a, b, c, d, density),
                density((a + b + c + d) / 4.0), 1e-12);
  }
}

TEST(TetSampling, SeesAStepInsideALargeTet) {
  // Half of the tet has density 10: a sample at the centroid alone would say 0 or 10.
  const auto density = [](const Vec3& p) { return p.x() < 0.2063 ? 10.0 : 0.0; };
  const double mean =
      TetSampling(12.0, Vec3::Ones())
          .mean(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), density);
  EXPECT_NEAR(mean, 5.0, 1.0);
}

}  // namespace
