// What fuzzing has found, and what it began with, again.
#include "fuzz/targets.h"
#include "tissue/base/error.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace {

namespace fs = std::filesystem;

TEST(Fuzz, EveryFileOfTheCorpusIsTakenOrRefusedByASentence) {
  const fs::path corpus = std::string(TISSUE_SOURCE_DIR) + "/test/fuzz/corpus";
  for (const auto& [name, target] : tissue_fuzz::targets()) {
    std::size_t files = 0, refused = 0;
    for (const auto& entry : fs::directory_iterator(corpus / name)) {
      std::ifstream file(entry.path(), std::ios::binary);
      const std::string bytes((std::istreambuf_iterator<char>(file)), {});
      SCOPED_TRACE(entry.path().string());
      ++files;
      try {
        target(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
      } catch (const tissue::InputError& error) {
        ++refused;
        EXPECT_FALSE(std::string(error.what()).empty());
      }
    }
    EXPECT_GT(files, 1u) << name;
    EXPECT_LT(refused, files) << name << ": none of it is sound";
  }
}

}  // namespace
