#include "grip.h"

#include "tissue/simulate/anchors.h"

#include <set>

namespace tissue {

bool Grip::update(const std::optional<ToolPose>& pose, const ToolDescription& tool,
                  const std::vector<Vec3>& vertices_now, const std::vector<int>& holders,
                  const std::vector<int>& inclusions) {
  const Jaw::Act act = jaw_.act(pose, !vertices_.empty());
  if (act == Jaw::Act::kRelease) {
    vertices_.clear();
    offsets_.clear();
    return true;
  }
  if (act == Jaw::Act::kNothing) return false;
  const Eigen::Quaterniond into_tool = pose->orientation.normalized().conjugate();
  const auto is_near = [&](std::uint32_t v) {
    return holders[v] == kNobody && (vertices_now[v] - pose->position).norm() <= tool.radius;
  };
  std::set<int> taken;
  for (std::uint32_t v = 0; v < inclusions.size(); ++v) {
    if (inclusions[v] != kNobody && is_near(v)) taken.insert(inclusions[v]);
  }
  for (std::uint32_t v = 0; v < vertices_now.size(); ++v) {
    const bool is_part = !inclusions.empty() && taken.count(inclusions[v]) != 0;
    if (!is_part && !is_near(v)) continue;
    const Vec3 offset = vertices_now[v] - pose->position;
    vertices_.push_back(v);
    offsets_.push_back(into_tool * offset);
  }
  return !vertices_.empty();
}

}  // namespace tissue
