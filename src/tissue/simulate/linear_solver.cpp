#include "tissue/simulate/linear_solver.h"

#include <Eigen/SparseCholesky>
#ifdef TISSUE_WITH_CHOLMOD
#include <Eigen/CholmodSupport>
#endif

namespace tissue {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

// The order of elimination is found once for a pattern: as long as the number of entries stays the
// same, so does the pattern.
template <class Decomposition>
class Direct : public LinearSolver {
 public:
  Direct() {
#ifdef TISSUE_WITH_CHOLMOD
    if constexpr (kIsCholmod) decomposition_.cholmod().print = 0;
#endif
  }

  bool factorise(const Matrix& lower) override {
    if (lower.nonZeros() != entries_ || lower.rows() != rows_) {
      decomposition_.analyzePattern(lower);
      entries_ = lower.nonZeros();
      rows_ = lower.rows();
    }
    decomposition_.factorize(lower);
    return decomposition_.info() == Eigen::Success && is_definite();
  }
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const override { return decomposition_.solve(b); }

 private:
  static constexpr bool kIsCholmod =
      !std::is_same_v<Decomposition, Eigen::SimplicialLDLT<Matrix, Eigen::Lower>>;

  bool is_definite() const {
    if constexpr (!kIsCholmod) {
      // Eigen reports success also for a body that nothing holds: its last pivots are rounding.
      constexpr double kLeastRatio = 1e-14;
      const auto pivots = decomposition_.vectorD();
      return pivots.size() == 0 || pivots.minCoeff() > kLeastRatio * pivots.maxCoeff();
    }
    return true;
  }

  Decomposition decomposition_;
  Eigen::Index entries_ = -1, rows_ = -1;
};

}  // namespace

std::unique_ptr<LinearSolver> eigen_solver() {
  return std::make_unique<Direct<Eigen::SimplicialLDLT<Matrix, Eigen::Lower>>>();
}

std::unique_ptr<LinearSolver> direct_solver() {
#ifdef TISSUE_WITH_CHOLMOD
  return std::make_unique<Direct<Eigen::CholmodSupernodalLLT<Matrix, Eigen::Lower>>>();
#else
  return eigen_solver();
#endif
}

}  // namespace tissue
