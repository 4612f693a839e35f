#include "tissue/simulate/scene_file.h"

#include "yaml_reader.h"

#include <fstream>
#include <set>
#include <sstream>

namespace tissue {
namespace {

constexpr double kHuge = 1e12;

void check_material(const YamlReader& material, bool density_response) {
  material.require_keys({"young", "poisson", "mass_density"});
  if (material.has("young")) {
    double previous = -1.0;
    for (const YamlReader& row : material.at("young").entries()) {
      const std::vector<YamlReader> pair = row.entries();
      if (pair.size() != 2) row.refuse(ErrorCode::kScene, "is not a pair [density, Pa]");
      const double density = pair[0].number(0.0, kHuge);
      if (!(density > previous)) pair[0].refuse(ErrorCode::kParam, "densities do not rise");
      previous = density;
      pair[1].number(0.0, kHuge, true);
    }
    if (previous < 0.0) material.at("young").refuse(ErrorCode::kScene, "has no rows");
    if (!density_response && material.at("young").entries().size() > 1) {
      material.at("young").refuse(ErrorCode::kScene,
                                  "has several rows, which needs the effect density_response");
    }
  }
  if (material.has("poisson")) material.at("poisson").number(-1.0, 0.5, true);
  if (material.has("mass_density")) material.at("mass_density").number(0.0, kHuge, true);
}

void check_anchors(const YamlReader& anchors) {
  for (const YamlReader& anchor : anchors.entries()) {
    anchor.require_keys({"plane", "box", "sphere", "label", "vertices"});
    if (anchor.members().size() != 1) anchor.refuse(ErrorCode::kScene, "is not one anchor");
  }
}

void check_probes(const YamlReader& probes) {
  for (const YamlReader& probe : probes.members()) {
    if (probe.is_list()) {
      const std::vector<YamlReader> place = probe.entries();
      if (place.size() != 3) probe.refuse(ErrorCode::kScene, "is not a place [x, y, z]");
      for (const YamlReader& coordinate : place) coordinate.number(-kHuge, kHuge);
    } else {
      probe.require_keys({"density_above"});
      probe.at("density_above").number(0.0, kHuge);
    }
  }
}

void check_solver(const YamlReader& solver) {
  solver.require_keys({"tolerance", "max_iterations"});
  if (solver.has("tolerance")) solver.at("tolerance").number(0.0, 1.0, true);
  if (solver.has("max_iterations")) solver.at("max_iterations").number(1.0, 1e9);
}

ToolDescription tool_from(const YamlReader& tools) {
  const std::vector<YamlReader> entries = tools.entries();
  if (entries.size() != 1) {
    tools.refuse(ErrorCode::kScene,
                 "model closed_form moves under one tool, not " + std::to_string(entries.size()));
  }
  const YamlReader& entry = entries[0];
  entry.require_keys({"name", "shape", "mode"});
  ToolDescription tool;
  tool.name = entry.at("name").word();
  if (entry.has("shape")) {
    entry.at("shape").require_keys({"sphere"});
    tool.radius = entry.at("shape").at("sphere").number(0.0, 1.0, true);
  }
  if (entry.has("mode")) {
    const std::string mode = entry.at("mode").word();
    if (mode != "press" && mode != "grasp") {
      entry.at("mode").refuse(ErrorCode::kScene, "'" + mode + "' is not press or grasp");
    }
    tool.grasps = mode == "grasp";
  }
  return tool;
}

// An effect is a word, or a map from the word to its parameters.
void add_effect(const YamlReader& entry, SceneDescription& scene, std::set<std::string>& seen) {
  const bool bare = entry.is_word();
  if (!bare && (!entry.is_map() || entry.members().size() != 1)) {
    entry.refuse(ErrorCode::kScene, "is not an effect");
  }
  const std::string effect = bare ? entry.word() : entry.members()[0].key();
  if (!seen.insert(effect).second) entry.refuse(ErrorCode::kScene, "names " + effect + " twice");
  const auto parameter = [&](const char* key, double fallback, double highest) {
    if (bare) return fallback;
    const YamlReader parameters = entry.members()[0];
    parameters.require_keys({key});
    return parameters.has(key) ? parameters.at(key).number(0.0, highest, true) : fallback;
  };
  if (effect == "density_response") {
    scene.push.density_response = true;
    scene.push.reference_density = parameter("reference", 0.0, kHuge);
  } else if (effect == "recovery") {
    scene.recovery_time = parameter("time", 0.2, 3600.0);
  } else if (effect == "fold_guard") {
    if (!bare) entry.members()[0].require_keys({});
    scene.fold_guard = true;
  } else {
    entry.refuse(ErrorCode::kScene, "'" + effect + "' is not an effect of model " + scene.model +
                                        ", which knows density_response recovery fold_guard");
  }
}

SceneDescription scene_from(const YamlReader& file) {
  file.require_keys({"name", "model", "element_order", "range", "literal", "rise_time", "material",
                     "anchors", "tools", "probes", "effects", "solver"});
  SceneDescription scene;
  if (file.has("name")) scene.name = file.at("name").word();
  scene.model = file.at("model").word();
  if (scene.model != "closed_form") {
    file.at("model").refuse(ErrorCode::kScene,
                            "'" + scene.model + "' is not a model; closed_form is");
  }
  if (file.has("element_order")) {
    const double order = file.at("element_order").number(1.0, 2.0);
    if (order != 1.0 && order != 2.0) {
      file.at("element_order").refuse(ErrorCode::kParam, "is neither 1 nor 2");
    }
  }
  if (file.has("range")) scene.push.range = file.at("range").number(0.0, 10.0, true);
  if (file.has("literal")) scene.push.literal = file.at("literal").flag();
  if (file.has("rise_time")) scene.rise_time = file.at("rise_time").number(0.0, 3600.0);
  if (file.has("anchors")) check_anchors(file.at("anchors"));
  if (file.has("tools")) scene.tool = tool_from(file.at("tools"));
  if (file.has("probes")) check_probes(file.at("probes"));
  if (file.has("solver")) check_solver(file.at("solver"));
  if (file.has("effects")) {
    std::set<std::string> seen;
    for (const YamlReader& effect : file.at("effects").entries()) add_effect(effect, scene, seen);
  }
  if (file.has("material")) check_material(file.at("material"), scene.push.density_response);
  return scene;
}

}  // namespace

SceneDescription parse_scene(const std::string& yaml) {
  try {
    return scene_from(YamlReader(YAML::Load(yaml), "scene"));
  } catch (const YAML::Exception& exception) {
    throw InputError(ErrorCode::kScene, std::string("scene: not YAML: ") + exception.what());
  }
}

SceneDescription read_scene(const std::string& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  if (!file) throw InputError(ErrorCode::kFile, "scene: '" + path + "' cannot be read");
  return parse_scene(text.str());
}

}  // namespace tissue
