#include "tool_actions.h"

#include <algorithm>
#include <utility>

namespace tissue {

ToolActions::ToolActions(const std::vector<ToolDescription>& tools, HeldNodes& held,
                         std::vector<Part> parts)
    : tools_(tools), held_(held), parts_(std::move(parts)) {}

bool ToolActions::take(const ToolPoses& tools, const std::vector<Vec3>& vertices,
                       const PositionsNow& positions) {
  regrips_ = held_.update(tools, vertices);
  bool changes = regrips_;
  reached_.resize(tools.size());
  for (std::size_t i = 0; i < tools.size(); ++i) {
    // One that was there is still where it was.
    if (tools[i] && reached_[i]) {
      reached_[i]->closed = tools[i]->closed;
    } else {
      reached_[i] = tools[i];
    }
  }
  for (const Part& part : parts_) {
    const CostClock clock(part.cost);
    if (part.effect->take(tools, positions)) changes = true;
  }
  // What was taken hold of was taken where the tool is.
  for (std::size_t i = 0; changes && i < tools.size(); ++i) {
    if (tools_[i].grasps) reached_[i] = tools[i];
  }
  return changes;
}

void ToolActions::release() {
  held_.release();
  reached_.clear();
}

double ToolActions::stride(const ToolPoses& tools, const Eigen::VectorXd& positions) const {
  double part = 1.0;
  for (const Part& one : parts_) {
    const CostClock clock(one.cost);
    part = std::min(part, one.effect->stride(reached_, tools, positions));
  }
  return part;
}

Eigen::VectorXd ToolActions::follow(const ToolPoses& tools, const Eigen::VectorXd& positions) {
  changed_ = false;
  for (const Part& part : parts_) {
    const CostClock clock(part.cost);
    if (part.effect->follow(tools, positions)) changed_ = true;
  }
  reached_ = tools;
  return held_.motion_to(tools, positions);
}

bool ToolActions::is_stiff() const {
  return std::any_of(parts_.begin(), parts_.end(),
                     [](const Part& part) { return part.effect->is_stiff(); });
}

bool ToolActions::refine(const Eigen::VectorXd& positions) const {
  bool again = false;
  for (const Part& part : parts_) {
    const CostClock clock(part.cost);
    if (part.effect->refine(positions)) again = true;
  }
  return again;
}

bool ToolActions::accepts(const Eigen::VectorXd& positions) const {
  return std::all_of(parts_.begin(), parts_.end(), [&](const Part& part) {
    const CostClock clock(part.cost);
    return part.effect->accepts(positions);
  });
}

ToolPoses between(const ToolPoses& from, const ToolPoses& to, double part) {
  ToolPoses poses = to;
  for (std::size_t i = 0; i < to.size(); ++i) {
    if (!to[i] || !from[i] || part == 1.0) continue;
    poses[i]->position = from[i]->position + part * (to[i]->position - from[i]->position);
    poses[i]->orientation =
        from[i]->orientation.normalized().slerp(part, to[i]->orientation.normalized());
  }
  return poses;
}

}  // namespace tissue
