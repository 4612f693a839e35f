#pragma once

#include "block_rows.h"
#include "node_hierarchy.h"
#include "tissue/simulate/linear_solver.h"

#include <memory>

namespace tissue {

/// One V-cycle over the hierarchy from which vertices were made, as an inverse to go by: one sweep
/// of Gauss and Seidel before and one in the opposite order after, Galerkin's coarse matrices, a
/// factorisation on the coarsest level that is kept while it serves.
class Multigrid {
 public:
  /// `finest` is in the order of the hierarchy; references must outlive this.
  Multigrid(const NodeHierarchy& hierarchy, BlockRows& finest);

  /// For the matrix as it is now. `fixed` holds three flags for each vertex. False if it is seen
  /// not to be positive definite.
  bool prepare(const std::vector<std::uint8_t>& fixed);
  /// To be told how many iterations it took since; the coarsest level is then factorised anew with
  /// the next matrix, if more than it should. −1: they led nowhere. True if trying again with a new
  /// factorisation makes sense.
  bool serves(int iterations);

  /// x = M⁻¹ b in the order of the hierarchy: writes right(), calls this, reads x().
  void cycle() { cycle(levels_.size()); }
  std::vector<float>& right() { return vectors_.back().right; }
  const std::vector<float>& x() const { return vectors_.back().x; }
  /// Coordinates that are fixed, in the order of the hierarchy.
  const std::vector<std::uint32_t>& fixed() const { return fixed_coordinates_; }
  std::size_t bytes() const;

 private:
  // A level below the finest, and how it is made from the next finer one: for each block there the
  // blocks here to which it adds a half or a quarter, from first_target[block] on.
  struct Level {
    BlockRows matrix;
    std::vector<std::uint32_t> first_target, targets;
  };
  struct Vectors {
    std::vector<float> right, x, residual;
  };

  const BlockRows& matrix(std::size_t l) const {
    return l == levels_.size() ? finest_ : levels_[l].matrix;
  }
  Edge ancestors(std::size_t l, std::uint32_t place) const;
  std::vector<std::vector<std::uint32_t>> rows_below(std::size_t l) const;
  void find_targets(std::size_t l);
  void make_coarser(std::size_t l);
  bool factorise_coarsest();
  void cycle(std::size_t l);
  void restrict_to(std::size_t coarse);
  void prolongate_from(std::size_t coarse);
  void clear_fixed(std::size_t l, std::vector<float>& vector) const;

  const NodeHierarchy& hierarchy_;
  BlockRows& finest_;
  // The coarsest first.
  std::vector<Level> levels_;
  std::vector<Vectors> vectors_;
  // By place: three flags each; whether any of them is set; coordinates for which they are.
  std::vector<std::uint8_t> fixed_, touched_;
  std::vector<std::uint32_t> fixed_coordinates_;
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
