#include "tissue/simulate/scene_file.h"

#include "anchor_reader.h"
#include "effect_kind.h"
#include "material_reader.h"

namespace tissue {
namespace {

std::map<std::string, Probe> probes_from(const YamlReader& reader) {
  std::map<std::string, Probe> probes;
  for (const YamlReader& probe : reader.members()) {
    if (probe.is_list()) {
      probes[probe.key()] = vector_from(probe, "a place [x, y, z]");
    } else {
      probe.require_keys({"density_above"});
      probes[probe.key()] = DensityProbe{probe.at("density_above").number(0.0, kHugeParameter)};
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

void read_shape(const YamlReader& shape, ToolDescription& tool) {
  shape.require_keys({"sphere", "pad", "capsule"});
  if (shape.members().size() != 1) shape.refuse("is not one shape");
  if (shape.has("sphere")) {
    tool.radius = shape.at("sphere").number(0.0, 1.0, true);
  } else if (shape.has("pad")) {
    const YamlReader pad = shape.at("pad");
    pad.require_keys({"radius", "stiffness"});
    tool.shape = ToolShape::kPad;
    tool.radius = pad.at("radius").number(0.0, 1.0, true);
    if (pad.has("stiffness")) {
      tool.pad_stiffness = pad.at("stiffness").number(0.0, kHugeParameter, true);
    }
  } else {
    const YamlReader capsule = shape.at("capsule");
    capsule.require_keys({"radius", "length"});
    tool.shape = ToolShape::kCapsule;
    tool.radius = capsule.at("radius").number(0.0, 1.0, true);
    tool.length = capsule.at("length").number(0.0, 10.0, true);
  }
}

ToolInput input_from(const YamlReader& reader) {
  reader.require_keys({"pose", "jaw", "button", "closed_below", "state", "scale", "frame"});
  ToolInput input;
  const auto read_word = [&](const char* key, std::string& word) {
    if (reader.has(key)) word = reader.at(key).word();
  };
  read_word("pose", input.pose);
  read_word("jaw", input.jaw);
  read_word("button", input.button);
  read_word("state", input.state);
  read_word("frame", input.frame);
  if (!input.jaw.empty() && !input.button.empty()) {
    reader.refuse("names a jaw and a button; one of them closes the tool");
  }
  if (reader.has("closed_below")) {
    input.closed_below = reader.at("closed_below").number(-10.0, 10.0);
  }
  if (reader.has("scale")) input.scale = reader.at("scale").number(0.0, 1e6, true);
  return input;
}

ToolDescription tool_from(const YamlReader& entry) {
  entry.require_keys({"name", "shape", "mode", "input"});
  ToolDescription tool;
  tool.name = entry.at("name").word();
  if (entry.has("shape")) read_shape(entry.at("shape"), tool);
  if (entry.has("mode")) {
    const std::string mode = entry.at("mode").word();
    if (mode != "press" && mode != "grasp") {
      entry.at("mode").refuse("'" + mode + "' is not press or grasp");
    }
    tool.grasps = mode == "grasp";
  }
  if (entry.has("input")) tool.input = input_from(entry.at("input"));
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
    const ToolDescription& tool = tools.back();
    if (tool.shape == ToolShape::kPad && !tool.grasps) {
      entry.refuse("of mode press is a sphere or a capsule, not a pad");
    }
    if (tool.shape == ToolShape::kCapsule && tool.grasps) {
      entry.refuse("of mode grasp is a sphere or a pad, not a capsule");
    }
    if (tool.shape != ToolShape::kSphere && model == Model::kClosedForm) {
      entry.refuse("of model closed_form is a sphere");
    }
  }
  if (model == Model::kClosedForm && tools.size() != 1) {
    reader.refuse("model closed_form moves under one tool, not " + std::to_string(tools.size()));
  }
  return tools;
}

// An effect is a word, or a map from the word to its parameters.
Effect effect_from(const YamlReader& entry, Model model) {
  const bool bare = entry.is_word();
  if (!bare && (!entry.is_map() || entry.members().size() != 1)) {
    entry.refuse("is not an effect");
  }
  const std::string name_of = bare ? entry.word() : entry.members()[0].key();
  const EffectKind* const kind = effect_named(name_of);
  if (kind == nullptr || !kind->suits(model)) {
    std::string list;
    for (const std::string& one : effect_names()) {
      if (can_have(model, one)) list += " " + one;
    }
    entry.refuse("'" + name_of + "' is not an effect of model " + name(model) + ", which knows" +
                 list);
  }
  if (bare) return {*kind, kind->read(nullptr, model)};
  const YamlReader parameters = entry.members()[0];
  return {*kind, kind->read(&parameters, model)};
}

void read_effects(const YamlReader& reader, SceneDescription& scene) {
  for (const YamlReader& entry : reader.entries()) {
    const Effect effect = effect_from(entry, scene.model);
    if (scene.has(effect.name())) entry.refuse(std::string("names ") + effect.name() + " twice");
    scene.effects.push_back(effect);
  }
  for (const Effect& effect : scene.effects) {
    const std::string objection = objection_to(effect, scene);
    if (!objection.empty()) reader.refuse("names " + objection);
  }
}

void require_contact(const YamlReader& tools, const SceneDescription& scene) {
  if (scene.model == Model::kClosedForm || scene.has("contact")) return;
  for (std::size_t i = 0; i < scene.tools.size(); ++i) {
    if (scene.tools[i].grasps) continue;
    tools.entries()[i].refuse(std::string("a tool that presses needs the effect contact; "
                                          "without it, model ") +
                              name(scene.model) + " moves under tools of mode grasp");
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
  if (file.has("effects")) read_effects(file.at("effects"), scene);
  if (file.has("tools")) require_contact(file.at("tools"), scene);
  if (file.has("material")) {
    scene.material = material_from(file.at("material"), scene.has<DensityResponseOptions>());
  }
  return scene;
}

}  // namespace

SceneDescription parse_scene(const std::string& yaml) {
  return scene_from(YamlReader(yaml, {"scene", ErrorCode::kScene}));
}

std::string scene_text(const std::string& path) { return text_of_file(path, "scene"); }

SceneDescription read_scene(const std::string& path) {
  return parse_scene(scene_text(path));
}

}  // namespace tissue
