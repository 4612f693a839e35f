#include "tool_response.h"

#include <utility>

#include <algorithm>

namespace tissue {
namespace {

constexpr Eigen::Index kShifts = 3, kTurns = 9, kMotions = kShifts + kTurns;

// Twelve motions for each tool, by a unit each: along the axes, then the columns of R − I.
std::vector<Eigen::VectorXd> unit_motions(const HeldNodes& held, const Eigen::VectorXd& base,
                                          const ToolPoses& tools) {
  std::vector<Eigen::VectorXd> motions;
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    const Vec3 centre = tools[tool] ? tools[tool]->position : Vec3(Vec3::Zero());
    const auto add = [&](const std::function<Vec3(const Vec3&)>& motion_at) {
      motions.push_back(held.motion_of(tool, base, centre, motion_at));
    };
    for (int axis = 0; axis < 3; ++axis) {
      add([&](const Vec3&) -> Vec3 { return Vec3::Unit(axis); });
    }
    for (int column = 0; column < 3; ++column) {
      for (int row = 0; row < 3; ++row) {
        add([&](const Vec3& offset) -> Vec3 { return offset[column] * Vec3::Unit(row); });
      }
    }
  }
  return motions;
}

std::vector<std::vector<HeldNodes::Share>> shares_of(const HeldNodes& held, std::size_t tools) {
  std::vector<std::vector<HeldNodes::Share>> shares;
  for (std::size_t tool = 0; tool < tools; ++tool) shares.push_back(held.shares(tool));
  return shares;
}

// One tool after the other.
std::vector<std::size_t> nodes_of(const std::vector<std::vector<HeldNodes::Share>>& shares) {
  std::vector<std::size_t> nodes;
  for (const auto& of_tool : shares) {
    for (const HeldNodes::Share& share : of_tool) nodes.push_back(share.node);
  }
  return nodes;
}

std::vector<Eigen::Index> groups_of(std::size_t tools) {
  std::vector<Eigen::Index> groups;
  for (std::size_t tool = 0; tool < tools; ++tool) groups.insert(groups.end(), {kShifts, kTurns});
  return groups;
}

}  // namespace

ToolResponse::ToolResponse(const Body& body, Equilibrium& equilibrium, const HeldNodes& held,
                           const Eigen::VectorXd& base, ToolPoses base_tools)
    : base_tools_(std::move(base_tools)),
      shares_(shares_of(held, base_tools_.size())),
      response_(equilibrium, base, unit_motions(held, base, base_tools_), nodes_of(shares_)),
      watch_(body, base, response_.columns(), groups_of(base_tools_.size())) {
  for (std::size_t v = 0; v < body.rest.size(); ++v) {
    const std::size_t i = 3 * v;
    const bool at_base =
        base.segment<3>(static_cast<Eigen::Index>(i)) != body.rest[v].cast<double>();
    const auto moves = [&](const std::vector<float>& column) {
      return column[i] != 0.0f || column[i + 1] != 0.0f || column[i + 2] != 0.0f;
    };
    moved_at_base_ += at_base;
    moved_by_tools_ +=
        at_base || std::any_of(response_.columns().begin(), response_.columns().end(), moves);
  }
}

Wrench ToolResponse::wrench(std::size_t tool, const Vec3& centre) const {
  const Eigen::VectorXd positions = response_.watched_positions(amounts_),
                        gradient = response_.watched_gradient(amounts_);
  Eigen::Index at = 0;
  for (std::size_t before = 0; before < tool; ++before) {
    at += 3 * static_cast<Eigen::Index>(shares_[before].size());
  }
  Wrench sum;
  for (const HeldNodes::Share& share : shares_[tool]) {
    sum.add(positions.segment<3>(at) - centre, -share.part * gradient.segment<3>(at));
    at += 3;
  }
  return sum;
}

void ToolResponse::follow(const ToolPoses& tools, std::vector<Vec3>& vertices) {
  amounts_.setZero(kMotions * static_cast<Eigen::Index>(tools.size()));
  for (std::size_t i = 0; i < tools.size(); ++i) {
    if (!tools[i] || !base_tools_[i]) continue;
    const auto k = kMotions * static_cast<Eigen::Index>(i);
    amounts_.segment<kShifts>(k) = tools[i]->position - base_tools_[i]->position;
    // A tool that only moves costs one pass over the body, one that turns four.
    if (tools[i]->orientation.coeffs() == base_tools_[i]->orientation.coeffs()) continue;
    const Eigen::Quaterniond turn =
        tools[i]->orientation.normalized() * base_tools_[i]->orientation.normalized().conjugate();
    const Mat3 change = turn.toRotationMatrix() - Mat3::Identity();
    amounts_.segment<kTurns>(k + kShifts) =
        Eigen::Map<const Eigen::Matrix<double, kTurns, 1>>(change.data());
  }
  response_.superpose(amounts_, vertices);
}

}  // namespace tissue
