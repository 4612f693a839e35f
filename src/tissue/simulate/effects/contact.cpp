#include "../contact_energy.h"
#include "../effect_kind.h"

#include <algorithm>

// Tools that press: the surface slides along them and does not enter them.

namespace tissue::effects {
namespace {

struct ContactOptions {
  // How deep the surface may lie in a tool, as a part of its radius.
  double tolerance = 0.01;
};

// A tool goes no farther at once than to here from the surface, by its radius, so that its axis
// never gets to the other side. What is looked at reaches as far beyond the tool.
constexpr double kStride = 0.5, kReach = 1.0;
// Solutions that are looked for in one place.
constexpr int kRounds = 8;

std::any read(const YamlReader* parameters, Model) {
  ContactOptions options;
  if (parameters == nullptr) return options;
  parameters->require_keys({"tolerance"});
  if (parameters->has("tolerance")) {
    options.tolerance = parameters->at("tolerance").number(1e-4, 0.1);
  }
  return options;
}

std::string objection(const SceneDescription& scene) {
  const bool presses = std::any_of(scene.tools.begin(), scene.tools.end(),
                                   [](const ToolDescription& tool) { return !tool.grasps; });
  return presses ? "" : "contact without a tool of mode press: nothing would touch";
}

// The tip is where the pose is, the shaft lies behind it along −z of the tool.
Capsule capsule_at(const ToolDescription& tool, const ToolPose& pose) {
  Capsule capsule = {pose.position, pose.position, tool.radius};
  if (tool.shape == ToolShape::kCapsule) {
    capsule.end -= tool.length * (pose.orientation.normalized() * Vec3::UnitZ());
  }
  return capsule;
}

std::vector<double> radii_of(const std::vector<ToolDescription>& tools) {
  std::vector<double> radii;
  for (const ToolDescription& tool : tools) radii.push_back(tool.radius);
  return radii;
}

class Contact : public SolidEffect, public ToolLink {
 public:
  Contact(const ContactOptions& options, const SolidParts& solid)
      : options_(options),
        tools_(solid.scene.tools),
        energy_(solid.elements, solid.body, solid.young, radii_of(tools_)),
        states_(tools_.size()) {}

  const Energy* energy() const override { return &energy_; }
  bool is_quadratic() const override { return false; }
  bool loads() const override { return false; }
  std::size_t bytes() const override { return energy_.bytes(); }
  const ToolLink* link() const override { return this; }

  void reset() override {
    for (std::size_t i = 0; i < tools_.size(); ++i) lift(i);
  }

  bool take(const ToolPoses& tools, const PositionsNow& positions_now) override {
    const Eigen::VectorXd& positions = positions_now();
    bool changes = false;
    for (std::size_t i = 0; i < tools_.size(); ++i) {
      if (!energy_.capsule(i)) continue;
      // A tool that could not be followed through the tissue and has come out of it is free.
      const bool leaves =
          !tools[i] || (states_[i].lags && is_free(capsule_at(tools_[i], *tools[i]), positions));
      if (!leaves) continue;
      changes = changes || energy_.depth(i, positions) > 0.0;
      lift(i);
    }
    return changes;
  }

  double stride(const ToolPoses& from, const ToolPoses& to,
                const Eigen::VectorXd& positions) override {
    double part = 1.0;
    for (std::size_t i = 0; i < tools_.size(); ++i) {
      if (!energy_.capsule(i) || !from[i] || !to[i]) continue;
      const Capsule start = capsule_at(tools_[i], *from[i]), end = capsule_at(tools_[i], *to[i]);
      if (start.tip == end.tip && start.end == end.end) continue;
      part = std::min(
          part, energy_.surface().free_way(start, end, positions, (1.0 - kStride) * start.radius));
    }
    return part;
  }

  bool follow(const ToolPoses& tools, const Eigen::VectorXd& positions) override {
    rounds_ = 0;
    const bool touched = touches(positions);
    bool moves = false, swells = false;
    for (std::size_t i = 0; i < tools_.size(); ++i) {
      if (tools_[i].grasps || !tools[i]) continue;
      const Capsule there = capsule_at(tools_[i], *tools[i]);
      const std::optional<Capsule>& before = energy_.capsule(i);
      if (!before) {
        if (!enter(i, there, positions)) continue;
        moves = true;
        swells = swells || energy_.capsule(i)->radius < there.radius;
      } else if (before->tip != there.tip || before->end != there.end) {
        energy_.place(i, there);
        moves = true;
      }
    }
    if (!moves) return false;
    find_pairs(positions);
    return touched || swells || touches(positions);
  }

  bool is_stiff() const override { return !energy_.finds_nothing(); }

  // All that touches by now is looked at; a tool that came up in the tissue swells to its size; one
  // that is entered too deeply gets stiffer.
  bool refine(const Eigen::VectorXd& positions) override {
    if (energy_.finds_nothing()) return false;
    if (rounds_++ == kRounds) return false;
    bool again = false;
    std::vector<double> known;
    for (std::size_t i = 0; i < tools_.size(); ++i) known.push_back(energy_.depth(i, positions));
    find_pairs(positions);
    for (std::size_t i = 0; i < tools_.size(); ++i) {
      if (!energy_.capsule(i)) continue;
      Capsule capsule = *energy_.capsule(i);
      const double depth = energy_.depth(i, positions), allowed = allowed_depth(i);
      if (capsule.radius < tools_[i].radius) {
        capsule.radius = std::min(tools_[i].radius, capsule.radius + kStride * tools_[i].radius);
        energy_.place(i, capsule);
        find_pairs(positions);
      } else if (depth <= allowed) {
        continue;
      } else if (depth <= 1.01 * known[i]) {
        energy_.stiffen(i, 2.0 * depth / allowed);
      }
      again = true;
    }
    return again;
  }

  bool accepts(const Eigen::VectorXd& positions) const override {
    for (std::size_t i = 0; i < tools_.size(); ++i) {
      if (!energy_.capsule(i)) continue;
      const Capsule& capsule = *energy_.capsule(i);
      if (energy_.depth(i, positions) > allowed_depth(i) || is_inside(capsule, positions)) {
        return false;
      }
    }
    return true;
  }

  void after_step(const SolidView& solid) override {
    deepest_ = 0.0;
    for (std::size_t i = 0; i < tools_.size(); ++i) {
      states_[i].lags = false;
      if (!solid.tools[i]) states_[i].is_inside = false;
      if (!energy_.capsule(i) || !solid.tools[i]) continue;
      const Capsule wished = capsule_at(tools_[i], *solid.tools[i]);
      states_[i].lags =
          wished.tip != energy_.capsule(i)->tip || wished.end != energy_.capsule(i)->end;
      deepest_ = std::max(deepest_, energy_.depth(i, solid.positions()));
    }
  }

  void report(StepReport& report) const override {
    report.penetration = deepest_;
    for (std::size_t i = 0; i < states_.size(); ++i) {
      report.clamped = report.clamped || states_[i].lags;
      report.tool_inside = report.tool_inside || states_[i].is_inside;
    }
  }

  bool acts_on(std::size_t tool) const override { return energy_.capsule(tool).has_value(); }

  Wrench wrench(std::size_t tool, const Eigen::VectorXd& positions,
                const Vec3& centre) const override {
    Wrench sum;
    energy_.for_each_touch(tool, positions, centre,
                           [&](const Vec3& offset, const Vec3& force) { sum.add(offset, force); });
    return sum;
  }
  void add_pull(std::size_t tool, const Eigen::VectorXd& positions, const Vec3& direction,
                Eigen::VectorXd& gradient) const override {
    energy_.add_pull(tool, positions, direction, gradient);
  }
  Vec3 force_change(std::size_t tool, const Eigen::VectorXd& positions, const Vec3& direction,
                    const Eigen::VectorXd& response) const override {
    return energy_.force_change(tool, positions, direction, response);
  }

 private:
  struct ToolState {
    // Behind its pose; without touching anything because it came up inside.
    bool lags = false, is_inside = false;
  };

  double allowed_depth(std::size_t tool) const { return options_.tolerance * tools_[tool].radius; }

  bool is_inside(const Capsule& capsule, const Eigen::VectorXd& positions) const {
    const NodeSurface& surface = energy_.surface();
    return surface.contains(capsule.tip, positions) ||
           (!capsule.is_ball() && surface.contains(capsule.end, positions));
  }
  bool is_free(const Capsule& capsule, const Eigen::VectorXd& positions) const {
    return !is_inside(capsule, positions) &&
           energy_.surface().distance(capsule, positions, capsule.radius) >= capsule.radius;
  }

  bool touches(const Eigen::VectorXd& positions) const {
    for (std::size_t i = 0; i < tools_.size(); ++i) {
      if (energy_.capsule(i) && energy_.depth(i, positions) > 0.0) return true;
    }
    return false;
  }

  // A tool comes up, as thick as there is room for it. Inside the tissue there is none: it touches
  // nothing until it has been outside.
  bool enter(std::size_t tool, Capsule capsule, const Eigen::VectorXd& positions) {
    states_[tool].is_inside = is_inside(capsule, positions);
    if (states_[tool].is_inside) return false;
    capsule.radius = energy_.surface().distance(capsule, positions, capsule.radius);
    if (capsule.radius == 0.0) return false;
    energy_.place(tool, capsule);
    return true;
  }

  void lift(std::size_t tool) {
    energy_.place(tool, std::nullopt);
    states_[tool] = {};
  }

  void find_pairs(const Eigen::VectorXd& positions) { energy_.find_pairs(positions, kReach); }

  ContactOptions options_;
  const std::vector<ToolDescription>& tools_;
  ContactEnergy energy_;
  std::vector<ToolState> states_;
  int rounds_ = 0;
  double deepest_ = 0.0;
};

std::unique_ptr<SolidEffect> make(const Effect& effect, const SolidParts& solid) {
  return std::make_unique<Contact>(*effect.options<ContactOptions>(), solid);
}

}  // namespace

extern const EffectKind contact = {"contact", typeid(ContactOptions), is_solid, read, objection,
                                   make};

}  // namespace tissue::effects
