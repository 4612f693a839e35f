#pragma once

#include "tissue/simulate/scene.h"

#include <algorithm>
#include <array>
#include <optional>

namespace tissue {

/// What the tissue at a tool is like, as far as a step found out.
struct LocalTissue {
  /// Where the tool was [m], and the force of the tissue on it there [N].
  Vec3 position = Vec3::Zero();
  Vec3 force = Vec3::Zero();
  /// How far the tool goes for a newton more [m/N].
  Mat3 compliance = Mat3::Zero();
  /// Whether tissue can pull at the tool, as at one that grasps.
  bool pulls = false;
};

struct ForceLoopOptions {
  /// No force is larger [N], and none rises faster [N/s]; it may fall at once.
  double max_force = 3.0, max_rise = 500.0;
  /// Of what takes energy back [N s/m]: more than twice the device's mass by the time between
  /// forces would shake it.
  double max_damping = 20.0;
  /// No spring is stiffer [N/m].
  double max_stiffness = 3000.0;
};

/// What a hand feels of tissue between steps, at any rate: the local linear model that steps leave,
/// made safe. It never gives a device more energy than that put in while it touched: what it gave
/// too much is taken back as damping (passivity observer and controller of Hannaford and Ryu, IEEE
/// Transactions on Robotics and Automation 18(1), 2002), whatever stale steps do, and whether a
/// force reaches the device at once or up to kLongestDelay samples late.
class ForceLoop {
 public:
  static constexpr std::size_t kLongestDelay = 2;

  /// Throws InputError E_PARAM unless all limits are positive.
  explicit ForceLoop(const ForceLoopOptions& options);

  /// What a step found; nothing where the tool touches nothing.
  void set_tissue(const std::optional<LocalTissue>& tissue);
  /// The force on a device [N] whose tool is at `position`, so many seconds after it was last
  /// asked.
  Vec3 force_at(const Vec3& position, double dt);
  /// Nothing is felt from now on until a step says more: the tool is lost, or something failed.
  void stop();

  /// What the device has put in since it began to touch, less what it was given back, at least [J].
  double energy() const { return *std::min_element(energies_.begin(), energies_.end()); }

 private:
  Vec3 spring_force(const Vec3& position) const;

  ForceLoopOptions options_;
  std::optional<LocalTissue> tissue_;
  Mat3 stiffness_ = Mat3::Zero();
  std::optional<Vec3> position_;
  Vec3 last_motion_ = Vec3::Zero();
  // The last answers, newest first, and the energy if each of them is what the device has.
  std::array<Vec3, kLongestDelay + 1> forces_;
  std::array<double, kLongestDelay + 1> energies_ = {};
};

}  // namespace tissue
