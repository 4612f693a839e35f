#include "multigrid.h"

#include <Eigen/Core>

#include <algorithm>

namespace tissue {
namespace {

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
    : hierarchy_(hierarchy), finest_(finest) {
  const std::size_t finest_level = hierarchy.sizes.size() - 1;
  levels_.resize(finest_level);
  for (std::size_t l = finest_level; l-- > 0;) {
    levels_[l].matrix = BlockRows(hierarchy.sizes[l], rows_below(l + 1));
    find_targets(l + 1);
  }
  for (const std::uint32_t size : hierarchy.sizes) {
    vectors_.emplace_back();
    for (auto* one : {&vectors_.back().right, &vectors_.back().x, &vectors_.back().residual}) {
      one->assign(3 * std::size_t{size} + 1, 0.0f);
    }
  }
  coarsest_matrix_ = pattern_of(matrix(0));
  factorisation_cost_ = factorisation_cost(hierarchy.sizes[0], finest.block_count());
}

bool Multigrid::prepare(const std::vector<std::uint8_t>& fixed) {
  const std::size_t count = hierarchy_.node_at.size();
  fixed_.resize(3 * count);
  touched_.resize(count);
  fixed_coordinates_.clear();
  for (std::uint32_t i = 0; i < 3 * count; ++i) {
    fixed_[i] = fixed[3 * std::size_t{hierarchy_.node_at[i / 3]} + i % 3];
    if (fixed_[i] != 0) fixed_coordinates_.push_back(i);
  }
  std::fill(touched_.begin(), touched_.end(), std::uint8_t{0});
  for (const std::uint32_t i : fixed_coordinates_) touched_[i / 3] = 1;
  for (std::size_t l = levels_.size(); l > 0; --l) make_coarser(l);
  if (!finest_.invert_diagonal(fixed_, 0.0f)) return false;
  for (std::size_t l = 1; l < levels_.size(); ++l) {
    if (!levels_[l].matrix.invert_diagonal(fixed_, 0.0f)) return false;
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

// A vertex's parents on the next coarser level: itself if it is there already.
Edge Multigrid::ancestors(std::size_t l, std::uint32_t place) const {
  if (place < hierarchy_.sizes[l - 1]) return {place, place};
  return hierarchy_.parents[place - hierarchy_.sizes[0]];
}

// Which vertices of the next coarser level are coupled through those of level l.
std::vector<std::vector<std::uint32_t>> Multigrid::rows_below(std::size_t l) const {
  std::vector<std::vector<std::uint32_t>> rows(hierarchy_.sizes[l - 1]);
  const BlockRows& finer = matrix(l);
  for (std::uint32_t row = 0; row < finer.row_count(); ++row) {
    for (std::uint32_t k = finer.begin(row); k < finer.end(row); ++k) {
      for (const std::uint32_t a : ancestors(l, row)) {
        for (const std::uint32_t b : ancestors(l, finer.column(k))) rows[a].push_back(b);
      }
    }
  }
  for (std::vector<std::uint32_t>& row : rows) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
  }
  return rows;
}

void Multigrid::find_targets(std::size_t l) {
  Level& coarser = levels_[l - 1];
  const BlockRows& finer = matrix(l);
  coarser.first_target.push_back(0);
  for (std::uint32_t row = 0; row < finer.row_count(); ++row) {
    const Edge from = ancestors(l, row);
    for (std::uint32_t k = finer.begin(row); k < finer.end(row); ++k) {
      const Edge to = ancestors(l, finer.column(k));
      const int row_count = from[0] == from[1] ? 1 : 2, column_count = to[0] == to[1] ? 1 : 2;
      for (int i = 0; i < row_count; ++i) {
        for (int j = 0; j < column_count; ++j) {
          coarser.targets.push_back(coarser.matrix.find(from[i], to[j]));
        }
      }
      coarser.first_target.push_back(static_cast<std::uint32_t>(coarser.targets.size()));
    }
  }
}

// Galerkin's matrix Pᵀ A P of the next coarser level. What is fixed takes no part.
void Multigrid::make_coarser(std::size_t l) {
  Level& coarser = levels_[l - 1];
  const BlockRows& finer = matrix(l);
  coarser.matrix.set_zero();
  for (std::uint32_t row = 0; row < finer.row_count(); ++row) {
    for (std::uint32_t k = finer.begin(row); k < finer.end(row); ++k) {
      const std::uint32_t column = finer.column(k);
      const float* from = finer.block(k);
      float free[9];
      if (touched_[row] != 0 || touched_[column] != 0) {
        for (std::size_t i = 0; i < 9; ++i) {
          const bool is_fixed = fixed_[3 * std::size_t{row} + i % 3] != 0 ||
                                fixed_[3 * std::size_t{column} + i / 3] != 0;
          free[i] = is_fixed ? 0.0f : from[i];
        }
        from = free;
      }
      const std::uint32_t begin = coarser.first_target[k], end = coarser.first_target[k + 1];
      const float share = 1.0f / static_cast<float>(end - begin);
      for (std::uint32_t t = begin; t < end; ++t) {
        add_block(share, from, coarser.matrix.block(coarser.targets[t]));
      }
    }
  }
}

// The coarsest level's factorisation is kept while it serves: it is what changes least and costs
// most.
bool Multigrid::factorise_coarsest() {
  const BlockRows& coarsest = matrix(0);
  const std::vector<std::uint8_t> fixed(fixed_.begin(),
                                        fixed_.begin() + 3 * std::ptrdiff_t{hierarchy_.sizes[0]});
  if (!is_worn_ && fixed == coarsest_fixed_) {
    is_fresh_ = false;
    return true;
  }
  coarsest_matrix_.set_zero();
  for (std::uint32_t row = 0; row < coarsest.row_count(); ++row) {
    for (std::uint32_t k = coarsest.begin(row); k <= coarsest.diagonal(row); ++k) {
      const Eigen::Map<const Eigen::Matrix3f> block(coarsest.block(k));
      coarsest_matrix_.add(row, coarsest.column(k), block.cast<double>());
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
  for (const std::uint32_t i : fixed_coordinates_) {
    if (i >= 3 * hierarchy_.sizes[l]) return;
    vector[i] = 0.0f;
  }
}

void Multigrid::restrict_to(std::size_t coarse) {
  const std::vector<float>& fine = vectors_[coarse + 1].residual;
  std::vector<float>& right = vectors_[coarse].right;
  const std::size_t size = hierarchy_.sizes[coarse], fine_size = hierarchy_.sizes[coarse + 1];
  std::copy_n(fine.begin(), 3 * size, right.begin());
  for (std::size_t place = size; place < fine_size; ++place) {
    for (const std::uint32_t parent : hierarchy_.parents[place - hierarchy_.sizes[0]]) {
      for (std::size_t i = 0; i < 3; ++i) {
        right[3 * std::size_t{parent} + i] += 0.5f * fine[3 * place + i];
      }
    }
  }
  clear_fixed(coarse, right);
}

void Multigrid::prolongate_from(std::size_t coarse) {
  const std::vector<float>& x = vectors_[coarse].x;
  std::vector<float>& fine = vectors_[coarse + 1].x;
  const std::size_t size = hierarchy_.sizes[coarse], fine_size = hierarchy_.sizes[coarse + 1];
  for (std::size_t i = 0; i < 3 * size; ++i) fine[i] += x[i];
  for (std::size_t place = size; place < fine_size; ++place) {
    const Edge& ends = hierarchy_.parents[place - hierarchy_.sizes[0]];
    for (std::size_t i = 0; i < 3; ++i) {
      fine[3 * place + i] +=
          0.5f * (x[3 * std::size_t{ends[0]} + i] + x[3 * std::size_t{ends[1]} + i]);
    }
  }
  clear_fixed(coarse + 1, fine);
}

std::size_t Multigrid::bytes() const {
  std::size_t sum = coarsest_matrix_.bytes() + fixed_.size() + touched_.size() +
                    fixed_coordinates_.capacity() * sizeof(std::uint32_t);
  for (const Level& level : levels_) {
    sum += level.matrix.bytes() +
           (level.first_target.capacity() + level.targets.capacity()) * sizeof(std::uint32_t);
  }
  for (const Vectors& vectors : vectors_) sum += 3 * vectors.x.size() * sizeof(float);
  return sum;
}

}  // namespace tissue
