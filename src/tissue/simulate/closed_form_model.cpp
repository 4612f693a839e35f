#include "deformation_model.h"
#include "tissue/simulate/fold_guard.h"
#include "tissue/simulate/surface_touch.h"

#include <utility>

namespace tissue {
namespace {

// The clamp stays this far below the amplitude at which a tet would be flat.
constexpr double kFoldMargin = 0.999;

// A body that moves under one tool by the closed form of the paper. The shape is a function of the
// tool's path since it took hold: at rest, held, or on the way back to rest.
class ClosedFormModel : public DeformationModel {
 public:
  ClosedFormModel(const SceneDescription& scene, const Body& body, EffectCosts& costs)
      : scene_(scene),
        recovery_(scene.find<RecoveryOptions>()),
        push_(scene.push),
        body_(&body),
        costs_(costs),
        state_(rest_state(body)),
        touch_(body) {
    const auto* const response = scene.find<DensityResponseOptions>();
    push_.density_response = response != nullptr;
    if (response != nullptr) push_.reference_density = response->reference;
  }

  StepReport step(const ToolPoses& tools, double dt) override {
    const std::optional<ToolPose>& tool = tools.front();
    StepReport report;
    if (phase_ == Phase::kHeld && must_release(tool)) release();
    if (phase_ == Phase::kRecovering) recover(dt);
    // A tool whose jaw was closed all along does not take hold of what it passes.
    const bool closed = tool && tool->closed.value_or(true);
    const bool just_closed = closed && !was_closed_;
    const bool may_take = closed && (!scene_.tools.front().grasps || !tool->closed || just_closed);
    if (phase_ == Phase::kRest && may_take) take(*tool);
    if (phase_ == Phase::kHeld) report.clamped = follow(*tool, dt);
    was_closed_ = closed;
    report.moved_vertices = field_.vertices.size();
    return report;
  }

  void reset() override {
    put_to_rest();
    was_closed_ = false;
  }

  const State& state() const override { return state_; }
  std::vector<NodeWeight> shape_at(const TetPlace& place) const override {
    return linear_shape(body_->tets[place.tet], place);
  }
  Vec3 node(std::uint32_t number) const override { return state_.positions[number]; }
  bool recovering() const override { return phase_ == Phase::kRecovering; }

 private:
  enum class Phase { kRest, kHeld, kRecovering };

  void take(const ToolPose& tool) {
    const std::optional<std::uint32_t> target =
        touch_.target(tool.position, scene_.tools.front().radius);
    if (!target) return;
    if (!recovery_) put_to_rest();
    target_ = *target;
    start_ = tool.position;
    held_seconds_ = 0.0;
    {
      const CostClock clock(costs_.of<DensityResponseOptions>());
      field_ = push_field(body_->rest, body_->densities, target_, push_);
    }
    if (scene_.has<FoldGuardOptions>()) {
      EffectCost* const cost = costs_.of<FoldGuardOptions>();
      const CostClock clock(cost);
      guard_.emplace(*body_, field_);
      if (cost != nullptr) cost->bytes = guard_->bytes();
    }
    phase_ = Phase::kHeld;
  }

  bool must_release(const std::optional<ToolPose>& tool) const {
    if (!tool || !tool->closed.value_or(true)) return true;
    const Vec3 target = body_->rest[target_].cast<double>();
    return (tool->position - target).norm() > scene_.push.range;
  }

  // True if the push was clamped.
  bool follow(const ToolPose& tool, double dt) {
    held_seconds_ += dt;
    double gain = 1.0;
    if (scene_.push.literal) {
      gain = held_seconds_ * held_seconds_;
    } else if (scene_.rise_time > 0.0) {
      const double part = std::min(1.0, held_seconds_ / scene_.rise_time);
      gain = part * part;
    }
    Vec3 displacement = gain * (tool.position - start_);
    bool clamped = false;
    if (guard_) {
      const CostClock clock(costs_.of<FoldGuardOptions>());
      const double amplitude = displacement.norm();
      if (amplitude > 0.0) {
        const double limit = kFoldMargin * guard_->limit(displacement / amplitude);
        clamped = amplitude > limit;
        if (clamped) displacement *= limit / amplitude;
      }
    }
    displacement_ = displacement;
    displace<float>(body_->rest, field_, displacement_.cast<float>(), state_.positions);
    return clamped;
  }

  void release() {
    if (recovery_) {
      phase_ = Phase::kRecovering;
      recovering_seconds_ = 0.0;
    } else {
      phase_ = Phase::kRest;
    }
  }

  void recover(double dt) {
    const CostClock clock(costs_.of<RecoveryOptions>());
    recovering_seconds_ += dt;
    const double left = 1.0 - recovering_seconds_ / recovery_->time;
    if (!(left > 0.0)) {
      put_to_rest();
      return;
    }
    const Vec3 displacement = left * displacement_;
    displace<float>(body_->rest, field_, displacement.cast<float>(), state_.positions);
  }

  void put_to_rest() {
    for (const std::uint32_t vertex : field_.vertices) {
      state_.positions[vertex] = body_->rest[vertex].cast<double>();
    }
    field_ = {};
    guard_.reset();
    phase_ = Phase::kRest;
  }

  const SceneDescription& scene_;
  // Nothing where tissue stays where it was left.
  const RecoveryOptions* recovery_;
  PushOptions push_;
  const Body* body_;
  EffectCosts& costs_;
  State state_;
  SurfaceTouch touch_;

  Phase phase_ = Phase::kRest;
  std::uint32_t target_ = 0;
  Vec3 start_ = Vec3::Zero();
  Vec3 displacement_ = Vec3::Zero();
  double held_seconds_ = 0.0;
  double recovering_seconds_ = 0.0;
  bool was_closed_ = false;
  PushField<float> field_;
  std::optional<FoldGuard> guard_;
};

}  // namespace

std::unique_ptr<DeformationModel> closed_form_model(const SceneDescription& scene, const Body& body,
                                                    EffectCosts& costs) {
  return std::make_unique<ClosedFormModel>(scene, body, costs);
}

}  // namespace tissue
