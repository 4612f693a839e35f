#pragma once

#include "tissue/simulate/anchors.h"
#include "tissue/simulate/equilibrium.h"
#include "tissue/simulate/material.h"
#include "tissue/simulate/push_field.h"

#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace tissue {

/// What moves a body: the paper's formula, springs on its edges, or tissue as a solid.
enum class Model { kClosedForm, kMassSpring, kLinear, kCorotational, kNeoHookean };

/// What a scene may add to a model.
enum class Effect {
  kDensityResponse,
  kRecovery,
  kFoldGuard,
  kGravity,
  kInertia,
  kDamping,
  kForceFeedback
};

const char* name(Model model);
const char* name(Effect effect);
const std::vector<Model>& all_models();
const std::vector<Effect>& all_effects();
/// Whether a model can have an effect.
bool can_have(Model model, Effect effect);
/// Effects by models as a table in Markdown, for the README.
std::string effects_table();

/// What a tool takes hold of: all tissue within its sphere, which then moves as if it were part of
/// the tool, or the surface within that distance, through a soft pad. What a pad does to a body
/// hardly depends on its mesh; what a sphere does depends on which vertices lie in it.
enum class ToolShape { kSphere, kPad };

/// A tool as a scene names it.
struct ToolDescription {
  std::string name = "tool";
  ToolShape shape = ToolShape::kSphere;
  /// Of the sphere or the pad [m].
  double radius = 0.004;
  /// Pressure of a pad, in its middle, for each metre by which it is squeezed or stretched [Pa/m].
  /// More, and the surface follows the tool more closely.
  double pad_stiffness = 1e6;
  /// `press` takes hold of the tissue at the first touch; `grasp` when the jaw closes on it.
  bool grasps = false;
};

/// Effect `inertia`: implicit Euler in substeps of at most so many seconds, each of so many of
/// Newton's iterations (1: a linearised step; more: to the solver's tolerance).
struct InertiaOptions {
  double substep = 0.02;
  int iterations = 1;
};

/// Effect `damping`, Rayleigh's: what resists velocities is α times the mass and β times the
/// stiffness.
struct DampingOptions {
  /// α [1/s]
  double mass = 5.0;
  /// β [s]
  double stiffness = 0.0;
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
  bool has(Effect effect) const;

  /// For closed_form.
  PushOptions push{0.03, false, 0.0, false};
  /// Time over which the tissue follows the tool after it was taken [s]; 0: at once.
  double rise_time = 0.0;
  /// Effect `recovery`: seconds until released tissue is back at rest. Without it, it stays.
  std::optional<double> recovery_time;
  /// Effect `fold_guard`: no tet is ever folded; the target then stays behind the tool.
  bool fold_guard = false;

  /// For tissue as a solid.
  int element_order = 1;
  std::vector<Anchor> anchors;
  Material material;
  /// Effect `gravity` [m/s²].
  Vec3 gravity = {0.0, 0.0, -9.81};
  EquilibriumOptions solver;
  InertiaOptions inertia;
  DampingOptions damping;
  /// How long a run without poses lasts and its time step [s]; with inertia only.
  double duration = 1.0, dt = 0.01;
};

}  // namespace tissue
