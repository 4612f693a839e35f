#include "tissue/field/volume.h"

#include "support/mesh_checks.h"
#include "tissue/field/sample.h"

#include <cmath>
#include <cstring>
#include <limits>

namespace {

using tissue::RawVolume;
using tissue::Volume;
using tissue_test::refusal;

// 2 x 3 x 2 voxels of 16 bits, and their bytes.
struct Raw {
  std::vector<std::uint8_t> bytes = std::vector<std::uint8_t>(24, 0);
  RawVolume volume;
  Raw() {
    volume.size = {2, 3, 2};
    volume.spacing = tissue::Vec3(1e-3, 2e-3, 3e-3);
    volume.encoding = "16SC1";
    point_to_bytes();
  }
  void point_to_bytes() {
    volume.data = bytes.data();
    volume.data_size = bytes.size();
  }
  std::string refusal() const {
    return tissue_test::refusal([this] { decode_volume(volume); });
  }
};

TEST(DecodeVolume, TakesWhatIsSound) { EXPECT_EQ(Raw().refusal(), ""); }

TEST(DecodeVolume, V1_NamesBothLengthsWhenTheyDiffer) {
  for (const std::size_t bytes : {23u, 25u}) {
    Raw raw;
    raw.bytes.resize(bytes);
    raw.point_to_bytes();
    EXPECT_EQ(raw.refusal(), "E_SIZE_MISMATCH: volume: data has " + std::to_string(bytes) +
                                 " bytes, but 12 voxels of 16SC1 need 24");
  }
}

TEST(DecodeVolume, V2_RefusesImpossibleDimensionsBeforeItAllocates) {
  Raw raw;
  raw.volume.size = {2, 0, 2};
  EXPECT_EQ(raw.refusal(), "E_DIMS: volume: size along y is 0");
  for (const std::uint32_t n : {65536u, 0xffffffffu}) {
    raw.volume.size = {n, n, n};
    EXPECT_EQ(raw.refusal().substr(0, 11), "E_TOO_LARGE") << n;
  }
  // 2^32 · 2^32 · 1 wraps to 0 in 64 bits.
  raw.volume.size = {0xffffffffu, 0xffffffffu, 1};
  EXPECT_EQ(raw.refusal().substr(0, 11), "E_TOO_LARGE");
}

TEST(DecodeVolume, V3_NamesTheAxisOfABadSpacing) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  for (const double spacing : {0.0, -1.0, nan, inf, 1e-9, 1e3}) {
    Raw raw;
    raw.volume.spacing.y() = spacing;
    EXPECT_EQ(raw.refusal().find("E_SPACING: volume: spacing.y is "), 0u) << spacing;
  }
}

TEST(DecodeVolume, V4_DecodesBigEndianData) {
  Raw raw;
  raw.volume.is_bigendian = true;
  raw.bytes[0] = 0x01;
  raw.bytes[1] = 0x02;
  raw.bytes[22] = 0xff;
  raw.bytes[23] = 0xfe;
  const Volume volume = decode_volume(raw.volume);
  const auto& values = std::get<std::vector<std::int16_t>>(volume.voxels);
  EXPECT_EQ(values.front(), 0x0102);
  EXPECT_EQ(values.back(), -2);
}

TEST(DecodeVolume, V5_ListsTheEncodingsItKnows) {
  Raw raw;
  raw.volume.encoding = "8UC3";
  EXPECT_EQ(raw.refusal(),
            "E_ENCODING: volume: encoding '8UC3' is not one of 8UC1 16UC1 16SC1 32SC1 32FC1 64FC1");
  raw.volume.encoding = "8UC1";
  EXPECT_EQ(raw.refusal().substr(0, 15), "E_SIZE_MISMATCH");
}

TEST(DecodeVolume, V6_CountsValuesThatAreNotFinite) {
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    Raw raw;
    raw.volume.encoding = "64FC1";
    std::vector<double> values(12, 1.0);
    values[5] = values[7] = bad;
    raw.bytes.resize(96);
    std::memcpy(raw.bytes.data(), values.data(), 96);
    raw.point_to_bytes();
    const std::string text = raw.refusal();
    EXPECT_NE(text.find("E_NONFINITE: volume: data has 2 values"), std::string::npos) << text;
    EXPECT_NE(text.find("at voxel 5"), std::string::npos) << text;
  }
}

TEST(DecodeVolume, V6_RefusesAScaleThatOverflows) {
  Raw raw;
  raw.bytes[0] = 100;
  raw.volume.slope = 1e308;
  EXPECT_EQ(raw.refusal().substr(0, 11), "E_NONFINITE");
  raw.volume.slope = std::nan("");
  EXPECT_EQ(raw.refusal().substr(0, 7), "E_PARAM");
}

TEST(DecodeVolume, V11_RefusesAQuaternionThatIsNotOne) {
  for (const double w : {0.0, 2.0, std::nan("")}) {
    Raw raw;
    raw.volume.orientation = {0.0, 0.0, 0.0, w};
    EXPECT_EQ(raw.refusal().find("E_DIRECTION: volume: origin.orientation has norm "), 0u) << w;
  }
}

TEST(DecodeVolume, V14_RefusesAFrameThatCannotBeOne) {
  for (const std::string frame : {"", "/map"}) {
    Raw raw;
    raw.volume.frame_id = frame;
    EXPECT_EQ(raw.refusal().substr(0, 7), "E_FRAME") << frame;
  }
}

TEST(DecodeVolume, EveryEncodingGivesTheSameValues) {
  const auto value_with = [](const std::string& encoding, auto sample) {
    std::vector<decltype(sample)> values = {sample, 7};
    RawVolume raw;
    raw.size = {2, 1, 1};
    raw.spacing = tissue::Vec3::Constant(1e-3);
    raw.encoding = encoding;
    raw.data = reinterpret_cast<const std::uint8_t*>(values.data());
    raw.data_size = values.size() * sizeof(sample);
    raw.slope = 2.0;
    raw.intercept = -1.0;
    return with_sampler(decode_volume(raw),
                        [](const auto& value) { return value(tissue::Vec3(0.5e-3, 0, 0)); });
  };
  EXPECT_EQ(value_with("8UC1", std::uint8_t{3}), 9.0);
  EXPECT_EQ(value_with("16UC1", std::uint16_t{3}), 9.0);
  EXPECT_EQ(value_with("16SC1", std::int16_t{3}), 9.0);
  EXPECT_EQ(value_with("32SC1", std::int32_t{3}), 9.0);
  EXPECT_EQ(value_with("32FC1", 3.0f), 9.0);
  EXPECT_EQ(value_with("64FC1", 3.0), 9.0);
}

TEST(Grid, TakesPlacesToTheWorldAndBack) {
  tissue::Grid grid;
  grid.origin = tissue::Vec3(0.1, -0.2, 0.3);
  grid.axes = Eigen::AngleAxisd(0.7, tissue::Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const tissue::Vec3 place(0.01, 0.02, 0.03);
  EXPECT_LT((grid.to_grid(grid.to_world(place)) - place).norm(), 1e-15);
}

}  // namespace
