// What a node keeps for the one that takes its place.
#include "ros/kept_state.h"

#include "support/bodies.h"
#include "support/mesh_checks.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace {

using namespace tissue_ros;
namespace fs = std::filesystem;

class KeptStateTest : public testing::Test {
 protected:
  KeptStateTest() { fs::remove_all(folder_); }
  ~KeptStateTest() override { fs::remove_all(folder_); }

  void keep_all() {
    KeptState kept(folder_, "node");
    kept.keep(mesh_);
    kept.keep_scene("name: mine");
  }

  std::string folder_ = testing::TempDir() + "tissue_kept";
  std::shared_ptr<const tissue::TetMesh> mesh_ =
      std::make_shared<tissue::TetMesh>(tissue_test::refined_ball(0.024));
};

TEST_F(KeptStateTest, F1TheNextNodeHasTheSameMeshAndScene) {
  keep_all();
  const KeptState next(folder_, "node");
  ASSERT_TRUE(next.mesh());
  EXPECT_EQ(next.mesh()->uuid, mesh_->uuid);
  EXPECT_EQ(next.mesh()->vertices, mesh_->vertices);
  EXPECT_EQ(next.scene(), "name: mine");
  const KeptState other(folder_, "other");
  EXPECT_FALSE(other.mesh());
  EXPECT_FALSE(other.scene());
}

TEST_F(KeptStateTest, ANodeThatEndsWellLeavesNothing) {
  keep_all();
  KeptState(folder_, "node").forget();
  EXPECT_TRUE(fs::is_empty(folder_));
  // One that was to keep nothing has no folder either.
  fs::remove_all(folder_);
  KeptState nothing(folder_, "");
  nothing.keep(mesh_);
  nothing.keep_scene("name: mine");
  EXPECT_FALSE(nothing.mesh());
  nothing.forget();
  EXPECT_FALSE(fs::exists(folder_));
}

TEST_F(KeptStateTest, WhatWasCutIsAsIfItWereNotThere) {
  keep_all();
  const std::string file = folder_ + "/node.vtu";
  fs::resize_file(file, fs::file_size(file) / 2);
  EXPECT_FALSE(KeptState(folder_, "node").mesh());
}

TEST_F(KeptStateTest, NamesStayBelowTheFolder) {
  EXPECT_EQ(tissue_test::refusal([&] { KeptState(folder_, "../other"); }).substr(0, 6), "E_PATH");
}

}  // namespace
