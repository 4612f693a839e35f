#include "held_nodes.h"

#include "tissue/simulate/anchors.h"

#include <algorithm>
#include <utility>

namespace tissue {
namespace {

Vec3 node(const Eigen::VectorXd& all, std::size_t i) {
  return all.segment<3>(static_cast<Eigen::Index>(3 * i));
}

}  // namespace

HeldNodes::HeldNodes(const FiniteElements& elements, const std::vector<ToolDescription>& tools,
                     std::size_t anchor_count, std::vector<int> anchor_of_vertex,
                     const std::vector<std::vector<std::uint32_t>>& inclusions)
    : elements_(elements),
      tools_(tools),
      grips_(tools.size()),
      anchor_count_(anchor_count),
      anchor_of_vertex_(std::move(anchor_of_vertex)) {
  complete_anchors(inclusions);
  holders_ = anchor_of_vertex_;
}

void HeldNodes::complete_anchors(const std::vector<std::vector<std::uint32_t>>& inclusions) {
  if (!inclusions.empty()) inclusion_of_.assign(anchor_of_vertex_.size(), kNobody);
  for (std::size_t i = 0; i < inclusions.size(); ++i) {
    int holder = kNobody;
    for (const std::uint32_t v : inclusions[i]) {
      inclusion_of_[v] = static_cast<int>(i);
      if (holder == kNobody) holder = anchor_of_vertex_[v];
    }
    for (const std::uint32_t v : inclusions[i]) {
      if (anchor_of_vertex_[v] == kNobody) anchor_of_vertex_[v] = holder;
    }
  }
}

bool HeldNodes::update(const ToolPoses& tools, const std::vector<Vec3>& vertices_now) {
  bool changed = false;
  for (std::size_t i = 0; i < grips_.size(); ++i) {
    if (tools_[i].shape != ToolShape::kSphere || !tools_[i].grasps) continue;
    if (!grips_[i].update(tools[i], tools_[i], vertices_now, holders_, inclusion_of_)) continue;
    changed = true;
    // The next tool takes what is left.
    find_holders();
  }
  return changed;
}

void HeldNodes::release() {
  for (Grip& grip : grips_) grip = {};
  find_holders();
}

bool HeldNodes::any_grip() const {
  return std::any_of(grips_.begin(), grips_.end(),
                     [](const Grip& grip) { return !grip.vertices().empty(); });
}

void HeldNodes::find_holders() {
  holders_ = anchor_of_vertex_;
  for (std::size_t i = 0; i < grips_.size(); ++i) {
    for (const std::uint32_t v : grips_[i].vertices()) {
      holders_[v] = static_cast<int>(anchor_count_ + i);
    }
  }
}

bool HeldNodes::is_held_midpoint(std::size_t midpoint) const {
  const Edge& ends = elements_.midpoints()[midpoint];
  return holders_[ends[0]] != kNobody && holders_[ends[1]] != kNobody;
}

std::vector<std::uint8_t> HeldNodes::flags() const {
  std::vector<std::uint8_t> flags;
  for (const int holder : holders_) flags.push_back(holder != kNobody);
  for (std::size_t i = 0; i < elements_.midpoints().size(); ++i) {
    flags.push_back(is_held_midpoint(i));
  }
  return flags;
}

Eigen::VectorXd HeldNodes::motion_to(const ToolPoses& tools,
                                     const Eigen::VectorXd& positions) const {
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(positions.size());
  for (std::size_t i = 0; i < grips_.size(); ++i) {
    if (!tools[i]) continue;
    grips_[i].for_each_place(*tools[i], [&](std::uint32_t v, const Vec3& place) {
      motion.segment<3>(3 * Eigen::Index{v}) = place - node(positions, v);
    });
  }
  for (std::size_t i = 0; i < elements_.midpoints().size(); ++i) {
    if (!is_held_midpoint(i)) continue;
    const Edge& ends = elements_.midpoints()[i];
    const std::size_t middle = holders_.size() + i;
    const Vec3 place = 0.5 * (node(positions, ends[0]) + node(motion, ends[0]) +
                              node(positions, ends[1]) + node(motion, ends[1]));
    motion.segment<3>(static_cast<Eigen::Index>(3 * middle)) = place - node(positions, middle);
  }
  return motion;
}

Eigen::VectorXd HeldNodes::motion_of(std::size_t tool, const Eigen::VectorXd& positions,
                                     const Vec3& centre,
                                     const std::function<Vec3(const Vec3&)>& motion_at) const {
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(positions.size());
  for (const std::uint32_t v : grips_[tool].vertices()) {
    motion.segment<3>(3 * Eigen::Index{v}) = motion_at(node(positions, v) - centre);
  }
  for (std::size_t i = 0; i < elements_.midpoints().size(); ++i) {
    if (!is_held_midpoint(i)) continue;
    const Edge& ends = elements_.midpoints()[i];
    motion.segment<3>(static_cast<Eigen::Index>(3 * (holders_.size() + i))) =
        0.5 * (node(motion, ends[0]) + node(motion, ends[1]));
  }
  return motion;
}

void HeldNodes::place(const ToolPoses& tools, std::vector<Vec3>& vertices) const {
  for (std::size_t i = 0; i < grips_.size(); ++i) {
    if (!tools[i]) continue;
    grips_[i].for_each_place(*tools[i],
                             [&](std::uint32_t v, const Vec3& place) { vertices[v] = place; });
  }
}

std::vector<HeldNodes::Share> HeldNodes::shares(std::size_t tool) const {
  std::vector<Share> result;
  for (const std::uint32_t v : grips_[tool].vertices()) result.push_back({v, 1.0});
  const int holder = static_cast<int>(anchor_count_ + tool);
  for (std::size_t i = 0; i < elements_.midpoints().size(); ++i) {
    if (!is_held_midpoint(i)) continue;
    for (const std::uint32_t end : elements_.midpoints()[i]) {
      if (holders_[end] == holder) result.push_back({holders_.size() + i, 0.5});
    }
  }
  return result;
}

Wrench HeldNodes::wrench(std::size_t tool, const Eigen::VectorXd& gradient,
                         const Eigen::VectorXd& positions, const Vec3& centre) const {
  Wrench sum;
  for (const auto& [i, part] : shares(tool)) {
    sum.add(node(positions, i) - centre, -part * node(gradient, i));
  }
  return sum;
}

std::vector<Vec3> HeldNodes::forces(const Eigen::VectorXd& gradient) const {
  std::vector<Vec3> result(anchor_count_ + grips_.size(), Vec3::Zero());
  for (std::size_t v = 0; v < holders_.size(); ++v) {
    if (holders_[v] != kNobody) result[static_cast<std::size_t>(holders_[v])] -= node(gradient, v);
  }
  for (std::size_t i = 0; i < elements_.midpoints().size(); ++i) {
    if (!is_held_midpoint(i)) continue;
    // Between two holders, each bears half.
    for (const std::uint32_t end : elements_.midpoints()[i]) {
      result[static_cast<std::size_t>(holders_[end])] -= 0.5 * node(gradient, holders_.size() + i);
    }
  }
  return result;
}

}  // namespace tissue
