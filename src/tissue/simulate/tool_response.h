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
  double energy() const { return response_.energy(amounts_); }
  /// Of the tissue on a tool that holds it, followed last, about `centre`.
  Wrench wrench(std::size_t tool, const Vec3& centre) const;

 private:
  ToolPoses base_tools_;
  // What each tool holds.
  std::vector<std::vector<HeldNodes::Share>> shares_;
  LinearResponse response_;
  FoldWatch watch_;
  // How each tool has moved since the base: its translation, then R − I column by column.
  Eigen::VectorXd amounts_;
};

}  // namespace tissue
