#include "support/dicom_writer.h"
#include "support/mesh_checks.h"
#include "tissue/field/read_volume.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace {

using namespace tissue;
using tissue_test::refusal;
using tissue_test::write_dicom_slice;
namespace fs = std::filesystem;

const std::string kSeries = "1.2.826.0.1.3680043.2.1125.7";

class Dicom : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("tissue_dicom_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  // Slices in an order of names that is not that of their places.
  void write(const std::vector<double>& heights, const std::string& series = kSeries) {
    for (std::size_t i = 0; i < heights.size(); ++i) {
      const std::string name = series + "_" + std::to_string(heights.size() - i) + ".dcm";
      write_dicom_slice((folder_ / name).string(), series, static_cast<int>(i), heights[i]);
    }
  }
  fs::path folder_;
};

TEST_F(Dicom, ReadsTheSeriesOfAFolderInTheOrderOfItsPlaces) {
  write({3.0, 5.0, 7.0, 9.0});
  const Volume volume = read_volume(folder_.string());
  EXPECT_EQ(volume.grid.size, (GridSize{6, 5, 4}));
  EXPECT_LT((volume.grid.spacing - Vec3(0.5e-3, 0.7e-3, 2e-3)).norm(), 1e-9);
  // LPS in millimetres becomes RAS in metres.
  EXPECT_LT((volume.grid.to_world(Vec3::Zero()) - Vec3(10e-3, -20e-3, 3e-3)).norm(), 1e-9);
  const auto& values = std::get<std::vector<std::int16_t>>(volume.voxels);
  EXPECT_EQ(values[0], 30);
  EXPECT_EQ(values[5], 35);
  EXPECT_EQ(values[3 * 30 + 2], 92);
}

TEST_F(Dicom, ListsTheSeriesWhereThereAreSeveral) {
  write({1.0, 2.0, 3.0});
  write({1.0, 2.0}, kSeries + "9");
  const std::string text = refusal([&] { read_volume(folder_.string()); });
  EXPECT_EQ(text.substr(0, 6), "E_FILE");
  EXPECT_NE(text.find("holds 2 DICOM series"), std::string::npos) << text;
  EXPECT_NE(text.find("(3 files)"), std::string::npos) << text;
  EXPECT_NE(text.find("(2 files)"), std::string::npos) << text;
}

TEST_F(Dicom, V12_RefusesSlicesThatAreNotEvenlySpaced) {
  write({1.0, 2.0, 3.0, 5.0});
  const std::string text = refusal([&] { read_volume(folder_.string()); });
  EXPECT_EQ(text.substr(0, 53), "E_NONUNIFORM: volume: slices are 1 mm and 2 mm apart,") << text;
}

TEST_F(Dicom, SaysSoWhereAFolderHoldsNone) {
  EXPECT_NE(refusal([&] { read_volume(folder_.string()); }).find("holds no DICOM series"),
            std::string::npos);
}

}  // namespace
