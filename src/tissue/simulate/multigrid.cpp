#include "multigrid.h"

#include <Eigen/Core>

#include <algorithm>

namespace tissue {
namespace {

// By how much of itself the diagonal is made larger on coarser levels: nodes of a lattice with few
// points around them may say the same as their neighbours.
constexpr float kHold = 1e-5f;

// What a factorisation of the coarsest level costs, counted in iterations: both by what they do to
// numbers, and not by time, so that the same input has the same bits.
double factorisation_cost(std::size_t coarsest_rows, std::size_t finest_blocks) {
  constexpr double kPerPair = 270.0, kPerBlock = 81.0;
  const auto rows = static_cast<double>(coarsest_rows);
  return 1.0 + kPerPair * rows * rows / (kPerBlock * static_cast<double>(finest_blocks));
}

BlockMatrix pattern_of(const BlockRows& matrix) {
  std::vector<std::uint32_t> pairs;
  for (std::uint32_t row = 0; row < matrix.row_count(); ++row) {
    for (std::uint32_t k = matrix.begin(row); k <= matrix.diagonal(row); ++k) {
      pairs.insert(pairs.end(), {row, matrix.column(k)});
    }
  }
  return {matrix.row_count(), pairs, 2};
}

}  // namespace

Multigrid::Multigrid(const NodeHierarchy& hierarchy, BlockRows& finest)
    : steps_(hierarchy.steps), node_at_(hierarchy.node_at), finest_(finest) {
  levels_.resize(steps_.size());
  for (std::size_t l = steps_.size(); l-- > 0;) {
    levels_[l].matrix = BlockRows(steps_[l].coarse_size, rows_below(l + 1));
    find_targets(l + 1);
  }
  for (std::size_t l = 0; l <= steps_.size(); ++l) {
    vectors_.emplace_back();
    for (auto* one : {&vectors_[l].right, &vectors_[l].x, &vectors_[l].residual}) {
      one->assign(3 * matrix(l).row_count() + 1, 0.0f);
    }
  }
  fixed_.resize(steps_.size() + 1);
  coarsest_matrix_ = pattern_of(matrix(0));
  factorisation_cost_ = factorisation_cost(matrix(0).row_count(), finest.block_count());
}

void Multigrid::set_fixed(const std::vector<std::uint8_t>& fixed) {
  for (std::size_t l = steps_.size() + 1; l-- > 0;) {
    Fixed& own = fixed_[l];
    own.flags.assign(3 * matrix(l).row_count(), 0);
    own.touched.assign(matrix(l).row_count(), 0);
    own.coordinates.clear();
    if (l == steps_.size()) {
      for (std::size_t i = 0; i < own.flags.size(); ++i) {
        own.flags[i] = fixed[3 * std::size_t{node_at_[i / 3]} + i % 3];
      }
    } else if (steps_[l].nested) {
      const std::vector<std::uint8_t>& finer = fixed_[l + 1].flags;
      std::copy_n(finer.begin(), own.flags.size(), own.flags.begin());
    }
    for (std::uint32_t i = 0; i < own.flags.size(); ++i) {
      if (own.flags[i] == 0) continue;
      own.coordinates.push_back(i);
      own.touched[i / 3] = 1;
    }
  }
}

bool Multigrid::prepare(const std::vector<std::uint8_t>& fixed) {
  set_fixed(fixed);
  for (std::size_t l = steps_.size(); l > 0; --l) make_coarser(l);
  if (!finest_.invert_diagonal(fixed_.back().flags, 0.0f)) return false;
  for (std::size_t l = 1; l < levels_.size(); ++l) {
    if (!levels_[l].matrix.invert_diagonal(fixed_[l].flags, kHold)) return false;
  }
  return factorise_coarsest();
}

bool Multigrid::serves(int iterations) {
  if (iterations < 0) {
    if (is_fresh_) return false;
    is_worn_ = true;
    return factorise_coarsest();
  }
  if (is_fresh_) {
    fresh_iterations_ = iterations;
    wasted_iterations_ = 0;
  }
  wasted_iterations_ += std::max(0, iterations - fresh_iterations_);
  is_worn_ = wasted_iterations_ > factorisation_cost_;
  return true;
}

// Which nodes of the next coarser level are coupled through those of level l.
std::vector<std::vector<std::uint32_t>> Multigrid::rows_below(std::size_t l) const {
  const Coarsening& step = steps_[l - 1];
  std::vector<std::vector<std::uint32_t>> rows(step.coarse_size);
  const BlockRows& finer = matrix(l);
  for (std::uint32_t row = 0; row < finer.row_count(); ++row) {
    for (std::uint32_t k = finer.begin(row); k < finer.end(row); ++k) {
      step.for_parents(row, [&](std::uint32_t a, float) {
        step.for_parents(finer.column(k), [&](std::uint32_t b, float) { rows[a].push_back(b); });
      });
    }
  }
  for (std::vector<std::uint32_t>& row : rows) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
  }
  return rows;
}

void Multigrid::find_targets(std::size_t l) {
  const Coarsening& step = steps_[l - 1];
  Level& coarser = levels_[l - 1];
  const BlockRows& finer = matrix(l);
  for (std::uint32_t row = 0; row < finer.row_count(); ++row) {
    for (std::uint32_t k = finer.begin(row); k < finer.end(row); ++k) {
      step.for_parents(row, [&](std::uint32_t a, float) {
        step.for_parents(finer.column(k), [&](std::uint32_t b, float) {
          coarser.targets.push_back(coarser.matrix.find(a, b));
        });
      });
    }
  }
  coarser.targets.shrink_to_fit();
}

// Galerkin's matrix Pᵀ A P of the next coarser level. What is fixed takes no part.
void Multigrid::make_coarser(std::size_t l) {
  const Coarsening& step = steps_[l - 1];
  Level& coarser = levels_[l - 1];
  const BlockRows& finer = matrix(l);
  const Fixed& fixed = fixed_[l];
  coarser.matrix.set_zero();
  const std::uint32_t* target = coarser.targets.data();
  for (std::uint32_t row = 0; row < finer.row_count(); ++row) {
    for (std::uint32_t k = finer.begin(row); k < finer.end(row); ++k) {
      const std::uint32_t column = finer.column(k);
      const float* from = finer.block(k);
      float free[9];
      if (fixed.touched[row] != 0 || fixed.touched[column] != 0) {
        for (std::size_t i = 0; i < 9; ++i) {
          const bool is_fixed = fixed.flags[3 * std::size_t{row} + i % 3] != 0 ||
                                fixed.flags[3 * std::size_t{column} + i / 3] != 0;
          free[i] = is_fixed ? 0.0f : from[i];
        }
        from = free;
      }
      step.for_parents(row, [&](std::uint32_t, float of_row) {
        step.for_parents(column, [&](std::uint32_t, float of_column) {
          add_block(of_row * of_column, from, coarser.matrix.block(*target++));
        });
      });
    }
  }
}

// The coarsest level's factorisation is kept while it serves: it is what changes least and costs
// most.
bool Multigrid::factorise_coarsest() {
  const BlockRows& coarsest = matrix(0);
  const std::vector<std::uint8_t>& fixed = fixed_[0].flags;
  if (!is_worn_ && fixed == coarsest_fixed_) {
    is_fresh_ = false;
    return true;
  }
  coarsest_matrix_.set_zero();
  for (std::uint32_t row = 0; row < coarsest.row_count(); ++row) {
    for (std::uint32_t k = coarsest.begin(row); k <= coarsest.diagonal(row); ++k) {
      const Eigen::Map<const Eigen::Matrix3f> block(coarsest.block(k));
      coarsest_matrix_.add(row, coarsest.column(k), block.cast<double>());
      if (row != coarsest.column(k)) continue;
      Mat3 hold = Mat3::Zero();
      for (int i = 0; i < 3; ++i) hold(i, i) = block(i, i) > 0.0f ? kHold * block(i, i) : 1.0;
      coarsest_matrix_.add(row, row, hold);
    }
  }
  is_worn_ = !coarsest_->prepare(coarsest_matrix_, fixed, 0.0);
  is_fresh_ = true;
  coarsest_fixed_ = fixed;
  return !is_worn_;
}

void Multigrid::cycle(std::size_t l) {
  Vectors& own = vectors_[l];
  if (l == 0) {
    const auto size = static_cast<Eigen::Index>(3 * matrix(0).row_count());
    Eigen::VectorXd x;
    coarsest_->solve(Eigen::Map<const Eigen::VectorXf>(own.right.data(), size).cast<double>(), x);
    Eigen::Map<Eigen::VectorXf>(own.x.data(), size) = x.cast<float>();
    return;
  }
  matrix(l).sweep_from_zero(own.right.data(), own.x.data());
  matrix(l).residual_after_sweep(own.x.data(), own.residual.data());
  clear_fixed(l, own.residual);
  restrict_to(l - 1);
  cycle(l - 1);
  prolongate_from(l - 1);
  matrix(l).sweep_back(own.right.data(), own.x.data());
}

void Multigrid::clear_fixed(std::size_t l, std::vector<float>& vector) const {
  for (const std::uint32_t i : fixed_[l].coordinates) vector[i] = 0.0f;
}

void Multigrid::restrict_to(std::size_t coarse) {
  const std::vector<float>& fine = vectors_[coarse + 1].residual;
  std::vector<float>& right = vectors_[coarse].right;
  std::fill(right.begin(), right.end(), 0.0f);
  for (std::uint32_t row = 0; row < steps_[coarse].fine_size; ++row) {
    steps_[coarse].for_parents(row, [&](std::uint32_t parent, float weight) {
      for (std::size_t i = 0; i < 3; ++i) {
        right[3 * std::size_t{parent} + i] += weight * fine[3 * std::size_t{row} + i];
      }
    });
  }
  clear_fixed(coarse, right);
}

void Multigrid::prolongate_from(std::size_t coarse) {
  const std::vector<float>& x = vectors_[coarse].x;
  std::vector<float>& fine = vectors_[coarse + 1].x;
  for (std::uint32_t row = 0; row < steps_[coarse].fine_size; ++row) {
    steps_[coarse].for_parents(row, [&](std::uint32_t parent, float weight) {
      for (std::size_t i = 0; i < 3; ++i) {
        fine[3 * std::size_t{row} + i] += weight * x[3 * std::size_t{parent} + i];
      }
    });
  }
  clear_fixed(coarse + 1, fine);
}

}  // namespace tissue
