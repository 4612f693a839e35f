#include "tissue/simulate/scene.h"

#include "tissue/base/error.h"
#include "tissue/simulate/fold_guard.h"
#include "tissue/simulate/surface_touch.h"

#include <chrono>
#include <cmath>
#include <utility>

namespace tissue {
namespace {

// The clamp stays this far below the amplitude at which a tet would be flat.
constexpr double kFoldMargin = 0.999;

class Stopwatch {
 public:
  explicit Stopwatch(double& seconds) : seconds_(seconds) {}
  ~Stopwatch() {
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& seconds_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

class Scene::Implementation {
 public:
  Implementation(SceneDescription description, std::shared_ptr<const Body> body)
      : scene_(std::move(description)),
        body_(std::move(body)),
        state_(rest_state(*body_)),
        touch_(*body_) {
    if (scene_.push.density_response) costs_.push_back({"density_response", 0.0, 0});
    if (scene_.recovery_time) costs_.push_back({"recovery", 0.0, 0});
    if (scene_.fold_guard) costs_.push_back({"fold_guard", 0.0, 0});
  }

  StepReport step(const std::optional<ToolPose>& tool, double dt) {
    if (!(dt >= 0.0 && std::isfinite(dt))) {
      throw InputError(ErrorCode::kDt, "dt: " + to_text(dt) + " s is not a time step");
    }
    if (tool && !tool->position.allFinite()) {
      throw InputError(ErrorCode::kNonfinite, "pose: the tool's position is not finite");
    }
    StepReport report;
    report.tool_lost = !tool;
    if (phase_ == Phase::kHeld && must_release(tool)) release();
    if (phase_ == Phase::kRecovering) recover(dt);
    // A tool whose jaw was closed all along does not take hold of what it passes.
    const bool closed = tool && tool->closed.value_or(true);
    const bool just_closed = closed && !was_closed_;
    const bool may_take = closed && (!scene_.tool.grasps || !tool->closed || just_closed);
    if (phase_ == Phase::kRest && may_take) take(*tool);
    if (phase_ == Phase::kHeld) report.clamped = follow(*tool, dt);
    was_closed_ = closed;
    report.moved_vertices = field_.vertices.size();
    return report;
  }

  void reset() {
    put_to_rest();
    was_closed_ = false;
  }

  const State& state() const { return state_; }
  const Body& body() const { return *body_; }
  bool recovering() const { return phase_ == Phase::kRecovering; }
  const std::vector<EffectCost>& costs() const { return costs_; }

 private:
  enum class Phase { kRest, kHeld, kRecovering };

  EffectCost& cost(const char* name) {
    for (EffectCost& cost : costs_) {
      if (cost.name == name) return cost;
    }
    return costs_.front();
  }

  void take(const ToolPose& tool) {
    const std::optional<std::uint32_t> target = touch_.target(tool.position, scene_.tool.radius);
    if (!target) return;
    if (!scene_.recovery_time) put_to_rest();
    target_ = *target;
    start_ = tool.position;
    held_seconds_ = 0.0;
    {
      double unnamed = 0.0;
      const Stopwatch watch(scene_.push.density_response ? cost("density_response").seconds
                                                         : unnamed);
      field_ = push_field(body_->rest, body_->densities, target_, scene_.push);
    }
    if (scene_.fold_guard) {
      const Stopwatch watch(cost("fold_guard").seconds);
      guard_.emplace(*body_, field_);
      cost("fold_guard").bytes = guard_->bytes();
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
      const Stopwatch watch(cost("fold_guard").seconds);
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
    if (scene_.recovery_time) {
      phase_ = Phase::kRecovering;
      recovering_seconds_ = 0.0;
    } else {
      phase_ = Phase::kRest;
    }
  }

  void recover(double dt) {
    const Stopwatch watch(cost("recovery").seconds);
    recovering_seconds_ += dt;
    const double left = 1.0 - recovering_seconds_ / *scene_.recovery_time;
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

  SceneDescription scene_;
  std::shared_ptr<const Body> body_;
  State state_;
  SurfaceTouch touch_;
  std::vector<EffectCost> costs_;

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

Scene::Scene(const SceneDescription& description, std::shared_ptr<const Body> body)
    : implementation_(std::make_unique<Implementation>(description, std::move(body))) {}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

StepReport Scene::step(const std::optional<ToolPose>& tool, double dt) {
  return implementation_->step(tool, dt);
}
void Scene::reset() { implementation_->reset(); }
const State& Scene::state() const { return implementation_->state(); }
const Body& Scene::body() const { return implementation_->body(); }
bool Scene::recovering() const { return implementation_->recovering(); }
const std::vector<EffectCost>& Scene::effect_costs() const { return implementation_->costs(); }

}  // namespace tissue
