#include "force_feedback.h"

#include <Eigen/LU>

namespace tissue {

ForceFeedback::ForceFeedback(const HeldNodes& held, const SoftHolds* soft, Equilibrium& equilibrium,
                             EffectCost* cost)
    : held_(held), soft_(soft), equilibrium_(equilibrium), cost_(cost) {}

void ForceFeedback::update(const ToolPoses& tools, const Eigen::VectorXd& positions,
                           bool keep_compliance) {
  const CostClock clock(cost_);
  tools_.resize(tools.size());
  Eigen::VectorXd gradient;
  for (std::size_t i = 0; i < tools.size(); ++i) {
    const bool holds = held_.holds(i) || (soft_ != nullptr && soft_->holds(i));
    if (!tools[i] || !holds) {
      tools_[i].reset();
      continue;
    }
    if (gradient.size() == 0) gradient = equilibrium_.gradient(positions);
    const Vec3& centre = tools[i]->position;
    Wrench wrench = held_.wrench(i, gradient, positions, centre);
    if (soft_ != nullptr) wrench += soft_->wrench(i, positions, centre);
    const bool keep = keep_compliance && tools_[i];
    tools_[i] = {wrench, keep ? tools_[i]->compliance : compliance_of(i, *tools[i], positions)};
  }
  if (cost_ != nullptr) cost_->bytes = tools_.size() * sizeof(tools_[0]);
}

// Moving the tool by a unit moves what it holds and pulls at its pad; what the free nodes then do,
// and the forces that this takes, are a linear solve for each axis.
Mat3 ForceFeedback::compliance_of(std::size_t tool, const ToolPose& pose,
                                  const Eigen::VectorXd& positions) {
  std::vector<Eigen::VectorXd> motions, pulls;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 unit = Vec3::Unit(axis);
    motions.push_back(
        held_.motion_of(tool, positions, pose.position, [&](const Vec3&) { return unit; }));
    pulls.push_back(Eigen::VectorXd::Zero(positions.size()));
    if (soft_ != nullptr) soft_->add_pull(tool, unit, pulls.back());
  }
  std::vector<Eigen::VectorXd> forces;
  const std::vector<Eigen::VectorXd> responses =
      equilibrium_.responses(positions, motions, pulls, forces);
  if (responses.empty()) return Mat3::Zero();
  Mat3 stiffness;
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    Vec3 change = held_.wrench(tool, forces[k], positions, pose.position).force;
    if (soft_ != nullptr) change += soft_->force_change(tool, Vec3::Unit(axis), responses[k]);
    stiffness.col(axis) = -change;
  }
  const Mat3 compliance = stiffness.inverse();
  return compliance.allFinite() ? compliance : Mat3(Mat3::Zero());
}

}  // namespace tissue
