#include "tissue/simulate/scene_file.h"

#include "support/mesh_checks.h"

#include <filesystem>

namespace {

using namespace tissue;

constexpr const char* kWhole = R"(name: press
model: closed_form
element_order: 1
range: 0.025
rise_time: 0.1
material: {young: [[0, 1e3], [60, 3e3], [255, 60e3]], poisson: 0.45, mass_density: 1000}
anchors: [{plane: {axis: z, below: 0.02}}]
tools: [{name: stylus, shape: {sphere: 0.004}, mode: press}]
probes: {tumour: {density_above: 200}, target: [0.01, 0.02, 0.03]}
effects:
  - density_response: {reference: 80}
  - recovery: {time: 0.5}
  - fold_guard
solver: {tolerance: 1e-3, max_iterations: 200}
)";

TEST(SceneFile, ReadsEveryKey) {
  const SceneDescription scene = parse_scene(kWhole);
  EXPECT_EQ(scene.name, "press");
  EXPECT_EQ(scene.push.range, 0.025);
  EXPECT_EQ(scene.rise_time, 0.1);
  EXPECT_EQ(scene.tools[0].name, "stylus");
  EXPECT_EQ(scene.tools[0].radius, 0.004);
  EXPECT_FALSE(scene.tools[0].grasps);
  ASSERT_TRUE(scene.has<DensityResponseOptions>());
  EXPECT_EQ(scene.find<DensityResponseOptions>()->reference, 80.0);
  EXPECT_EQ(scene.find<RecoveryOptions>()->time, 0.5);
  EXPECT_TRUE(scene.has<FoldGuardOptions>());
  EXPECT_EQ(scene.tools[0].pose_topic(), "stylus/measured_cp");
  EXPECT_FALSE(scene.tools[0].input.has_grip());
}

TEST(SceneFile, ReadsHowADeviceSpeaks) {
  const auto parse = [](const std::string& input) {
    return parse_scene("model: linear\ntools: [{name: arm, mode: grasp, input: {" + input +
                       "}}]\n");
  };
  const ToolDescription tool =
      parse("pose: Geomagic/pose, button: b, scale: 0.001, frame: patient, state: s").tools[0];
  EXPECT_EQ(tool.pose_topic(), "Geomagic/pose");
  EXPECT_EQ(tool.input.scale, 0.001);
  EXPECT_EQ(tool.input.frame, "patient");
  EXPECT_EQ(tool.input.state, "s");
  EXPECT_TRUE(tool.input.has_grip());
  EXPECT_EQ(parse("jaw: j, closed_below: 0.2").tools[0].input.closed_below, 0.2);
  EXPECT_EQ(tissue_test::refusal([&] { parse("jaw: j, button: b"); }),
            "E_SCENE: scene: line 2, input: names a jaw and a button; one of them closes the tool");
  EXPECT_EQ(tissue_test::refusal([&] { parse("scale: 0"); }),
            "E_PARAM: scene: line 2, scale: 0 is not between 0 and 1e+06");
}

TEST(SceneFile, LeavesOutWhatIsNotNamed) {
  const SceneDescription scene = parse_scene("model: closed_form");
  EXPECT_TRUE(scene.effects.empty());
}

// A scene with one line put into it, and what is said about it.
struct Refused {
  std::string line, sentence;
};

TEST(SceneFile, SaysLineAndKeyOfWhatItRefuses) {
  const std::vector<Refused> cases = {
      {"colour: red", "E_SCENE: scene: line 2, colour: is not a key of scene"},
      {"model2: x", "E_SCENE: scene: line 2, model2"},
      {"range: 0", "E_PARAM: scene: line 2, range: 0 is not between 0 and 10"},
      {"range: .nan", "E_PARAM: scene: line 2, range: .nan is not"},
      {"range: wide", "E_PARAM: scene: line 2, range: 'wide' is not a number"},
      {"effects: [gravity]",
       "E_SCENE: scene: line 2, effects[0]: 'gravity' is not an effect of model"},
      {"effects: [recovery, recovery]", "E_SCENE: scene: line 2, effects[1]: names recovery twice"},
      {"effects: [{recovery: {speed: 1}}]",
       "E_SCENE: scene: line 2, speed: is not a key of recovery"},
      {"tools: [{name: a}, {name: b}]",
       "E_SCENE: scene: line 2, tools: model closed_form moves under"},
      {"tools: [{name: a, mode: cut}]",
       "E_SCENE: scene: line 2, mode: 'cut' is not press or grasp"},
      {"anchors: [{wall: 1}]", "E_SCENE: scene: line 2, wall: is not a key of anchors[0]"},
      {"probes: {p: [1, 2]}", "E_SCENE: scene: line 2, p: is not a place"},
      {"solver: {tolerance: 2}", "E_PARAM: scene: line 2, tolerance: 2 is not between 0 and 1"},
      {"material: {young: [[0, 1e3], [9, 2e3]]}",
       "E_SCENE: scene: line 2, young: has several rows"},
  };
  for (const Refused& refused : cases) {
    const std::string text =
        tissue_test::refusal([&] { parse_scene("model: closed_form\n" + refused.line); });
    EXPECT_EQ(text.substr(0, refused.sentence.size()), refused.sentence) << text;
  }
  EXPECT_EQ(
      tissue_test::refusal([] { parse_scene("model: jelly"); }),
      "E_SCENE: scene: line 1, model: 'jelly' is not a model; these are: closed_form mass_spring "
      "linear corotational neo_hookean");
  EXPECT_EQ(tissue_test::refusal([] { parse_scene("{"); }).substr(0, 7), "E_SCENE");
  EXPECT_EQ(tissue_test::refusal([] { parse_scene("- a list"); }).substr(0, 7), "E_SCENE");
  EXPECT_EQ(tissue_test::refusal([] { read_scene("/nowhere.yaml"); }).substr(0, 6), "E_FILE");
}

TEST(SceneFile, M4_RefusesMaterialsThatCannotBe) {
  for (const std::string bad :
       {"poisson: 0.5", "poisson: -1", "poisson: .nan", "poisson: .inf", "young: [[0, 0]]",
        "young: [[0, -5]]", "young: [[0, .nan]]", "young: [[9, 1], [3, 1]]", "mass_density: 0"}) {
    const std::string key = bad.substr(0, bad.find(':'));
    const std::string text =
        tissue_test::refusal([&] { parse_scene("model: closed_form\nmaterial: {" + bad + "}"); });
    EXPECT_EQ(text.substr(0, 7), "E_PARAM") << bad << ": " << text;
    EXPECT_NE(text.find(key), std::string::npos) << text;
  }
}

TEST(SceneFile, EveryShippedSceneIsSound) {
  std::size_t scenes = 0;
  const std::string folder = std::string(TISSUE_SOURCE_DIR) + "/config/scenes";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    EXPECT_EQ(tissue_test::refusal([&] { read_scene(entry.path().string()); }), "");
    ++scenes;
  }
  EXPECT_GT(scenes, 0u);
}

}  // namespace
