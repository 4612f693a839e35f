#pragma once

#include "tissue/simulate/anchors.h"
#include "tissue/simulate/effect.h"
#include "tissue/simulate/equilibrium_options.h"
#include "tissue/simulate/material.h"
#include "tissue/simulate/push_options.h"

#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace tissue {

/// What of a tool meets tissue. One that grasps holds all tissue within its sphere, which then
/// moves as if it were part of the tool, or the surface within that distance, through a soft pad:
/// what a pad does to a body hardly depends on its mesh, what a sphere does depends on which
/// vertices lie in it. One that presses is a sphere or a capsule.
enum class ToolShape { kSphere, kPad, kCapsule };

/// How a tool's device speaks, for whatever brings its messages: topics, and what they mean.
struct ToolInput {
  /// Topic of its poses; empty: `<tool>/measured_cp`.
  std::string pose;
  /// Topics of what opens and closes its jaw, at most one of them: an angle, or a button that is
  /// pressed. A tool without either takes hold at the first touch.
  std::string jaw, button;
  /// The jaw is closed at angles below [rad].
  double closed_below = 0.1;
  /// Topic of a state in which it is not to be listened to; empty: none.
  std::string state;
  /// Positions are multiplied by this: 0.001 for millimetres.
  double scale = 1.0;
  /// In which its poses are, whatever they say; empty: as they say.
  std::string frame;

  bool has_grip() const { return !jaw.empty() || !button.empty(); }
};

/// A tool as a scene names it.
struct ToolDescription {
  std::string name = "tool";
  ToolShape shape = ToolShape::kSphere;
  /// Of the sphere, the pad or the capsule [m].
  double radius = 0.004;
  /// Of a capsule's axis, from the tool's tip, where its pose is, along −z of its frame [m].
  double length = 0.0;
  /// Pressure of a pad, in its middle, for each metre by which it is squeezed or stretched [Pa/m].
  /// More, and the surface follows the tool more closely.
  double pad_stiffness = 1e6;
  /// `grasp` takes hold of the tissue when the jaw closes on it. `press` pushes it, by the effect
  /// `contact`; under closed_form it takes hold at the first touch.
  bool grasps = false;
  ToolInput input = {};

  std::string pose_topic() const { return input.pose.empty() ? name + "/measured_cp" : input.pose; }
};

/// Something to report: the centroid of all tissue denser than a value, or a place in the tissue.
struct DensityProbe {
  double above = 0.0;
};
using Probe = std::variant<DensityProbe, Vec3>;

/// A scene file, checked. The only place where a scene's defaults stand.
struct SceneDescription {
  std::string name = "scene";
  Model model = Model::kClosedForm;
  std::vector<ToolDescription> tools = {ToolDescription{}};
  std::map<std::string, Probe> probes;
  /// One cost is kept for each.
  std::vector<Effect> effects;
  /// The parameters of an effect; nothing if the scene does not name it.
  template <class Options>
  const Options* find() const {
    for (const Effect& effect : effects) {
      if (const Options* const options = effect.options<Options>()) return options;
    }
    return nullptr;
  }
  template <class Options>
  bool has() const {
    return find<Options>() != nullptr;
  }
  bool has(const std::string& effect) const;

  /// For closed_form; what effects say of it is added later.
  PushOptions push{0.03, false, 0.0, false};
  /// Time over which the tissue follows the tool after it was taken [s]; 0: at once.
  double rise_time = 0.0;

  /// For tissue as a solid.
  int element_order = 1;
  std::vector<Anchor> anchors;
  Material material;
  EquilibriumOptions solver;
  /// How long a run without poses lasts and its time step [s]; with inertia only.
  double duration = 1.0, dt = 0.01;
};

/// Why an effect of a scene makes no sense in it, or nothing.
std::string objection_to(const Effect& effect, const SceneDescription& scene);

}  // namespace tissue
