#include "tissue/field/edit_volume.h"

#include "support/mesh_checks.h"
#include "support/shapes.h"

#include <cmath>

namespace {

using namespace tissue;
using tissue_test::refusal;

Volume grey() {
  Volume volume = *tissue_test::byte_volume(20, [](double, double, double) { return 50.0; });
  volume.grid.origin = Vec3(0.1, 0.2, 0.3);
  // A quarter turn about z: grid x runs along world y.
  volume.grid.axes << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  return volume;
}

std::uint8_t value_at_world(const Volume& volume, const Vec3& world) {
  const Vec3 index = volume.grid.to_grid(world).cwiseQuotient(volume.grid.spacing);
  const auto round = [&](int axis) { return static_cast<std::size_t>(std::lround(index[axis])); };
  const auto& n = volume.grid.size;
  return std::get<std::vector<std::uint8_t>>(
      volume.voxels)[round(0) + n[0] * (round(1) + n[1] * round(2))];
}

TEST(InsertTumour, FillsABallInTheWorldFrame) {
  Volume volume = grey();
  const Vec3 centre = volume.grid.to_world(Vec3(10e-3, 6e-3, 8e-3));
  insert_tumour(volume, {centre, 4e-3, 255.0});
  EXPECT_EQ(value_at_world(volume, centre), 255);
  EXPECT_EQ(value_at_world(volume, centre + Vec3(3.3e-3, 0, 0)), 255);
  EXPECT_EQ(value_at_world(volume, centre + Vec3(4.6e-3, 0, 0)), 50);
  std::size_t count = 0;
  for (const std::uint8_t value : std::get<std::vector<std::uint8_t>>(volume.voxels)) {
    count += value == 255;
  }
  EXPECT_NEAR(static_cast<double>(count), 4.0 / 3.0 * M_PI * 64.0, 30.0);
}

TEST(InsertTumour, RefusesWhatCannotBePut) {
  Volume volume = grey();
  const Vec3 centre = volume.grid.to_world(Vec3(10e-3, 6e-3, 8e-3));
  EXPECT_EQ(refusal([&] {
              insert_tumour(volume, {centre, 4e-3, 300.0});
            }),
            "E_PARAM: tumour: value 300 does not fit into voxels of 8UC1");
  EXPECT_EQ(refusal([&] {
              insert_tumour(volume, {centre, -1.0, 255.0});
            }),
            "E_PARAM: tumour: radius -1 m is not positive");
  EXPECT_EQ(refusal([&] {
              insert_tumour(volume, {Vec3::Zero(), 4e-3, 255.0});
            }).find("E_PARAM: tumour: no voxel lies within"),
            0u);
}

TEST(CropVolume, KeepsVoxelsWhereTheyAre) {
  Volume volume = grey();
  const Vec3 centre = volume.grid.to_world(Vec3(10e-3, 6e-3, 8e-3));
  insert_tumour(volume, {centre, 1e-3, 200.0});
  const Volume cropped =
      crop_volume(volume, {centre - Vec3::Constant(3.2e-3), centre + Vec3(2.2e-3, 3.2e-3, 4.2e-3)});
  EXPECT_EQ(cropped.grid.size, (GridSize{7, 6, 8}));
  EXPECT_EQ(value_at_world(cropped, centre), 200);
  EXPECT_EQ(value_at_world(cropped, centre + Vec3(2e-3, 0, 0)), 50);
}

TEST(CropVolume, RefusesABoxWithoutVoxels) {
  EXPECT_EQ(refusal([] {
              crop_volume(grey(), {Vec3::Constant(5), Vec3::Constant(6)});
            }),
            "E_PARAM: crop: the box holds no voxel of the volume");
  EXPECT_EQ(refusal([] {
              crop_volume(grey(), {Vec3::Constant(1), Vec3::Zero()});
            }),
            "E_PARAM: crop: its corners do not span a box");
}

}  // namespace
