// Parameters from files of settings.
#include "ros/settings.h"

#include "ros/parameters.h"
#include "support/mesh_checks.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace {

using namespace tissue_ros;
using tissue_test::refusal;

class SettingsTest : public testing::Test {
 protected:
  ~SettingsTest() override { std::filesystem::remove(file_); }

  Settings settings(const std::string& text) {
    std::ofstream(file_) << text;
    return Settings("deformer_node", {file_});
  }
  DeformerNodeParameters read(const std::string& line) {
    return settings("deformer_node: {" + line + "}").in_files<DeformerNodeParameters>();
  }
  std::string refused(const std::string& line) {
    return refusal([&] { read(line); });
  }

  std::string file_ = testing::TempDir() + "tissue_settings.yaml";
};

TEST_F(SettingsTest, WhatAFileSaysGoesOverTheDefaults) {
  const DeformerNodeParameters parameters =
      read("scene: a.yaml, deterministic: true, cloud_rate: 60");
  EXPECT_EQ(parameters.scene, "a.yaml");
  EXPECT_TRUE(parameters.deterministic);
  EXPECT_EQ(parameters.cloud_rate, 60.0);
  EXPECT_EQ(parameters.marker_rate, DeformerNodeParameters{}.marker_rate);
  // Other nodes' sections are theirs.
  EXPECT_EQ(settings("mesher_node: {iso_value: 5}").in_files<DeformerNodeParameters>().cloud_rate,
            DeformerNodeParameters{}.cloud_rate);
}

TEST_F(SettingsTest, LaterFilesGoOverEarlierOnes) {
  const std::string other = file_ + "2";
  std::ofstream(file_) << "deformer_node: {cloud_rate: 60, marker_rate: 5}";
  std::ofstream(other) << "deformer_node: {cloud_rate: 20}";
  const auto parameters =
      Settings("deformer_node", {file_, other}).in_files<DeformerNodeParameters>();
  std::filesystem::remove(other);
  EXPECT_EQ(parameters.cloud_rate, 20.0);
  EXPECT_EQ(parameters.marker_rate, 5.0);
}

TEST_F(SettingsTest, X3WhatIsWrongIsNamedWithItsValue) {
  EXPECT_EQ(refused("cloud_rate: fast"), "E_PARAM: ~cloud_rate: fast is not a number");
  EXPECT_EQ(refused("cloud_rate: .nan"), "E_NONFINITE: ~cloud_rate: .nan is not finite");
  EXPECT_EQ(refused("cloud_rate: 0"), "E_PARAM: ~cloud_rate: 0 is not between 0.0001 and 10000");
  EXPECT_EQ(refused("marker_max_triangles: 2.5"),
            "E_PARAM: ~marker_max_triangles: 2.5 is not a whole number");
  EXPECT_EQ(refused("deterministic: perhaps"),
            "E_PARAM: ~deterministic: perhaps is not true or false");
  EXPECT_EQ(refused("clod_rate: 30"),
            "E_PARAM: settings: 'clod_rate' is not a parameter of deformer_node");
  EXPECT_EQ(refusal([] { Settings("deformer_node", {"nowhere.yaml"}); }),
            "E_FILE: settings: 'nowhere.yaml': bad file: nowhere.yaml");
}

// Whatever its value is: each is either taken or refused, and none is taken that is not finite.
TEST_F(SettingsTest, X3EveryNumberIsFiniteAndInRange) {
  DeformerNodeParameters all;
  std::vector<std::string> names;
  all.visit([&](const char* name, auto&, const auto&... range) {
    if (sizeof...(range) > 0) names.push_back(name);
  });
  EXPECT_GT(names.size(), 5u);
  for (const std::string& name : names) {
    for (const std::string value : {".nan", ".inf", "-.inf", "-1e300", "1e300", "-1"}) {
      EXPECT_NE(refused(name + ": " + value), "") << name << " " << value;
    }
  }
}

TEST_F(SettingsTest, AListMayBeAWordThatReadsAsOne) {
  std::ofstream(file_) << "volume_node: {tumour: '[0.1, 0.2, 0.3, 0.01, 255]', crop: [1, 2]}";
  const auto parameters = Settings("volume_node", {file_}).in_files<VolumeNodeParameters>();
  EXPECT_EQ(parameters.tumour, (std::vector<double>{0.1, 0.2, 0.3, 0.01, 255.0}));
  EXPECT_EQ(parameters.crop, (std::vector<double>{1.0, 2.0}));
  std::ofstream(file_) << "volume_node: {tumour: '[0.1, big]'}";
  EXPECT_EQ(refusal([&] { Settings("volume_node", {file_}).in_files<VolumeNodeParameters>(); }),
            "E_PARAM: ~tumour: big is not a number");
}

}  // namespace
