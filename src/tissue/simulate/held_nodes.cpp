#include "held_nodes.h"

#include <algorithm>
#include <utility>

namespace tissue {
namespace {

Vec3 node(const Eigen::VectorXd& all, std::size_t i) {
  return all.segment<3>(static_cast<Eigen::Index>(3 * i));
}

}  // namespace

HeldNodes::HeldNodes(const FiniteElements& elements, const std::vector<ToolDescription>& tools,
                     std::vector<std::uint8_t> anchored)
    : elements_(elements),
      tools_(tools),
      grips_(tools.size()),
      anchored_(std::move(anchored)),
      taken_(anchored_) {}

bool HeldNodes::update(const ToolPoses& tools, const std::vector<Vec3>& vertices_now) {
  bool changed = false;
  for (std::size_t i = 0; i < grips_.size(); ++i) {
    if (!grips_[i].update(tools[i], tools_[i], vertices_now, taken_)) continue;
    changed = true;
    // The next tool takes what is left.
    find_taken();
  }
  return changed;
}

void HeldNodes::release() {
  for (Grip& grip : grips_) grip = {};
  find_taken();
}

bool HeldNodes::any_grip() const {
  return std::any_of(grips_.begin(), grips_.end(),
                     [](const Grip& grip) { return !grip.vertices().empty(); });
}

void HeldNodes::find_taken() {
  taken_ = anchored_;
  for (const Grip& grip : grips_) {
    for (const std::uint32_t v : grip.vertices()) taken_[v] = 1;
  }
}

bool HeldNodes::is_held_midpoint(std::size_t midpoint) const {
  const Edge& ends = elements_.midpoints()[midpoint];
  return taken_[ends[0]] != 0 && taken_[ends[1]] != 0;
}

std::vector<std::uint8_t> HeldNodes::flags() const {
  std::vector<std::uint8_t> flags = taken_;
  for (std::size_t i = 0; i < elements_.midpoints().size(); ++i) {
    flags.push_back(is_held_midpoint(i));
  }
  return flags;
}

Eigen::VectorXd HeldNodes::motion_to(const ToolPoses& tools,
                                     const Eigen::VectorXd& positions) const {
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(positions.size());
  for (std::size_t i = 0; i < grips_.size(); ++i) {
    for (std::size_t k = 0; tools[i] && k < grips_[i].vertices().size(); ++k) {
      const std::uint32_t v = grips_[i].vertices()[k];
      motion.segment<3>(3 * Eigen::Index{v}) = grips_[i].place(k, *tools[i]) - node(positions, v);
    }
  }
  for (std::size_t i = 0; i < elements_.midpoints().size(); ++i) {
    if (!is_held_midpoint(i)) continue;
    const Edge& ends = elements_.midpoints()[i];
    const std::size_t middle = taken_.size() + i;
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
    motion.segment<3>(static_cast<Eigen::Index>(3 * (taken_.size() + i))) =
        0.5 * (node(motion, ends[0]) + node(motion, ends[1]));
  }
  return motion;
}

void HeldNodes::place(const ToolPoses& tools, std::vector<Vec3>& vertices) const {
  for (std::size_t i = 0; i < grips_.size(); ++i) {
    for (std::size_t k = 0; tools[i] && k < grips_[i].vertices().size(); ++k) {
      vertices[grips_[i].vertices()[k]] = grips_[i].place(k, *tools[i]);
    }
  }
}

Vec3 HeldNodes::force_on(const std::vector<std::uint8_t>& vertices,
                         const Eigen::VectorXd& gradient) const {
  Vec3 sum = Vec3::Zero();
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    if (vertices[v] != 0) sum -= node(gradient, v);
  }
  for (std::size_t i = 0; i < elements_.midpoints().size(); ++i) {
    const Edge& ends = elements_.midpoints()[i];
    if (!is_held_midpoint(i)) continue;
    // Between two holders, each bears half.
    const int shares = (vertices[ends[0]] != 0) + (vertices[ends[1]] != 0);
    sum -= 0.5 * shares * node(gradient, vertices.size() + i);
  }
  return sum;
}

Vec3 HeldNodes::force_on_tool(std::size_t tool, const Eigen::VectorXd& gradient) const {
  std::vector<std::uint8_t> held(taken_.size(), 0);
  for (const std::uint32_t v : grips_[tool].vertices()) held[v] = 1;
  return force_on(held, gradient);
}

Vec3 HeldNodes::force_on_anchors(const Eigen::VectorXd& gradient) const {
  return force_on(anchored_, gradient);
}

}  // namespace tissue
