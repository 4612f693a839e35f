#include "tissue/field/implicit_surface.h"

#include "support/mesh_checks.h"
#include "support/shapes.h"
#include "tissue/field/mask.h"
#include "tissue/field/surface_distance.h"
#include "tissue/field/surface_search.h"

#include <cmath>
#include <limits>

namespace {

using namespace tissue;
using tissue_test::byte_volume;
using tissue_test::float_volume;
using tissue_test::refusal;

double distance(double x, double y, double z) {
  return std::sqrt((x - 15.5) * (x - 15.5) + (y - 15.5) * (y - 15.5) + (z - 15.5) * (z - 15.5));
}

TEST(Trilinear, ReproducesALinearFunctionEverywhere) {
  const auto volume =
      float_volume(8, [](double x, double y, double z) { return 1.0 + 2.0 * x - 3.0 * y + z; });
  with_sampler(*volume, [](const auto& value) {
    const Vec3 index(2.25, 6.5, 3.75);
    EXPECT_NEAR(value(index * 1e-3), 1.0 + 4.5 - 19.5 + 3.75, 1e-9);
    // Beyond the outermost centres the value stays.
    EXPECT_NEAR(value(Vec3(-1.0, 0.0, 0.0)), 1.0, 1e-9);
    EXPECT_NEAR(value(Vec3(7e-3, 7e-3, 7e-3)), 1.0, 1e-9);
  });
}

TEST(Nearest, NeverBlendsLabels) {
  Volume volume = *byte_volume(4, [](double x, double, double) { return x < 1.5 ? 10 : 30; });
  volume.quantity = Quantity::kLabel;
  with_sampler(volume, [](const auto& value) {
    EXPECT_EQ(value(Vec3(1.4e-3, 0, 0)), 10.0);
    EXPECT_EQ(value(Vec3(1.6e-3, 0, 0)), 30.0);
  });
}

TEST(BracketedRoot, FindsTheCrossingOfASaturatedField) {
  // Grey values saturate: a straight line between the ends would be far off.
  const auto volume = byte_volume(16, [](double x, double, double) {
    return x < 4.0 ? 255.0 : x < 5.0 ? 200.0 : 0.0;
  });
  const ImplicitSurface surface = surface_at_iso(volume, 100.0);
  with_implicit_function(surface, [](const auto& f) {
    const Vec3 a(0, 5e-3, 5e-3), b(14e-3, 5e-3, 5e-3);
    const double t = bracketed_root(f, a, b, f(a), f(b));
    // 200 falls to 0 between voxels 4 and 5.
    EXPECT_NEAR(t * 14.0, 4.5, 1e-5);
  });
}

TEST(SurfaceAtIso, V7_SaysHowFarTheDataReach) {
  const auto air = byte_volume(8, [](double, double, double) { return 3.0; });
  EXPECT_EQ(refusal([&] { surface_at_iso(air, 20.0); }),
            "E_EMPTY_SURFACE: iso_value: 20 leaves nothing inside; the data reach from 3 to 3");
  EXPECT_EQ(refusal([&] { surface_at_iso(air, std::nan("")); }).substr(0, 7), "E_PARAM");
}

TEST(SurfaceOfMask, LiesHalfWayBetweenSetAndUnsetVoxels) {
  Volume mask = *byte_volume(16, [](double x, double, double) { return x < 8.0 ? 1.0 : 0.0; });
  mask.quantity = Quantity::kLabel;
  mask.grid.spacing = Vec3(3e-3, 1e-3, 1e-3);
  const ImplicitSurface surface = surface_of_mask(std::make_shared<Volume>(mask));
  with_implicit_function(surface, [](const auto& f) {
    const Vec3 a(6e-3, 8e-3, 8e-3), b(39e-3, 8e-3, 8e-3);
    EXPECT_LT(f(a), 0.0);
    EXPECT_NEAR(a.x() + bracketed_root(f, a, b, f(a), f(b)) * 33e-3, 22.5e-3, 1e-6);
  });
  EXPECT_NEAR(voxel_volume_inside(surface), 8 * 16 * 16 * 3e-9, 1e-12);
}

TEST(SurfaceOfMask, RefusesAnEmptyMask) {
  const auto mask = byte_volume(8, [](double, double, double) { return 0.0; });
  EXPECT_EQ(refusal([&] { surface_of_mask(mask); }).substr(0, 15), "E_EMPTY_SURFACE");
}

TEST(OpenMask, RemovesAThreadButNotTheBall) {
  const auto volume = byte_volume(32, [](double x, double y, double z) {
    const bool thread = std::abs(y - 15.0) < 0.6 && std::abs(z - 15.0) < 0.6;
    return distance(x, y, z) < 9.0 || thread ? 200.0 : 0.0;
  });
  const Volume mask = threshold_mask(*volume, 100.0);
  const Volume opened = open_mask(mask, 2);
  const auto at = [](const Volume& m, std::size_t x) {
    return std::get<std::vector<std::uint8_t>>(m.voxels)[x + 32 * (15 + 32 * 15)];
  };
  EXPECT_EQ(at(mask, 2), 1);
  EXPECT_EQ(at(opened, 2), 0);
  EXPECT_EQ(at(opened, 15), 1);
  EXPECT_EQ(refusal([&] { open_mask(mask, 0); }).substr(0, 7), "E_PARAM");
}

TEST(SmoothMask, KeepsTheVolumeOfABallAndSmoothsItsSteps) {
  const auto volume = byte_volume(
      32, [](double x, double y, double z) { return distance(x, y, z) < 10.0 ? 9 : 0; });
  const auto mask = std::make_shared<Volume>(threshold_mask(*volume, 1.0));
  const auto smooth = std::make_shared<Volume>(smooth_mask(*mask, 1.5));
  const ImplicitSurface surface = surface_of_mask(smooth);
  const double ball = 4.0 / 3.0 * M_PI * 1000.0 * 1e-9;
  EXPECT_NEAR(voxel_volume_inside(surface), ball, 0.06 * ball);
  // Blurring shrinks a ball of radius r by about sigma²/r, here 0.2 voxels.
  with_implicit_function(surface, [](const auto& f) {
    for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(1, 1, 1), Vec3(1, 2, 3)}) {
      const Vec3 centre = Vec3::Constant(15.5e-3), out = centre + 14e-3 * direction.normalized();
      const double t = bracketed_root(f, centre, out, f(centre), f(out));
      EXPECT_NEAR(t * 14.0, 9.8, 0.25) << direction.transpose();
    }
  });
}

TEST(SurfaceDistance, MeasuresHowFarVerticesAreOff) {
  const auto volume = float_volume(
      32, [](double x, double y, double z) { return 50.0 + 5.0 * (10.0 - distance(x, y, z)); });
  const ImplicitSurface surface = surface_at_iso(volume, 50.0);
  const Vec3 centre = Vec3::Constant(15.5e-3);
  // On the surface, 0.8 mm outside, 1.2 mm inside.
  std::vector<Vec3f> vertices;
  for (const double radius : {10.0e-3, 10.8e-3, 8.8e-3}) {
    vertices.push_back((centre + radius * Vec3(1, 2, 2).normalized()).cast<float>());
  }
  const SurfaceDistance found = surface_distance(surface, vertices, {{0, 1, 2}}, 4e-3, {});
  EXPECT_NEAR(found.max, 1.2e-3, 0.03e-3);
  EXPECT_NEAR(found.mean, 2.0e-3 / 3.0, 0.03e-3);
  EXPECT_EQ(found.vertices, 3u);
  EXPECT_EQ(found.astray, 2u);
}

TEST(SurfaceSearch, FindsTheNearestOfWhatLiesAroundWhereTheGradientLeadsNowhere) {
  // Inside a plateau, whose nearest side lies 2.5 mm away.
  const auto volume = float_volume(32, [](double x, double y, double z) {
    return x > 8 && x < 20 && y > 8 && y < 24 && z > 8 && z < 24 ? 100.0 : 0.0;
  });
  const ImplicitSurface surface = surface_at_iso(volume, 50.0);
  with_implicit_function(surface, [](const auto& f) {
    const SurfacePoint found = search_surface(f, Vec3(17e-3, 16e-3, 16e-3), 1e-3, 8e-3);
    EXPECT_TRUE(found.found);
    EXPECT_NEAR(found.distance, 2.5e-3, 1e-5);
    EXPECT_NEAR(found.place.x(), 19.5e-3, 1e-5);
    EXPECT_FALSE(search_surface(f, Vec3(14e-3, 16e-3, 16e-3), 1e-3, 3e-3).found);
  });
}

}  // namespace
