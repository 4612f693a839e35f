#include "../effect_kind.h"
#include "../held_nodes.h"
#include "../tool_response.h"

#include <Eigen/LU>

// What tools feel: force and torque from the solver's own residual at what they hold or touch, and
// how that changes as they move, by the Hessian at hand.

namespace tissue::effects {
namespace {

struct ForceFeedbackOptions {};

// Moving the tool by a unit moves what it holds and pulls at what it touches; what the free nodes
// then do, and the forces that this takes, are a linear solve for each axis.
Mat3 compliance_of(std::size_t tool, const SolidView& solid) {
  const Eigen::VectorXd& positions = solid.positions();
  const Vec3& centre = solid.tools[tool]->position;
  std::vector<Eigen::VectorXd> motions, pulls;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 unit = Vec3::Unit(axis);
    motions.push_back(
        solid.held.motion_of(tool, positions, centre, [&](const Vec3&) { return unit; }));
    pulls.push_back(Eigen::VectorXd::Zero(positions.size()));
    for (const ToolLink* link : solid.links) {
      if (link->acts_on(tool)) link->add_pull(tool, positions, unit, pulls.back());
    }
  }
  std::vector<Eigen::VectorXd> forces;
  const std::vector<Eigen::VectorXd> responses =
      solid.equilibrium.responses(positions, motions, pulls, forces);
  if (responses.empty()) return Mat3::Zero();
  Mat3 stiffness;
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    Vec3 change = solid.held.wrench(tool, forces[k], positions, centre).force;
    for (const ToolLink* link : solid.links) {
      if (!link->acts_on(tool)) continue;
      change += link->force_change(tool, positions, Vec3::Unit(axis), responses[k]);
    }
    stiffness.col(axis) = -change;
  }
  // As second derivatives of an energy are.
  stiffness = 0.5 * (stiffness + stiffness.transpose()).eval();
  const Mat3 compliance = stiffness.inverse();
  return compliance.allFinite() ? compliance : Mat3(Mat3::Zero());
}

Wrench wrench_of(std::size_t tool, const SolidView& solid, Eigen::VectorXd& gradient) {
  const Eigen::VectorXd& positions = solid.positions();
  if (gradient.size() == 0) gradient = solid.equilibrium.gradient(positions);
  const Vec3& centre = solid.tools[tool]->position;
  Wrench wrench = solid.held.wrench(tool, gradient, positions, centre);
  for (const ToolLink* link : solid.links) {
    if (link->acts_on(tool)) wrench += link->wrench(tool, positions, centre);
  }
  return wrench;
}

class ForceFeedback : public SolidEffect {
 public:
  void reset() override { tools_.clear(); }
  std::size_t bytes() const override { return tools_.capacity() * sizeof(tools_[0]); }

  void after_step(const SolidView& solid) override {
    tools_.resize(solid.tools.size());
    // Of all nodes; found out only where no superposition knows what tools hold.
    Eigen::VectorXd gradient;
    for (std::size_t i = 0; i < tools_.size(); ++i) {
      bool acts = solid.held.holds(i);
      for (const ToolLink* link : solid.links) acts = acts || link->acts_on(i);
      if (!solid.tools[i] || !acts) {
        tools_[i].reset();
        continue;
      }
      const Wrench wrench = solid.response != nullptr
                                ? solid.response->wrench(i, solid.tools[i]->position)
                                : wrench_of(i, solid, gradient);
      const bool keep = solid.is_superposed && tools_[i];
      tools_[i] = {wrench, keep ? tools_[i]->compliance : compliance_of(i, solid)};
    }
  }

  const std::vector<std::optional<ToolFeedback>>* feedback() const override { return &tools_; }

 private:
  // Nothing for a tool that neither holds nor touches anything.
  std::vector<std::optional<ToolFeedback>> tools_;
};

std::unique_ptr<SolidEffect> make(const Effect&, const SolidParts&) {
  return std::make_unique<ForceFeedback>();
}

}  // namespace

extern const EffectKind force_feedback = {"force_feedback", typeid(ForceFeedbackOptions),
                                          is_solid,         read_nothing<ForceFeedbackOptions>,
                                          nullptr,          make};

}  // namespace tissue::effects
