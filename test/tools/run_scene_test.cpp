#include "support/program.h"
#include "tissue/base/types.h"

#include <gtest/gtest.h>

namespace {

using tissue_test::Outcome;
using tissue_test::read_json;
using tissue_test::run_program;
using tissue_test::temporary;

const std::string kRoot = TISSUE_SOURCE_DIR;

Outcome run_scene(const std::string& arguments) { return run_program(RUN_SCENE, arguments); }

// The shipped brain with the tumour that the shipped paths are made for.
const std::string& brain() {
  static const std::string path = [] {
    const std::string vtu = temporary("tissue_run_scene_brain.vtu");
    const Outcome outcome = tissue_test::run_program(
        MESH_VOLUME, kRoot +
                         "/data/ch2bet.nii.gz --iso 20 --spacing 0.024 --sections 2"
                         " --tumour 0.002,-0.020,0.045,0.012,255 -o " +
                         vtu);
    EXPECT_EQ(outcome.code, 0) << outcome.output;
    return vtu;
  }();
  return path;
}

nlohmann::json figures_of(const std::string& scene, const std::string& path) {
  const std::string json = temporary("tissue_run_scene.json"),
                    vtu = temporary("tissue_run_scene.vtu");
  const std::string poses = path.empty() ? "" : " --path " + kRoot + "/config/paths/" + path;
  const Outcome outcome = run_scene(kRoot + "/config/scenes/" + scene + " --mesh " + brain() +
                                    poses + " -o " + vtu + " --stats " + json);
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  return read_json(json);
}

TEST(RunScene, EveryShippedSceneOfASolidKeepsTheShippedBrainWhole) {
  const std::pair<const char*, const char*> runs[] = {{"sag.yaml", ""},
                                                      {"grasp_press.yaml", "grasp_press.csv"},
                                                      {"palpate.yaml", "palpate_tumour.csv"},
                                                      {"palpate.yaml", "palpate_beside.csv"},
                                                      {"pull.yaml", "pull.csv"},
                                                      {"tilt.yaml", ""}};
  for (const auto& [scene, path] : runs) {
    const nlohmann::json stats = figures_of(scene, path);
    EXPECT_EQ(stats["inverted"], 0) << scene;
    EXPECT_GT(stats["min_det_f"], 0.0) << scene;
    EXPECT_EQ(stats["flags"], nlohmann::json::array()) << scene;
    if (std::string(path).empty()) continue;
    // What the tools pull, the anchors hold.
    tissue::Vec3 sum = tissue::Vec3::Zero(), anchors = tissue::Vec3::Zero();
    for (const auto& [name, force] : stats["reaction_n"].items()) {
      const tissue::Vec3 newtons(force[0], force[1], force[2]);
      sum += newtons;
      if (name == "anchors[0]") anchors = newtons;
    }
    EXPECT_GT(anchors.norm(), 1e-3) << scene;
    EXPECT_LE(sum.norm(), 2e-3 * anchors.norm()) << scene;
  }
}

TEST(RunScene, WhatToolsFeelIsAmongTheFiguresOfScenesThatNameIt) {
  std::string text;
  std::getline(std::ifstream(kRoot + "/config/scenes/palpate.yaml"), text, '\0');
  const std::string effects = "[density_response";
  text.replace(text.find(effects), effects.size(), effects + ", force_feedback");
  const std::string scene = temporary("tissue_felt.yaml"), json = temporary("tissue_felt.json");
  std::ofstream(scene) << text;
  const Outcome outcome = run_scene(scene + " --mesh " + brain() + " --path " + kRoot +
                                    "/config/paths/palpate_tumour.csv -o " +
                                    temporary("tissue_felt.vtu") + " --stats " + json);
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  const nlohmann::json stats = read_json(json), felt = stats["feedback"]["tool"];
  // Summed up in another order.
  EXPECT_NEAR(felt["force_n"][2], stats["reaction_n"]["tool"][2], 1e-12);
  EXPECT_GT(felt["compliance_m_per_n"][2][2], 1e-3);
  EXPECT_EQ(stats["effects"][1]["name"], "force_feedback");
  EXPECT_GT(stats["effects"][1]["seconds"], 0.0);
  EXPECT_EQ(figures_of("palpate.yaml", "palpate_tumour.csv")["feedback"], nlohmann::json::object());
}

TEST(RunScene, TheResultHasTheInputsPointsAndWhatTheyDid) {
  const std::string vtu = temporary("tissue_run_scene_fields.vtu");
  const Outcome outcome =
      run_scene(kRoot + "/config/scenes/sag.yaml --mesh " + brain() + " -o " + vtu);
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  std::ifstream file(vtu, std::ios::binary);
  std::string head(4096, '\0');
  file.read(head.data(), 4096);
  for (const char* name : {"displacement", "von_mises_stress", "largest_strain", "density"}) {
    EXPECT_NE(head.find(std::string("Name=\"") + name), std::string::npos) << name;
  }
}

TEST(RunScene, SaysInOneSentenceWhatIsWrong) {
  const std::string good = kRoot + "/config/scenes/grasp_press.yaml";
  const std::string poses = temporary("tissue_poses.csv");
  const auto refused = [&](const std::string& arguments) {
    const Outcome outcome = run_scene(arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.output;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
    return outcome.output;
  };
  const auto path_refused = [&](const std::string& line) {
    std::ofstream(poses) << "t,x,y,z,qx,qy,qz,qw\n" << line << "\n";
    return refused(good + " --mesh " + brain() + " -o x.vtu --path " + poses);
  };
  EXPECT_NE(refused("").find("scene: is missing"), std::string::npos);
  EXPECT_NE(refused("/nowhere.yaml --mesh a -o b").find("/nowhere.yaml"), std::string::npos);
  EXPECT_NE(refused(good + " --mesh /nowhere.vtu -o b").find("/nowhere.vtu"), std::string::npos);
  EXPECT_NE(refused(good + " --mesh a -o b --threads 0").find("--threads: 0"), std::string::npos);
  EXPECT_NE(refused(good + " --mesh a -o b --path arm=p.csv").find("no tool 'arm'"),
            std::string::npos);
  EXPECT_NE(refused(good + " --mesh a -o b --path p.csv").find("p.csv"), std::string::npos);
  EXPECT_NE(path_refused("0,0,0,0,0,0,0,0").find("line 2: a quaternion of norm 0"),
            std::string::npos);
  EXPECT_NE(path_refused("0,nan,0,0,0,0,0,1").find("'nan' is not finite"), std::string::npos);
  EXPECT_NE(path_refused("0,0,0,0,0,0,1").find("has 7 numbers"), std::string::npos);
  EXPECT_NE(path_refused("1,0,0,0,0,0,0,1\n0,0,0,0,0,0,0,1").find("line 3: time 0 lies before 1"),
            std::string::npos);
}

}  // namespace
