#include "tissue/field/read_volume.h"

#include "support/mesh_checks.h"
#include "support/shapes.h"

#include <filesystem>
#include <fstream>

namespace {

using tissue::Vec3;
using tissue_test::refusal;

// A MetaImage of 2 x 3 x 4 bytes 0 … 23 with the given direction matrix, in LPS and millimetres.
std::string write_meta_image(const std::string& matrix) {
  const std::string path =
      (std::filesystem::temp_directory_path() / "tissue_read_volume_test.mha").string();
  std::ofstream file(path, std::ios::binary);
  file << "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
       << "CompressedData = False\nTransformMatrix = " << matrix
       << "\nOffset = 10 20 30\nElementSpacing = 1 2 3\nDimSize = 2 3 4\n"
       << "ElementType = MET_UCHAR\nElementDataFile = LOCAL\n";
  for (char value = 0; value < 24; ++value) file.put(value);
  return path;
}

// Where the voxel with this value lies in the world.
Vec3 place_of(const tissue::Volume& volume, std::uint8_t value) {
  const auto& values = std::get<std::vector<std::uint8_t>>(volume.voxels);
  const auto i =
      static_cast<std::uint32_t>(std::find(values.begin(), values.end(), value) - values.begin());
  const auto& n = volume.grid.size;
  return volume.grid.to_world(
      Vec3(i % n[0], i / n[0] % n[1], i / n[0] / n[1]).cwiseProduct(volume.grid.spacing));
}

TEST(ReadVolume, GivesTheShippedBrainInMetresAndRas) {
  const tissue_test::VolumePtr brain = tissue_test::shipped_brain();
  EXPECT_EQ(brain->grid.size, (tissue::GridSize{181, 217, 181}));
  EXPECT_LT((brain->grid.spacing - Vec3::Constant(1e-3)).norm(), 1e-12);
  // The affine of the file: −90 −125 −71 mm in RAS.
  EXPECT_LT((brain->grid.to_world(Vec3::Zero()) - Vec3(-0.090, -0.125, -0.071)).norm(), 1e-9);
  EXPECT_LT((brain->grid.to_world(Vec3(1e-3, 0, 0)) - Vec3(-0.089, -0.125, -0.071)).norm(), 1e-9);
  EXPECT_EQ(value_range(*brain), (std::array<double, 2>{0.0, 133.0}));
}

TEST(ReadVolume, V11_PutsEveryVoxelWhereTheDirectionMatrixSays) {
  // Identity, a quarter turn, and a left-handed flip of z.
  for (const std::string matrix :
       {"1 0 0 0 1 0 0 0 1", "0 1 0 -1 0 0 0 0 1", "1 0 0 0 1 0 0 0 -1"}) {
    const tissue::Volume volume = tissue::read_volume(write_meta_image(matrix));
    EXPECT_NEAR(volume.grid.axes.determinant(), 1.0, 1e-12) << matrix;
    // MetaImage lists the matrix axis by axis.
    double m[9];
    std::sscanf(matrix.c_str(), "%lf %lf %lf %lf %lf %lf %lf %lf %lf", m, m + 1, m + 2, m + 3,
                m + 4, m + 5, m + 6, m + 7, m + 8);
    for (const auto& index : {std::array<int, 3>{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {1, 1, 3}}) {
      Vec3 lps(10, 20, 30);
      for (int axis = 0; axis < 3; ++axis) {
        lps += index[axis] * (axis + 1.0) * Vec3(m[3 * axis], m[3 * axis + 1], m[3 * axis + 2]);
      }
      const auto value = static_cast<std::uint8_t>(index[0] + 2 * index[1] + 6 * index[2]);
      const Vec3 expected = Vec3(-lps.x(), -lps.y(), lps.z()) * 1e-3;
      EXPECT_LT((place_of(volume, value) - expected).norm(), 1e-12) << matrix << " " << +value;
    }
  }
}

TEST(ReadVolume, V11_RefusesAxesThatAreNotOrthonormal) {
  const std::string text =
      refusal([] { tissue::read_volume(write_meta_image("1 0.1 0 0 1 0 0 0 1")); });
  EXPECT_TRUE(text.find("E_DIRECTION") == 0 || text.find("E_FILE") == 0) << text;
}

TEST(ReadVolume, SaysWhichFileItCannotRead) {
  EXPECT_EQ(refusal([] {
              tissue::read_volume("/nowhere/brain.nii.gz");
            }).find("E_FILE: volume: '/nowhere/brain.nii.gz' cannot be read"),
            0u);
  const std::string path =
      (std::filesystem::temp_directory_path() / "tissue_no_volume.nii.gz").string();
  std::ofstream(path) << "this is not a volume";
  EXPECT_EQ(refusal([&] { tissue::read_volume(path); }).substr(0, 6), "E_FILE");
}

}  // namespace
