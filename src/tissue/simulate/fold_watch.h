#pragma once

#include "tissue/simulate/body.h"

namespace tissue {

/// Whether a tet is flat or inside out where its corners are.
bool is_folded(const Tet& tet, const std::vector<Vec3>& vertices);

/// Finds tets that a superposition folds, without a look at those that its amounts are too small
/// for: F stays regular as long as what is added to it is smaller than its least singular value.
class FoldWatch {
 public:
  /// Nothing is watched.
  FoldWatch() = default;
  /// `base` and `columns`: places of the vertices without any amount [m], and how they move by a
  /// unit of each. `groups`: how many amounts belong together, in their order; turns and shifts are
  /// best kept apart.
  FoldWatch(const Body& body, const Eigen::VectorXd& base,
            const std::vector<std::vector<float>>& columns, std::vector<Eigen::Index> groups);

  /// Whether a tet is folded where `amounts` have taken the `vertices`.
  bool any_folded(const Eigen::VectorXd& amounts, const std::vector<Vec3>& vertices) const;

 private:
  struct Watched {
    // How much of its group's largest a tet's gradient by the amounts is, at most.
    float part;
    std::uint32_t tet;
  };
  const Body* body_ = nullptr;
  std::vector<Eigen::Index> groups_;
  // For each group: the largest gradient of a tet by amounts of one, by the least singular value
  // that its F has at the base.
  std::vector<double> largest_;
  // Those that fold first come first.
  std::vector<Watched> tets_;
};

}  // namespace tissue
