#include "tissue/simulate/linear_solver.h"

#include "tissue/base/machine_memory.h"

#include <Eigen/SparseCholesky>
#ifdef TISSUE_WITH_CHOLMOD
#include <Eigen/CholmodSupport>
#endif

#include <mutex>
#include <new>

namespace tissue {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

// OpenBLAS without threads, which keeps the bits, has buffers that all callers in a process share:
// called from two threads at once it finds wrong numbers.
std::mutex blas_mutex;

// A body that nothing holds is not noticed by a factorisation alone: its last pivots are rounding.
constexpr double kLeastPivot = 1e-12;

struct Simplicial : Eigen::SimplicialLDLT<Matrix, Eigen::Lower> {
  static constexpr const char* kName = "ldlt";
  // The smallest pivot by the largest.
  double least_pivot() const {
    return vectorD().size() == 0 ? 1.0 : vectorD().minCoeff() / vectorD().maxCoeff();
  }
  void require_memory() {}
};

#ifdef TISSUE_WITH_CHOLMOD
struct Supernodal : Eigen::CholmodSupernodalLLT<Matrix, Eigen::Lower> {
  static constexpr const char* kName = "cholmod";
  Supernodal() { cholmod().print = 0; }
  double least_pivot() { return cholmod_rcond(m_cholmodFactor, &cholmod()); }
  // OpenBLAS, where it gets no memory for its buffers, asks again for ever.
  void require_memory() {
    constexpr double kBuffers = 256e6;
    const double factor = sizeof(double) * cholmod().lnz;
    if (factor + kBuffers > static_cast<double>(available_memory())) throw std::bad_alloc();
  }
};
#endif

// The order of elimination is found once for a pattern, which a matrix's blocks and what is fixed
// in it decide.
template <class Decomposition>
class Direct : public LinearSolver {
 public:
  const char* name() const override { return Decomposition::kName; }

  bool prepare(const BlockMatrix& matrix, const std::vector<std::uint8_t>& fixed,
               double shift) override {
    number_.clear();
    free_count_ = 0;
    for (const std::uint8_t one : fixed) number_.push_back(one != 0 ? -1 : free_count_++);
    if (free_count_ == 0) return true;
    Matrix lower = matrix.lower_triangle(number_, free_count_);
    if (shift > 0.0) lower.diagonal().array() += shift;
    if (fixed != fixed_ || lower.nonZeros() != entries_) {
      decomposition_.analyzePattern(lower);
      decomposition_.require_memory();
      entries_ = lower.nonZeros();
      fixed_ = fixed;
    }
    const std::lock_guard<std::mutex> lock(blas_mutex);
    decomposition_.factorize(lower);
    return decomposition_.info() == Eigen::Success && decomposition_.least_pivot() > kLeastPivot;
  }

  bool solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) override {
    x.setZero(b.size());
    if (free_count_ == 0) return true;
    Eigen::VectorXd free(free_count_);
    for (std::size_t i = 0; i < number_.size(); ++i) {
      if (number_[i] >= 0) free[number_[i]] = b[static_cast<Eigen::Index>(i)];
    }
    const Eigen::VectorXd found = [&]() -> Eigen::VectorXd {
      const std::lock_guard<std::mutex> lock(blas_mutex);
      return decomposition_.solve(free);
    }();
    for (std::size_t i = 0; i < number_.size(); ++i) {
      if (number_[i] >= 0) x[static_cast<Eigen::Index>(i)] = found[number_[i]];
    }
    return x.allFinite();
  }

 private:
  Decomposition decomposition_;
  // For each coordinate its number among the free ones, or −1.
  std::vector<int> number_;
  int free_count_ = 0;
  std::vector<std::uint8_t> fixed_;
  Eigen::Index entries_ = -1;
};

}  // namespace

std::unique_ptr<LinearSolver> eigen_solver() { return std::make_unique<Direct<Simplicial>>(); }

std::unique_ptr<LinearSolver> direct_solver() {
#ifdef TISSUE_WITH_CHOLMOD
  return std::make_unique<Direct<Supernodal>>();
#else
  return eigen_solver();
#endif
}

}  // namespace tissue
