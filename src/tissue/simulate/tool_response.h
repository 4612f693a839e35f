#pragma once

#include "fold_watch.h"
#include "held_nodes.h"
#include "linear_response.h"

namespace tissue {

/// A linear body that tools hold: it follows them by superposition.
class ToolResponse {
 public:
  /// `base` is an equilibrium with the tools at `base_tools`.
  ToolResponse(const Body& body, Equilibrium& equilibrium, const HeldNodes& held,
               const Eigen::VectorXd& base, ToolPoses base_tools);

  /// Where the vertices are once the tools are there.
  void follow(const ToolPoses& tools, std::vector<Vec3>& vertices);
  /// The same of all nodes, for the tools followed last.
  Eigen::VectorXd positions() const { return response_.superpose(amounts_); }
  /// Whether a tet is folded where follow() has taken the vertices.
  bool folds(const std::vector<Vec3>& vertices) const {
    return watch_.any_folded(amounts_, vertices);
  }
  /// Those that are not where the body at rest has them, as far as follow() may have moved them.
  std::size_t moved_vertices() const {
    return amounts_.isZero(0.0) ? moved_at_base_ : moved_by_tools_;
  }
  double energy() const { return response_.energy(amounts_); }
  /// Of the tissue on a tool that holds it, followed last, about `centre`.
  Wrench wrench(std::size_t tool, const Vec3& centre) const;

 private:
  ToolPoses base_tools_;
  // What each tool holds.
  std::vector<std::vector<HeldNodes::Share>> shares_;
  LinearResponse response_;
  FoldWatch watch_;
  // Counted once: a count at each step would take as long as the step.
  std::size_t moved_at_base_ = 0, moved_by_tools_ = 0;
  // How each tool has moved since the base: its translation, then R − I column by column.
  Eigen::VectorXd amounts_;
};

}  // namespace tissue
