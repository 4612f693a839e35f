#pragma once

#include "tissue/simulate/scene_description.h"

#include <algorithm>
#include <memory>

namespace tissue {

/// No tool is farther from the origin [m]: clouds are float32, and squares have to stay finite.
constexpr double kFarthestTool = 1e6;

/// A tool at one instant.
struct ToolPose {
  Vec3 position = Vec3::Zero();
  /// Whether the jaw is closed; a tool without a jaw takes hold at the first touch in either mode.
  std::optional<bool> closed = {};
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// One entry for each tool of the scene, in its order; without a pose a tool is lost.
using ToolPoses = std::vector<std::optional<ToolPose>>;
inline bool any_is_there(const ToolPoses& tools) {
  return std::any_of(tools.begin(), tools.end(), [](const auto& tool) { return bool(tool); });
}

/// What an effect cost so far.
struct EffectCost {
  std::string name;
  double seconds = 0.0;
  std::size_t bytes = 0;
};

/// What one step did.
struct StepReport {
  /// The push was held back so that no tet folds, or a tool could not be followed all its way
  /// through the tissue.
  bool clamped = false;
  /// A tool that presses came up inside the tissue: it touches nothing until it has been outside.
  bool tool_inside = false;
  /// How deep the surface lies in a tool that presses, at most [m].
  double penetration = 0.0;
  bool tool_lost = false;
  /// No equilibrium was found: the state is the last valid one.
  bool not_converged = false;
  /// Some tet is inside out: laws of solids allow it where tissue is moved too far or too fast, and
  /// bring it back. Not looked at by closed_form, which has the effect fold_guard for it.
  bool folded = false;
  std::size_t moved_vertices = 0;
  /// Numbers that a step finds; 0 for closed_form.
  std::size_t unknowns = 0;
  /// Of the solver; 0 and 0 for closed_form.
  int iterations = 0;
  double residual = 0.0;
  /// How linear systems were solved; empty where there was none.
  std::string solver;
  /// Of the state [J]; nothing for closed_form.
  std::optional<double> energy;
};

/// How a tet is strained: the von Mises stress of Cauchy's stress [Pa], the largest principal
/// stretch less one and det F, means over its volume.
struct TetStrain {
  double von_mises = 0.0;
  double largest_strain = 0.0;
  double det_f = 0.0;
};

/// A force [N] and a torque about a tool's centre [N m].
struct Wrench {
  Vec3 force = Vec3::Zero();
  Vec3 torque = Vec3::Zero();

  void add(const Vec3& at_offset, const Vec3& force_there) {
    force += force_there;
    torque += at_offset.cross(force_there);
  }
  Wrench& operator+=(const Wrench& other) {
    force += other.force;
    torque += other.torque;
    return *this;
  }
};

/// What a tool feels: a linear model of the tissue for a loop that is faster than steps.
struct ToolFeedback {
  /// Of the tissue on the tool.
  Wrench wrench;
  /// How far the tool goes for each newton more with which it is moved, the tissue following [m/N],
  /// to a few per cent; zero where that is not known.
  Mat3 compliance = Mat3::Zero();
};

/// A body that moves as a scene says: one model and the effects that the scene names.
class Scene {
 public:
  /// Throws InputError E_SCENE for an anchor that holds nothing, E_UNCONSTRAINED for a solid that
  /// is not held, E_PARAM where the material asks for what the body does not have.
  /// `threads`: 0 for as many as there are.
  Scene(SceneDescription description, std::shared_ptr<const Body> body, int threads = 1);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// Advances by `dt` seconds to the tools' poses. Throws InputError E_DT unless 0 <= dt is finite,
  /// E_NONFINITE for a pose that is not, E_PARAM for one beyond kFarthestTool and for a wrong
  /// number of poses; the state is then as before.
  StepReport step(const ToolPoses& tools, double dt);
  /// For a scene of one tool.
  StepReport step(const std::optional<ToolPose>& tool, double dt) {
    return step(ToolPoses{tool}, dt);
  }
  /// Back to rest at once.
  void reset();

  const SceneDescription& description() const;
  const State& state() const;
  const Body& body() const;
  /// True while something moves without a tool moving.
  bool recovering() const;
  /// One entry for each effect that the scene names.
  const std::vector<EffectCost>& effect_costs() const;
  /// Where the probes are now [m]; nothing for one that no tissue answers to.
  std::map<std::string, std::optional<Vec3>> probes() const;
  /// Where places in the material are now [m], by the shape functions of the model's elements.
  std::vector<Vec3> places(const std::vector<TetPlace>& material) const;
  /// Force of the tissue on each tool [N]; nothing for a model that knows none.
  std::vector<std::optional<Vec3>> tool_forces() const;
  /// One for each tool with the effect `force_feedback`, else none at all; nothing for a tool that
  /// holds nothing.
  std::vector<std::optional<ToolFeedback>> tool_feedback() const;
  /// Force of the tissue on each anchor [N]; empty for a model that knows none.
  std::vector<Vec3> anchor_forces() const;
  /// For each tet; empty for a model that knows no stress.
  std::vector<TetStrain> strains() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace tissue
