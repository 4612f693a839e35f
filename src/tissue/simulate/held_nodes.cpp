#include "held_nodes.h"

#include "tissue/simulate/anchors.h"

#include <algorithm>
#include <set>
#include <utility>

namespace tissue {
namespace {

Vec3 node(const Eigen::VectorXd& all, std::size_t i) {
  return all.segment<3>(static_cast<Eigen::Index>(3 * i));
}

bool is_patch(const ToolDescription& tool) { return tool.shape == ToolShape::kPatch; }

// For each vertex and midpoint.
std::vector<std::uint8_t> surface_flags(const FiniteElements& elements, const Body& body) {
  std::vector<std::uint8_t> flags(elements.node_count(), 0);
  std::set<Edge> edges;
  for (const Triangle& triangle : body.surface) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto ends = std::minmax(triangle[k], triangle[(k + 1) % 3]);
      flags[ends.first] = 1;
      edges.insert({ends.first, ends.second});
    }
  }
  const std::vector<Edge>& midpoints = elements.midpoints();
  for (std::size_t i = 0; i < midpoints.size(); ++i) {
    const auto ends = std::minmax(midpoints[i][0], midpoints[i][1]);
    flags[elements.vertex_count() + i] = edges.count({ends.first, ends.second}) != 0;
  }
  return flags;
}

}  // namespace

HeldNodes::HeldNodes(const FiniteElements& elements, const Body& body,
                     const std::vector<ToolDescription>& tools, std::size_t anchor_count,
                     std::vector<int> anchor_of_vertex)
    : elements_(elements),
      tools_(tools),
      grips_(tools.size()),
      anchor_count_(anchor_count),
      anchor_of_vertex_(std::move(anchor_of_vertex)) {
  if (std::any_of(tools.begin(), tools.end(), is_patch)) {
    on_surface_ = surface_flags(elements, body);
  }
  find_holders();
}

bool HeldNodes::update(const ToolPoses& tools, const std::vector<Vec3>& vertices_now) {
  bool changed = false;
  for (std::size_t i = 0; i < grips_.size(); ++i) {
    if (!grips_[i].update(tools[i], tools_[i], vertices_now, holders_, on_surface_)) continue;
    changed = true;
    if (is_patch(tools_[i]) && tools[i]) take_midpoints(i, *tools[i], vertices_now);
    // The next tool takes what is left.
    find_holders();
  }
  return changed;
}

void HeldNodes::take_midpoints(std::size_t tool, const ToolPose& pose,
                               const std::vector<Vec3>& vertices_now) {
  std::vector<std::uint8_t> held(vertices_now.size(), 0);
  for (const Hold& hold : grips_[tool].holds()) held[hold.node] = 1;
  for (std::size_t i = 0; i < elements_.midpoints().size(); ++i) {
    const Edge& ends = elements_.midpoints()[i];
    const std::size_t middle = vertices_now.size() + i;
    if (held[ends[0]] == 0 || held[ends[1]] == 0 || on_surface_[middle] == 0) continue;
    grips_[tool].take(static_cast<std::uint32_t>(middle),
                      0.5 * (vertices_now[ends[0]] + vertices_now[ends[1]]), pose, tools_[tool]);
  }
}

void HeldNodes::release() {
  for (Grip& grip : grips_) grip = {};
  find_holders();
}

bool HeldNodes::any_grip() const {
  return std::any_of(grips_.begin(), grips_.end(), [](const Grip& grip) { return !grip.empty(); });
}

void HeldNodes::find_holders() {
  holders_ = anchor_of_vertex_;
  for (std::size_t i = 0; i < grips_.size(); ++i) {
    for (const Hold& hold : grips_[i].holds()) {
      if (hold.node < holders_.size()) holders_[hold.node] = static_cast<int>(anchor_count_ + i);
    }
  }
  halfway_.clear();
  for (std::size_t i = 0; i < elements_.midpoints().size(); ++i) {
    const auto& [a, b] = elements_.midpoints()[i];
    if (holders_[a] == kNobody || holders_[b] == kNobody) continue;
    // A patch has taken those between its own that it holds.
    const bool of_patch = holders_[a] == holders_[b] &&
                          holders_[a] >= static_cast<int>(anchor_count_) &&
                          is_patch(tools_[static_cast<std::size_t>(holders_[a]) - anchor_count_]);
    if (!of_patch) halfway_.push_back(i);
  }
}

std::vector<std::uint8_t> HeldNodes::flags() const {
  std::vector<std::uint8_t> flags(elements_.node_count(), 0);
  for (std::size_t v = 0; v < holders_.size(); ++v) flags[v] = holders_[v] != kNobody;
  for (const std::size_t i : halfway_) flags[holders_.size() + i] = 1;
  for (const Grip& grip : grips_) {
    for (const Hold& hold : grip.holds()) flags[hold.node] = 1;
  }
  return flags;
}

Eigen::VectorXd HeldNodes::motion_to(const ToolPoses& tools,
                                     const Eigen::VectorXd& positions) const {
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(positions.size());
  for (std::size_t i = 0; i < grips_.size(); ++i) {
    if (!tools[i]) continue;
    const Mat3 turn = tools[i]->orientation.normalized().toRotationMatrix();
    for (const Hold& hold : grips_[i].holds()) {
      motion.segment<3>(3 * Eigen::Index{hold.node}) =
          hold.place(*tools[i], turn) - node(positions, hold.node);
    }
  }
  for (const std::size_t i : halfway_) {
    const Edge& ends = elements_.midpoints()[i];
    const std::size_t middle = holders_.size() + i;
    const Vec3 place = 0.5 * (node(positions, ends[0]) + node(motion, ends[0]) +
                              node(positions, ends[1]) + node(motion, ends[1]));
    motion.segment<3>(static_cast<Eigen::Index>(3 * middle)) = place - node(positions, middle);
  }
  return motion;
}

Eigen::VectorXd HeldNodes::motion_of(std::size_t tool, const ToolPose& pose,
                                     Eigen::Index coordinates,
                                     const std::function<Vec3(const Vec3&)>& motion_at) const {
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(coordinates);
  const Mat3 turn = pose.orientation.normalized().toRotationMatrix();
  for (const Hold& hold : grips_[tool].holds()) {
    motion.segment<3>(3 * Eigen::Index{hold.node}) = hold.share * motion_at(turn * hold.offset);
  }
  for (const std::size_t i : halfway_) {
    const Edge& ends = elements_.midpoints()[i];
    motion.segment<3>(static_cast<Eigen::Index>(3 * (holders_.size() + i))) =
        0.5 * (node(motion, ends[0]) + node(motion, ends[1]));
  }
  return motion;
}

void HeldNodes::place(const ToolPoses& tools, std::vector<Vec3>& vertices) const {
  for (std::size_t i = 0; i < grips_.size(); ++i) {
    if (!tools[i]) continue;
    const Mat3 turn = tools[i]->orientation.normalized().toRotationMatrix();
    for (const Hold& hold : grips_[i].holds()) {
      if (hold.node < vertices.size()) vertices[hold.node] = hold.place(*tools[i], turn);
    }
  }
}

std::vector<Vec3> HeldNodes::forces(const Eigen::VectorXd& gradient) const {
  std::vector<Vec3> result(anchor_count_ + grips_.size(), Vec3::Zero());
  std::vector<double> shares(holders_.size(), 1.0);
  for (std::size_t i = 0; i < grips_.size(); ++i) {
    for (const Hold& hold : grips_[i].holds()) {
      if (hold.node < shares.size()) {
        shares[hold.node] = hold.share;
      } else {
        result[anchor_count_ + i] -= hold.share * node(gradient, hold.node);
      }
    }
  }
  for (std::size_t v = 0; v < holders_.size(); ++v) {
    if (holders_[v] == kNobody) continue;
    result[static_cast<std::size_t>(holders_[v])] -= shares[v] * node(gradient, v);
  }
  for (const std::size_t i : halfway_) {
    // Between two holders, each bears half.
    for (const std::uint32_t end : elements_.midpoints()[i]) {
      result[static_cast<std::size_t>(holders_[end])] -=
          0.5 * shares[end] * node(gradient, holders_.size() + i);
    }
  }
  return result;
}

}  // namespace tissue
