#include "tissue/base/safe_path.h"

#include "support/mesh_checks.h"
#include "tissue/base/atomic_file.h"

#include <sys/stat.h>

#include <filesystem>
#include <fstream>

namespace {

using namespace tissue;
using tissue_test::refusal;
namespace fs = std::filesystem;

// An empty folder with a folder beside it that nobody may get into.
class SafePath : public testing::Test {
 protected:
  void SetUp() override {
    base_ = fs::temp_directory_path() / ("tissue_safe_path_" + std::to_string(getpid()));
    fs::create_directories(base_ / "meshes" / "patients");
    fs::create_directories(base_ / "secret");
    std::ofstream(base_ / "secret" / "x.vtu") << "secret";
    std::ofstream(base_ / "meshes" / "here.vtu") << "here";
  }
  void TearDown() override { fs::remove_all(base_); }
  std::string folder() const { return (base_ / "meshes").string(); }
  fs::path base_;
};

TEST_F(SafePath, TakesFilesBelowTheFolder) {
  EXPECT_EQ(confined_path(folder(), "here.vtu", true), fs::canonical(folder()) / "here.vtu");
  EXPECT_EQ(confined_path(folder(), "patients/new.vtu", false),
            fs::canonical(folder()) / "patients" / "new.vtu");
}

TEST_F(SafePath, M11_RefusesEveryWayOut) {
  fs::create_directory_symlink(base_ / "secret", base_ / "meshes" / "link");
  fs::create_symlink(base_ / "secret" / "x.vtu", base_ / "meshes" / "file_link.vtu");
  ASSERT_EQ(mkfifo((base_ / "meshes" / "fifo.vtu").c_str(), 0600), 0);
  const std::vector<std::string> names = {"",
                                          "../../etc/x",
                                          "patients/../../secret/x.vtu",
                                          "..",
                                          "/etc/passwd",
                                          "link/x.vtu",
                                          "file_link.vtu",
                                          "fifo.vtu",
                                          "nowhere/x.vtu",
                                          "patients",
                                          "patients/",
                                          std::string("a\0b.vtu", 7),
                                          "a\nb.vtu",
                                          std::string(5000, 'x')};
  for (const std::string& name : names) {
    for (const bool must_exist : {true, false}) {
      const std::string text = refusal([&] { confined_path(folder(), name, must_exist); });
      EXPECT_EQ(text.substr(0, 6), "E_PATH") << name.substr(0, 40);
      EXPECT_LT(text.size(), 200u);
      EXPECT_EQ(text.find('\n'), std::string::npos);
    }
  }
  EXPECT_EQ(refusal([&] { confined_path(folder(), "absent.vtu", true); }).substr(0, 6), "E_PATH");
  // The sentence says which, though others would refuse it too.
  const auto says = [&](const std::string& name, const char* what) {
    return refusal([&] { confined_path(folder(), name, false); }).find(what) != std::string::npos;
  };
  EXPECT_TRUE(says((base_ / "meshes" / "here.vtu").string(), "is absolute"));
  EXPECT_TRUE(says("patients/../here.vtu", "leads upwards"));
}

TEST_F(SafePath, F1_WhatAWriterThatWasKilledLeftIsRemovedAndWhatALiveOneWritesIsNot) {
  std::ofstream(base_ / "meshes" / "old.part999999999.vtu") << "half";
  std::ofstream(base_ / "meshes" / "chapter.partition.vtu") << "whole";
  AtomicFile file(folder() + "/new.vtu");
  std::ofstream(file.temporary()) << "whole";
  remove_unfinished(folder());
  EXPECT_FALSE(fs::exists(base_ / "meshes" / "old.part999999999.vtu"));
  EXPECT_TRUE(fs::exists(base_ / "meshes" / "chapter.partition.vtu"));
  EXPECT_TRUE(fs::exists(file.temporary()));
}

TEST_F(SafePath, AFileAppearsWhenItIsCompleteAndNotBefore) {
  const std::string path = folder() + "/here.vtu";
  const auto content = [&] {
    std::string text;
    std::ifstream(path) >> text;
    return text;
  };
  {
    AtomicFile file(path);
    std::ofstream(file.temporary()) << "half";
  }
  EXPECT_EQ(content(), "here");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder()), fs::directory_iterator()), 2);
  AtomicFile file(path);
  std::ofstream(file.temporary()) << "whole";
  EXPECT_EQ(content(), "here");
  file.commit();
  EXPECT_EQ(content(), "whole");
}

}  // namespace
