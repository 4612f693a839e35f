#pragma once

#include "tissue/simulate/push_field.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tissue {

/// A tool as a scene names it.
struct ToolDescription {
  std::string name = "tool";
  /// Radius of the tool's sphere [m].
  double radius = 0.004;
  /// `press` takes hold of the tissue at the first touch; `grasp` when the jaw closes on it.
  bool grasps = false;
};

/// A scene file, checked. The only place where a scene's defaults stand.
struct SceneDescription {
  std::string name = "scene";
  std::string model = "closed_form";
  PushOptions push{0.03, false, 0.0, false};
  /// Time over which the tissue follows the tool after it was taken [s]; 0: at once.
  double rise_time = 0.0;
  ToolDescription tool;
  /// Effect `recovery`: seconds until released tissue is back at rest. Without it, it stays.
  std::optional<double> recovery_time;
  /// Effect `fold_guard`: no tet is ever folded; the target then stays behind the tool.
  bool fold_guard = false;
};

/// A tool at one instant.
struct ToolPose {
  Vec3 position = Vec3::Zero();
  /// Whether the jaw is closed; a tool without a jaw takes hold at the first touch in either mode.
  std::optional<bool> closed;
};

/// What an effect cost so far.
struct EffectCost {
  std::string name;
  double seconds = 0.0;
  std::size_t bytes = 0;
};

/// What one step did.
struct StepReport {
  /// The push was held back so that no tet folds.
  bool clamped = false;
  bool tool_lost = false;
  std::size_t moved_vertices = 0;
};

/// A body that moves under one tool by the closed form of the paper. The shape is a function of the
/// tool's path since it took hold: at rest, held, or on the way back to rest.
class Scene {
 public:
  /// Throws InputError as body_of does.
  Scene(const SceneDescription& description, std::shared_ptr<const Body> body);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// Advances by `dt` seconds to the tool's pose; without a pose the tool is lost. Throws
  /// InputError E_DT unless 0 <= dt is finite and E_NONFINITE for a position that is not; the state
  /// is then as before.
  StepReport step(const std::optional<ToolPose>& tool, double dt);
  /// Back to rest at once.
  void reset();

  const State& state() const;
  const Body& body() const;
  /// True while something moves without the tool moving.
  bool recovering() const;
  /// One entry for each effect that the scene names.
  const std::vector<EffectCost>& effect_costs() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace tissue
