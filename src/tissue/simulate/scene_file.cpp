#include "tissue/simulate/scene_file.h"

#include "anchor_reader.h"
#include "material_reader.h"

#include <algorithm>
#include <set>

namespace tissue {
namespace {

constexpr double kHuge = 1e12;

Vec3 place_from(const YamlReader& reader, const char* what) {
  const std::vector<YamlReader> entries = reader.entries();
  if (entries.size() != 3) reader.refuse(std::string("is not ") + what);
  Vec3 place;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    place[static_cast<Eigen::Index>(axis)] = entries[axis].number(-kHuge, kHuge);
  }
  return place;
}

std::map<std::string, Probe> probes_from(const YamlReader& reader) {
  std::map<std::string, Probe> probes;
  for (const YamlReader& probe : reader.members()) {
    if (probe.is_list()) {
      probes[probe.key()] = place_from(probe, "a place [x, y, z]");
    } else {
      probe.require_keys({"density_above"});
      probes[probe.key()] = DensityProbe{probe.at("density_above").number(0.0, kHuge)};
    }
  }
  return probes;
}

EquilibriumOptions solver_from(const YamlReader& reader) {
  reader.require_keys({"tolerance", "max_iterations"});
  EquilibriumOptions options;
  if (reader.has("tolerance")) options.tolerance = reader.at("tolerance").number(0.0, 1.0, true);
  if (reader.has("max_iterations")) {
    options.max_iterations = static_cast<int>(reader.at("max_iterations").number(1.0, 1e9));
  }
  return options;
}

ToolDescription tool_from(const YamlReader& entry) {
  entry.require_keys({"name", "shape", "mode"});
  ToolDescription tool;
  tool.name = entry.at("name").word();
  if (entry.has("shape")) {
    const YamlReader shape = entry.at("shape");
    shape.require_keys({"sphere", "pad"});
    if (shape.members().size() != 1) shape.refuse("is not one shape");
    if (shape.has("sphere")) {
      tool.radius = shape.at("sphere").number(0.0, 1.0, true);
    } else {
      const YamlReader pad = shape.at("pad");
      pad.require_keys({"radius", "stiffness"});
      tool.shape = ToolShape::kPad;
      tool.radius = pad.at("radius").number(0.0, 1.0, true);
      if (pad.has("stiffness")) tool.pad_stiffness = pad.at("stiffness").number(0.0, kHuge, true);
    }
  }
  if (entry.has("mode")) {
    const std::string mode = entry.at("mode").word();
    if (mode != "press" && mode != "grasp") {
      entry.at("mode").refuse("'" + mode + "' is not press or grasp");
    }
    tool.grasps = mode == "grasp";
  }
  return tool;
}

std::vector<ToolDescription> tools_from(const YamlReader& reader, Model model) {
  std::vector<ToolDescription> tools;
  for (const YamlReader& entry : reader.entries()) {
    tools.push_back(tool_from(entry));
    for (std::size_t i = 0; i + 1 < tools.size(); ++i) {
      if (tools[i].name == tools.back().name) {
        entry.refuse("is a second tool '" + tools[i].name + "'");
      }
    }
    if (model != Model::kClosedForm && !tools.back().grasps) {
      entry.refuse(std::string("a tool that presses needs the effect contact; "
                               "without it, model ") +
                   name(model) + " moves under tools of mode grasp");
    }
  }
  if (model == Model::kClosedForm && tools.size() != 1) {
    reader.refuse("model closed_form moves under one tool, not " + std::to_string(tools.size()));
  }
  return tools;
}

InertiaOptions inertia_from(const YamlReader& reader) {
  reader.require_keys({"substep", "iterations"});
  InertiaOptions options;
  if (reader.has("substep")) options.substep = reader.at("substep").number(0.0, 3600.0, true);
  if (reader.has("iterations")) {
    options.iterations = static_cast<int>(reader.at("iterations").number(1.0, 1e6));
  }
  return options;
}

DampingOptions damping_from(const YamlReader& reader) {
  reader.require_keys({"mass", "stiffness"});
  DampingOptions options;
  if (reader.has("mass")) options.mass = reader.at("mass").number(0.0, kHuge);
  if (reader.has("stiffness")) options.stiffness = reader.at("stiffness").number(0.0, kHuge);
  return options;
}

// An effect is a word, or a map from the word to its parameters.
void add_effect(const YamlReader& entry, SceneDescription& scene, std::set<std::string>& seen) {
  const bool bare = entry.is_word();
  if (!bare && (!entry.is_map() || entry.members().size() != 1)) {
    entry.refuse("is not an effect");
  }
  const std::string effect = bare ? entry.word() : entry.members()[0].key();
  if (!seen.insert(effect).second) entry.refuse("names " + effect + " twice");
  const auto known = std::find_if(all_effects().begin(), all_effects().end(),
                                  [&](Effect one) { return effect == name(one); });
  if (known == all_effects().end() || !can_have(scene.model, *known)) {
    std::string list;
    for (const Effect one : all_effects()) {
      if (can_have(scene.model, one)) list += std::string(" ") + name(one);
    }
    entry.refuse("'" + effect + "' is not an effect of model " + name(scene.model) +
                 ", which knows" + list);
  }
  scene.effects.push_back(*known);
  const auto parameters = [&](std::initializer_list<const char*> keys) {
    if (!bare) entry.members()[0].require_keys(keys);
  };
  const auto parameter = [&](const char* key, double fallback, double highest) {
    parameters({key});
    if (bare || !entry.members()[0].has(key)) return fallback;
    return entry.members()[0].at(key).number(0.0, highest, true);
  };
  switch (*known) {
    case Effect::kDensityResponse:
      scene.push.density_response = true;
      if (scene.model == Model::kClosedForm) {
        scene.push.reference_density = parameter("reference", 0.0, kHuge);
      } else {
        parameters({});
      }
      break;
    case Effect::kRecovery: scene.recovery_time = parameter("time", 0.2, 3600.0); break;
    case Effect::kFoldGuard:
      parameters({});
      scene.fold_guard = true;
      break;
    case Effect::kForceFeedback: parameters({}); break;
    case Effect::kGravity:
      parameters({"vector"});
      if (!bare && entry.members()[0].has("vector")) {
        scene.gravity = place_from(entry.members()[0].at("vector"), "a vector [x, y, z]");
      }
      break;
    case Effect::kInertia:
      if (!bare) scene.inertia = inertia_from(entry.members()[0]);
      break;
    case Effect::kDamping:
      if (!bare) scene.damping = damping_from(entry.members()[0]);
  }
}

Model model_from(const YamlReader& reader) {
  std::string list;
  for (const Model model : all_models()) {
    if (reader.word() == name(model)) return model;
    list += std::string(list.empty() ? "" : " ") + name(model);
  }
  reader.refuse("'" + reader.word() + "' is not a model; these are: " + list);
}

SceneDescription scene_from(const YamlReader& file) {
  file.require_keys({"name", "model", "element_order", "range", "literal", "rise_time", "material",
                     "anchors", "tools", "probes", "effects", "solver", "duration", "dt"});
  SceneDescription scene;
  if (file.has("name")) scene.name = file.at("name").word();
  scene.model = model_from(file.at("model"));
  if (file.has("element_order")) {
    const double order = file.at("element_order").number(1.0, 2.0);
    if (order != 1.0 && order != 2.0) {
      file.at("element_order").refuse(ErrorCode::kParam, "is neither 1 nor 2");
    }
    if (order != 1.0 && scene.model == Model::kMassSpring) {
      file.at("element_order").refuse("of 2 needs tissue as a solid, not springs");
    }
    scene.element_order = static_cast<int>(order);
  }
  if (file.has("range")) scene.push.range = file.at("range").number(0.0, 10.0, true);
  if (file.has("literal")) scene.push.literal = file.at("literal").flag();
  if (file.has("rise_time")) scene.rise_time = file.at("rise_time").number(0.0, 3600.0);
  if (file.has("anchors")) scene.anchors = anchors_from(file.at("anchors"));
  if (scene.model != Model::kClosedForm) scene.tools.clear();
  if (file.has("tools")) scene.tools = tools_from(file.at("tools"), scene.model);
  if (file.has("probes")) scene.probes = probes_from(file.at("probes"));
  if (file.has("duration")) scene.duration = file.at("duration").number(0.0, 1e6, true);
  if (file.has("dt")) scene.dt = file.at("dt").number(0.0, 3600.0, true);
  if (file.has("solver")) scene.solver = solver_from(file.at("solver"));
  if (file.has("effects")) {
    std::set<std::string> seen;
    for (const YamlReader& effect : file.at("effects").entries()) add_effect(effect, scene, seen);
    if (scene.has(Effect::kDamping) && !scene.has(Effect::kInertia)) {
      file.at("effects").refuse("names damping without inertia: nothing swings that it could damp");
    }
  }
  if (file.has("material")) {
    scene.material = material_from(file.at("material"), scene.has(Effect::kDensityResponse));
  }
  return scene;
}

}  // namespace

SceneDescription parse_scene(const std::string& yaml) {
  return scene_from(YamlReader(yaml, {"scene", ErrorCode::kScene}));
}

SceneDescription read_scene(const std::string& path) {
  return parse_scene(text_of_file(path, "scene"));
}

}  // namespace tissue
