#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

namespace {

namespace fs = std::filesystem;

// A stage may include only stages to its left; `simulate` needs `base` alone.
const std::map<std::string, std::set<std::string>> kMayInclude = {
    {"base", {"base"}},
    {"field", {"base", "field"}},
    {"lattice", {"base", "field", "lattice"}},
    {"refine", {"base", "field", "lattice", "refine"}},
    {"simulate", {"base", "simulate"}},
    {"study", {"base", "field", "lattice", "refine", "simulate", "study"}},
};

std::vector<std::string> includes_of(const fs::path& file) {
  std::vector<std::string> found;
  std::ifstream stream(file);
  const std::regex pattern("^\\s*#\\s*include\\s*[<\"]([^>\"]+)[>\"]");
  std::smatch match;
  for (std::string line; std::getline(stream, line);) {
    if (std::regex_search(line, match, pattern)) found.push_back(match[1]);
  }
  return found;
}

bool is_ros(const std::string& include) {
  static const std::regex pattern(
      "^(ros|rosbag|tf2_ros|tf2|tf2_eigen|nodelet|pluginlib|actionlib|diagnostic_updater|"
      "[a-z0-9_]+_msgs|soft_tissue_sim|tissue_ros)/.*");
  return std::regex_match(include, pattern);
}

TEST(Layering, StagesIncludeOnlyWhatLiesToTheirLeftAndNeverRos) {
  std::size_t files = 0;
  for (const std::string root : {"/include/tissue", "/src/tissue"}) {
    for (const auto& [stage, allowed] : kMayInclude) {
      const fs::path folder = std::string(TISSUE_SOURCE_DIR) + root + "/" + stage;
      if (!fs::exists(folder)) continue;
      for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;
        ++files;
        for (const std::string& include : includes_of(entry.path())) {
          EXPECT_FALSE(is_ros(include)) << entry.path() << " includes " << include;
          if (include.rfind("tissue/", 0) != 0) continue;
          const std::string other = include.substr(7, include.find('/', 7) - 7);
          EXPECT_EQ(allowed.count(other), 1u) << entry.path() << " includes " << include;
        }
      }
    }
  }
  EXPECT_GT(files, 40u);
}

TEST(Layering, OnlyTheRosFolderIncludesRos) {
  for (const std::string root : {"/src/tools", "/test/base", "/test/field", "/test/lattice",
                                 "/test/refine", "/test/simulate", "/test/study", "/test/support"}) {
    for (const auto& entry :
         fs::recursive_directory_iterator(std::string(TISSUE_SOURCE_DIR) + root)) {
      for (const std::string& include : includes_of(entry.path())) {
        EXPECT_FALSE(is_ros(include)) << entry.path() << " includes " << include;
      }
    }
  }
}

}  // namespace
