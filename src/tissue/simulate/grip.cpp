#include "grip.h"

#include "tissue/simulate/anchors.h"

namespace tissue {
namespace {

// From 1 in the middle of a patch to 0 at its rim, level at both.
double share_at(double distance, const ToolDescription& tool) {
  if (tool.shape == ToolShape::kSphere) return 1.0;
  const double part = distance / tool.radius;
  return (1.0 - part * part) * (1.0 - part * part);
}

}  // namespace

void Grip::take(std::uint32_t node, const Vec3& place, const ToolPose& pose,
                const ToolDescription& tool) {
  const Vec3 offset = place - pose.position;
  const Eigen::Quaterniond into_tool = pose.orientation.normalized().conjugate();
  holds_.push_back({node, into_tool * offset, place, share_at(offset.norm(), tool)});
}

bool Grip::update(const std::optional<ToolPose>& pose, const ToolDescription& tool,
                  const std::vector<Vec3>& vertices_now, const std::vector<int>& holders,
                  const std::vector<std::uint8_t>& on_surface) {
  const bool closed = pose && pose->closed.value_or(true);
  const bool just_closed = closed && !was_closed_;
  was_closed_ = closed;
  if (!closed) {
    const bool held_something = !holds_.empty();
    holds_.clear();
    return held_something;
  }
  // A jaw that was closed all along does not take hold of what it passes.
  if (!holds_.empty() || (pose->closed && !just_closed)) return false;
  for (std::uint32_t v = 0; v < vertices_now.size(); ++v) {
    if (holders[v] != kNobody || (vertices_now[v] - pose->position).norm() > tool.radius) continue;
    if (tool.shape == ToolShape::kPatch && on_surface[v] == 0) continue;
    take(v, vertices_now[v], *pose, tool);
  }
  return !holds_.empty();
}

}  // namespace tissue
