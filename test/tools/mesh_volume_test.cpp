#include "support/program.h"
#include "support/sanitizers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace {

namespace fs = std::filesystem;

const std::string kBrain = std::string(TISSUE_SOURCE_DIR) + "/data/ch2bet.nii.gz";

using tissue_test::Outcome;
using tissue_test::read_json;
using tissue_test::temporary;

Outcome run(const std::string& arguments) {
  return tissue_test::run_program(MESH_VOLUME, arguments);
}

TEST(MeshVolume, WritesAMeshAndItsFigures) {
  const std::string vtu = temporary("tissue_mesh_volume.vtu"),
                    json = temporary("tissue_mesh_volume.json");
  const Outcome outcome =
      run(kBrain + " --iso 20 --spacing 0.012 --tumour 0,-0.02,0.01,0.012,255 -o " + vtu +
          " --stats " + json);
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  const nlohmann::json stats = read_json(json);
  std::uint64_t wished = 0, initial = 0;
  for (std::size_t level = 0; level < stats["levels"].size(); ++level) {
    initial += stats["levels"][level].get<std::uint64_t>();
    wished += stats["levels"][level].get<std::uint64_t>() << (3 * level);
  }
  EXPECT_EQ(stats["initial"], initial);
  EXPECT_GT(stats["tetrahedra"], wished);
  EXPECT_EQ(stats["thresholds"].size(), 3u);
  EXPECT_EQ(stats["stages"].front()["name"], "read");
  EXPECT_EQ(stats["stages"].back()["name"], "write");
  // Sanitizers bring their own allocator, which is not counted.
  if (!tissue_test::kSanitized) {
    EXPECT_GT(stats["peak_bytes"], 16 * stats["tetrahedra"].get<std::uint64_t>());
  }
  std::ifstream file(vtu);
  std::string head(4096, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  for (const std::string name : {"UnstructuredGrid", "\"density\"", "\"level\"", "\"parents\""}) {
    EXPECT_NE(head.find(name), std::string::npos) << name;
  }
  EXPECT_FALSE(fs::exists(vtu + ".part"));
}

TEST(MeshVolume, WritesWishesAndLevelsOfTheLatticeStage) {
  const std::string vtu = temporary("tissue_mesh_lattice.vtu");
  ASSERT_EQ(run(kBrain + " --spacing 0.02 --stage lattice -o " + vtu).code, 0);
  std::ifstream file(vtu);
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_NE(text.str().find("\"level_wish\""), std::string::npos);
  EXPECT_EQ(text.str().find("\"parents\""), std::string::npos);
}

TEST(MeshVolume, EndsWithCode2AndASentenceOnEveryBadRequest) {
  const std::string out = " -o " + temporary("tissue_never_written.vtu");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"/nowhere.nii.gz" + out, "E_FILE: volume: '/nowhere.nii.gz' cannot be read"},
      {kBrain, "-o: no output file is given"},
      {out, "VOLUME: no file is given"},
      {kBrain + " --spacing 0" + out, "--spacing: 0 m is not positive"},
      {kBrain + " --spacing wide" + out, "--spacing: 'wide' is not a list of 1 numbers"},
      {kBrain + " --initial 0" + out, "E_NTINIT"},
      {kBrain + " --initial -5" + out, "E_NTINIT: --initial: '-5'"},
      {kBrain + " --initial 1000000000" + out, "E_TOO_MANY_TETS"},
      {kBrain + " --sections 0" + out, "E_N: --sections: '0'"},
      {kBrain + " --sections 20" + out, "E_TOO_MANY_TETS: level_sections: 20"},
      {kBrain + " --iso 5000" + out, "E_EMPTY_SURFACE: iso_value: 5000"},
      {kBrain + " --iso nan" + out, "--iso: 'nan'"},
      {kBrain + " --tumour 0,0,0,0.01" + out, "--tumour: '0,0,0,0.01' is not a list of 5 numbers"},
      {kBrain + " --tumour 0,0,0,0.01,999" + out, "tumour: value 999 does not fit"},
      {kBrain + " --window 9,1" + out, "window: 9 to 1"},
      {kBrain + " --stage cooked" + out, "--stage: 'cooked' is not refined or lattice"},
      {kBrain + " --colour red" + out, "colour"},
      {kBrain + " --spacing 0.02 -o /nowhere/at/all.vtu", "E_IO: output: '/nowhere/at/all.vtu'"},
  };
  for (const auto& [arguments, sentence] : cases) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
    EXPECT_NE(outcome.output.find(sentence), std::string::npos) << arguments << "\n"
                                                                << outcome.output;
    EXPECT_FALSE(fs::exists(temporary("tissue_never_written.vtu")));
  }
}

}  // namespace
