#include "grip.h"

#include "tissue/simulate/anchors.h"

namespace tissue {

bool Grip::update(const std::optional<ToolPose>& pose, const ToolDescription& tool,
                  const std::vector<Vec3>& vertices_now, const std::vector<int>& holders) {
  const Jaw::Act act = jaw_.act(pose, !vertices_.empty());
  if (act == Jaw::Act::kRelease) {
    vertices_.clear();
    offsets_.clear();
    return true;
  }
  if (act == Jaw::Act::kNothing) return false;
  const Eigen::Quaterniond into_tool = pose->orientation.normalized().conjugate();
  for (std::uint32_t v = 0; v < vertices_now.size(); ++v) {
    const Vec3 offset = vertices_now[v] - pose->position;
    if (holders[v] != kNobody || offset.norm() > tool.radius) continue;
    vertices_.push_back(v);
    offsets_.push_back(into_tool * offset);
  }
  return !vertices_.empty();
}

}  // namespace tissue
