#pragma once

#include "block_rows.h"
#include "node_hierarchy.h"
#include "tissue/simulate/linear_solver.h"

#include <memory>

namespace tissue {

/// One V-cycle over a hierarchy of levels, as an inverse to go by: one sweep of Gauss and Seidel
/// before and one in the opposite order after, Galerkin's coarse matrices, a factorisation on the
/// coarsest level that is kept while it serves.
class Multigrid {
 public:
  /// `finest` is in the order of the hierarchy; references must outlive this.
  Multigrid(const NodeHierarchy& hierarchy, BlockRows& finest);

  /// For the matrix as it is now. `fixed` holds three flags for each vertex. False if it is seen
  /// not to be positive definite.
  bool prepare(const std::vector<std::uint8_t>& fixed);
  /// Calls iterate(), which returns how many iterations it took or −1 where they led nowhere; once
  /// more, with the coarsest level factorised anew, if that was because what was kept did not
  /// serve.
  template <class Iterate>
  bool retry(const Iterate& iterate) {
    const int iterations = iterate();
    return serves(iterations) && (iterations >= 0 || serves(iterate()));
  }
  /// What was kept is not kept any more.
  void forget() {
    is_worn_ = true;
    fresh_iterations_ = wasted_iterations_ = 0;
  }

  /// x = M⁻¹ b in the order of the hierarchy: writes right(), calls this, reads x().
  void cycle() { cycle(levels_.size()); }
  std::vector<float>& right() { return vectors_.back().right; }
  const std::vector<float>& x() const { return vectors_.back().x; }
  /// Coordinates that are fixed, in the order of the hierarchy.
  const std::vector<std::uint32_t>& fixed() const { return fixed_.back().coordinates; }

 private:
  // A level below the finest; where Galerkin's product adds each block of the next finer one, times
  // the weights of its row's and its column's parents.
  struct Level {
    BlockRows matrix;
    std::vector<std::uint32_t> targets;
  };
  struct Vectors {
    std::vector<float> right, x, residual;
  };

  // Three flags for each node; whether any of a node's is set; coordinates whose are.
  struct Fixed {
    std::vector<std::uint8_t> flags, touched;
    std::vector<std::uint32_t> coordinates;
  };

  const BlockRows& matrix(std::size_t l) const {
    return l == levels_.size() ? finest_ : levels_[l].matrix;
  }
  // To be told how many iterations it took: if they were too many, the coarsest level is factorised
  // anew with the next matrix. False if they led nowhere and nothing can be done.
  bool serves(int iterations);
  void set_fixed(const std::vector<std::uint8_t>& fixed);
  std::vector<std::vector<std::uint32_t>> rows_below(std::size_t l) const;
  void find_targets(std::size_t l);
  void make_coarser(std::size_t l);
  bool factorise_coarsest();
  void cycle(std::size_t l);
  void restrict_to(std::size_t coarse);
  void prolongate_from(std::size_t coarse);
  void clear_fixed(std::size_t l, std::vector<float>& vector) const;

  const std::vector<Coarsening>& steps_;
  const std::vector<std::uint32_t>& node_at_;
  BlockRows& finest_;
  // The coarsest first.
  std::vector<Level> levels_;
  std::vector<Vectors> vectors_;
  std::vector<Fixed> fixed_;
  std::unique_ptr<LinearSolver> coarsest_ = direct_solver();
  BlockMatrix coarsest_matrix_;
  std::vector<std::uint8_t> coarsest_fixed_;
  // Whether that factorisation is of the matrix at hand; whether it is to be made anew.
  bool is_fresh_ = false, is_worn_ = true;
  // With a new factorisation; more than that since then; more than what are worth another.
  int fresh_iterations_ = 0, wasted_iterations_ = 0;
  double factorisation_cost_;
};

}  // namespace tissue
