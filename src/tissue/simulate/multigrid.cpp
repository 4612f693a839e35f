#include "tissue/simulate/multigrid.h"

#include "block_rows.h"
#include "node_hierarchy.h"

#include <algorithm>
#include <array>

namespace tissue {
namespace {

// What is not found within so many iterations is left to others.
constexpr int kMaxIterations = 500;

// The coarsest level is factorised anew when iterations are so many times, and so many, more than
// with a new factorisation.
constexpr double kWornFactor = 1.5;
constexpr int kWornMore = 3;

// A level and how it is made from the next finer one.
struct Level {
  BlockRows matrix;
  // For each of this level's blocks the blocks of the next coarser one that it adds a half or a
  // quarter to, from first_target[block] on.
  std::vector<std::uint32_t> first_target;
  std::vector<std::uint32_t> targets;
  std::vector<float> right, x, residual;
};

class Multigrid : public LinearSolver {
 public:
  Multigrid(NodeHierarchy hierarchy, const BlockMatrix& pattern, double tolerance)
      : hierarchy_(std::move(hierarchy)), tolerance_(tolerance) {
    std::vector<std::vector<std::uint32_t>> rows(hierarchy_.node_at.size());
    pattern.for_each_block([&](std::uint32_t row, std::uint32_t column, const Mat3&) {
      const std::uint32_t a = hierarchy_.place_of[row], b = hierarchy_.place_of[column];
      rows[a].push_back(b);
      rows[b].push_back(a);
    });
    const std::size_t level_count = hierarchy_.sizes.size();
    levels_.resize(level_count);
    for (std::size_t l = level_count; l-- > 0;) {
      const std::uint32_t size = hierarchy_.sizes[l];
      levels_[l].matrix = BlockRows(size, std::move(rows));
      for (auto* vector : {&levels_[l].right, &levels_[l].x, &levels_[l].residual}) {
        vector->assign(3 * std::size_t{size} + 1, 0.0f);
      }
      rows = l > 0 ? rows_below(l) : std::vector<std::vector<std::uint32_t>>();
    }
    for (std::size_t l = 1; l < level_count; ++l) find_targets(l);
    coarsest_matrix_ = pattern_of(levels_[0].matrix);
    pattern.for_each_block([&](std::uint32_t row, std::uint32_t column, const Mat3&) {
      const std::uint32_t a = hierarchy_.place_of[row], b = hierarchy_.place_of[column];
      slots_.push_back({levels_.back().matrix.find(a, b), levels_.back().matrix.find(b, a)});
    });
  }

  const char* name() const override { return "multigrid"; }

  bool prepare(const BlockMatrix& matrix, const std::vector<std::uint8_t>& fixed,
               double shift) override {
    fixed_.resize(fixed.size());
    for (std::size_t place = 0; place < hierarchy_.node_at.size(); ++place) {
      std::copy_n(&fixed[3 * std::size_t{hierarchy_.node_at[place]}], 3, &fixed_[3 * place]);
    }
    take(matrix);
    for (std::size_t l = levels_.size(); l-- > 0;) {
      levels_[l].matrix.clear_fixed(fixed_);
      if (l > 0) make_coarser(l);
    }
    for (Level& level : levels_) {
      if (!level.matrix.finish(static_cast<float>(shift))) return false;
    }
    return factorise_coarsest();
  }

  bool solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) override {
    const std::size_t count = hierarchy_.node_at.size();
    const auto size = static_cast<Eigen::Index>(3 * count);
    Eigen::VectorXd residual(size);
    for (std::size_t i = 0; i < 3 * count; ++i) {
      const std::size_t from = 3 * std::size_t{hierarchy_.node_at[i / 3]} + i % 3;
      residual[static_cast<Eigen::Index>(i)] =
          fixed_[i] != 0 ? 0.0 : b[static_cast<Eigen::Index>(from)];
    }
    Eigen::VectorXd found = Eigen::VectorXd::Zero(size);
    const Eigen::VectorXd right = residual;
    int iterations = conjugate_gradients(residual, found);
    if (iterations < 0 && !is_fresh_) {
      is_worn_ = true;
      if (!factorise_coarsest()) return false;
      residual = right;
      found.setZero();
      iterations = conjugate_gradients(residual, found);
    }
    if (iterations < 0) return false;
    if (is_fresh_) fresh_iterations_ = iterations;
    is_worn_ = iterations > kWornFactor * fresh_iterations_ + kWornMore;
    x.resize(size);
    for (std::size_t i = 0; i < 3 * count; ++i) {
      const std::size_t to = 3 * std::size_t{hierarchy_.node_at[i / 3]} + i % 3;
      x[static_cast<Eigen::Index>(to)] = found[static_cast<Eigen::Index>(i)];
    }
    return true;
  }

 private:
  static BlockMatrix pattern_of(const BlockRows& matrix) {
    std::vector<std::uint32_t> pairs;
    for (std::uint32_t row = 0; row < matrix.row_count(); ++row) {
      for (std::uint32_t k = matrix.begin(row); k <= matrix.diagonal(row); ++k) {
        pairs.insert(pairs.end(), {row, matrix.column(k)});
      }
    }
    return {matrix.row_count(), pairs, 2};
  }

  std::size_t coarse_size(std::size_t l) const { return hierarchy_.sizes[l - 1]; }

  // A node's parents on the next coarser level: itself if it is there already.
  Edge ancestors(std::size_t l, std::uint32_t place) const {
    if (place < coarse_size(l)) return {place, place};
    return hierarchy_.parents[place - hierarchy_.sizes[0]];
  }

  // Which nodes of the next coarser level are coupled through those of level l.
  std::vector<std::vector<std::uint32_t>> rows_below(std::size_t l) const {
    std::vector<std::vector<std::uint32_t>> rows(coarse_size(l));
    const BlockRows& matrix = levels_[l].matrix;
    for (std::uint32_t row = 0; row < matrix.row_count(); ++row) {
      for (std::uint32_t k = matrix.begin(row); k < matrix.end(row); ++k) {
        for (const std::uint32_t a : ancestors(l, row)) {
          for (const std::uint32_t b : ancestors(l, matrix.column(k))) rows[a].push_back(b);
        }
      }
    }
    for (std::vector<std::uint32_t>& row : rows) {
      std::sort(row.begin(), row.end());
      row.erase(std::unique(row.begin(), row.end()), row.end());
    }
    return rows;
  }

  void find_targets(std::size_t l) {
    Level& level = levels_[l];
    const BlockRows& matrix = level.matrix;
    const BlockRows& coarser = levels_[l - 1].matrix;
    level.first_target.push_back(0);
    for (std::uint32_t row = 0; row < matrix.row_count(); ++row) {
      const Edge from = ancestors(l, row);
      for (std::uint32_t k = matrix.begin(row); k < matrix.end(row); ++k) {
        const Edge to = ancestors(l, matrix.column(k));
        const int row_count = from[0] == from[1] ? 1 : 2, column_count = to[0] == to[1] ? 1 : 2;
        for (int i = 0; i < row_count; ++i) {
          for (int j = 0; j < column_count; ++j) {
            level.targets.push_back(coarser.find(from[i], to[j]));
          }
        }
        level.first_target.push_back(static_cast<std::uint32_t>(level.targets.size()));
      }
    }
  }

  void take(const BlockMatrix& matrix) {
    BlockRows& finest = levels_.back().matrix;
    std::size_t next = 0;
    matrix.for_each_block([&](std::uint32_t, std::uint32_t, const Mat3& block) {
      const auto [here, across] = slots_[next++];
      Eigen::Map<Eigen::Matrix3f>(finest.block(here)) = block.cast<float>();
      Eigen::Map<Eigen::Matrix3f>(finest.block(across)) = block.transpose().cast<float>();
    });
  }

  // Galerkin's matrix Pᵀ A P of the next coarser level.
  void make_coarser(std::size_t l) {
    const Level& level = levels_[l];
    BlockRows& coarser = levels_[l - 1].matrix;
    coarser.set_zero();
    for (std::uint32_t k = 0; k < level.matrix.block_count(); ++k) {
      const std::uint32_t begin = level.first_target[k], end = level.first_target[k + 1];
      const float share = 1.0f / static_cast<float>(end - begin);
      const float* from = level.matrix.block(k);
      for (std::uint32_t t = begin; t < end; ++t) {
        float* to = coarser.block(level.targets[t]);
        for (int i = 0; i < 9; ++i) to[i] += share * from[i];
      }
    }
  }

  // The coarsest level's factorisation is kept while it serves: it is what changes least and costs
  // most.
  bool factorise_coarsest() {
    const BlockRows& matrix = levels_[0].matrix;
    const std::vector<std::uint8_t> fixed(fixed_.begin(),
                                          fixed_.begin() + 3 * std::ptrdiff_t{hierarchy_.sizes[0]});
    if (!is_worn_ && fixed == coarsest_fixed_) {
      is_fresh_ = false;
      return true;
    }
    coarsest_matrix_.set_zero();
    for (std::uint32_t row = 0; row < matrix.row_count(); ++row) {
      for (std::uint32_t k = matrix.begin(row); k <= matrix.diagonal(row); ++k) {
        const Eigen::Map<const Eigen::Matrix3f> block(matrix.block(k));
        coarsest_matrix_.add(row, matrix.column(k), block.cast<double>());
      }
    }
    is_worn_ = !coarsest_->prepare(coarsest_matrix_, fixed, 0.0);
    is_fresh_ = true;
    coarsest_fixed_ = fixed;
    return !is_worn_;
  }

  // x = M⁻¹ right on a level, by one V-cycle.
  void cycle(std::size_t l) {
    Level& level = levels_[l];
    const auto size = static_cast<Eigen::Index>(3 * level.matrix.row_count());
    if (l == 0) {
      Eigen::VectorXd x;
      coarsest_->solve(Eigen::Map<const Eigen::VectorXf>(level.right.data(), size).cast<double>(),
                       x);
      Eigen::Map<Eigen::VectorXf>(level.x.data(), size) = x.cast<float>();
      return;
    }
    level.matrix.sweep_from_zero(level.right.data(), level.x.data());
    level.matrix.residual_after_sweep(level.x.data(), level.residual.data());
    restrict_to(l - 1);
    cycle(l - 1);
    prolongate_from(l - 1);
    level.matrix.sweep_back(level.right.data(), level.x.data());
  }

  void restrict_to(std::size_t coarse) {
    const std::vector<float>& fine = levels_[coarse + 1].residual;
    std::vector<float>& right = levels_[coarse].right;
    const std::size_t size = hierarchy_.sizes[coarse], fine_size = hierarchy_.sizes[coarse + 1];
    std::copy_n(fine.begin(), 3 * size, right.begin());
    for (std::size_t place = size; place < fine_size; ++place) {
      for (const std::uint32_t parent : hierarchy_.parents[place - hierarchy_.sizes[0]]) {
        for (std::size_t i = 0; i < 3; ++i) {
          right[3 * std::size_t{parent} + i] += 0.5f * fine[3 * place + i];
        }
      }
    }
    for (std::size_t i = 0; i < 3 * size; ++i) {
      if (fixed_[i] != 0) right[i] = 0.0f;
    }
  }

  void prolongate_from(std::size_t coarse) {
    const std::vector<float>& x = levels_[coarse].x;
    std::vector<float>& fine = levels_[coarse + 1].x;
    const std::size_t size = hierarchy_.sizes[coarse], fine_size = hierarchy_.sizes[coarse + 1];
    for (std::size_t i = 0; i < 3 * size; ++i) fine[i] += x[i];
    for (std::size_t place = size; place < fine_size; ++place) {
      const Edge& ends = hierarchy_.parents[place - hierarchy_.sizes[0]];
      for (std::size_t i = 0; i < 3; ++i) {
        if (fixed_[3 * place + i] != 0) continue;
        fine[3 * place + i] +=
            0.5f * (x[3 * std::size_t{ends[0]} + i] + x[3 * std::size_t{ends[1]} + i]);
      }
    }
  }

  // z = M⁻¹ r, scaled so that single precision neither overflows nor vanishes.
  void precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) {
    Level& finest = levels_.back();
    const double scale = r.norm();
    Eigen::Map<Eigen::VectorXf>(finest.right.data(), r.size()) = (r / scale).cast<float>();
    cycle(levels_.size() - 1);
    z = scale * Eigen::Map<const Eigen::VectorXf>(finest.x.data(), r.size()).cast<double>();
  }

  // `residual` holds b at the start and b − A x, from x itself, at the end. The number of
  // iterations, or −1 where they did not lead there.
  int conjugate_gradients(Eigen::VectorXd& residual, Eigen::VectorXd& x) {
    const BlockRows& matrix = levels_.back().matrix;
    const Eigen::VectorXd right = residual;
    const double wanted = tolerance_ * residual.norm();
    Eigen::VectorXd direction = Eigen::VectorXd::Zero(x.size()), z(x.size()), product(x.size());
    double before = 0.0;
    for (int i = 0; i < kMaxIterations; ++i) {
      if (residual.norm() <= wanted) {
        // What was summed up step by step must also be true.
        matrix.multiply(x.data(), product.data());
        residual = right - product;
        if (residual.norm() <= wanted) return i;
        before = 0.0;
      }
      precondition(residual, z);
      const double now = residual.dot(z);
      if (!(now > 0.0)) return -1;
      direction = before > 0.0 ? Eigen::VectorXd(z + now / before * direction) : z;
      before = now;
      matrix.multiply(direction.data(), product.data());
      const double curvature = direction.dot(product);
      if (!(curvature > 0.0)) return -1;
      x += now / curvature * direction;
      residual -= now / curvature * product;
    }
    return -1;
  }

  NodeHierarchy hierarchy_;
  double tolerance_;
  // The coarsest first.
  std::vector<Level> levels_;
  // Where each block of the lower triangle goes, and its transpose.
  std::vector<std::array<std::uint32_t, 2>> slots_;
  // By place, three flags each.
  std::vector<std::uint8_t> fixed_;
  std::unique_ptr<LinearSolver> coarsest_ = direct_solver();
  BlockMatrix coarsest_matrix_;
  std::vector<std::uint8_t> coarsest_fixed_;
  // Whether that factorisation is of the matrix at hand; whether it is to be made anew.
  bool is_fresh_ = false, is_worn_ = true;
  int fresh_iterations_ = 0;
};

}  // namespace

std::unique_ptr<LinearSolver> multigrid_solver(const FiniteElements& elements, double tolerance) {
  NodeHierarchy hierarchy(elements);
  if (hierarchy.sizes.size() < 2) return nullptr;
  return std::make_unique<Multigrid>(std::move(hierarchy), elements.empty_matrix(), tolerance);
}

}  // namespace tissue
