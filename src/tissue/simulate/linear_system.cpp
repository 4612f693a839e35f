#include "tissue/simulate/linear_system.h"

#include "tissue/simulate/assembled_hessian.h"
#include "tissue/simulate/linear_solver.h"

namespace tissue {
namespace {

class DirectSystem : public LinearSystem {
 public:
  DirectSystem(const FiniteElements& elements, std::unique_ptr<LinearSolver> solver)
      : hessian_(elements), solver_(std::move(solver)) {}

  const char* name() const override { return solver_->name(); }
  void set_zero() override { hessian_.matrix().set_zero(); }
  void add(std::uint32_t a, std::uint32_t b, const Mat3& block) override {
    hessian_.add(a, b, block);
  }
  void add_mass(const MassMatrix& mass, double factor) override { hessian_.add_mass(mass, factor); }
  void add_elements(std::size_t first_pack, const std::vector<MaterialTensor>& tensors) override {
    hessian_.add_elements(first_pack, tensors);
  }
  double largest_diagonal() const override { return hessian_.matrix().largest_diagonal(); }
  void multiply_add(const Eigen::VectorXd& x, Eigen::VectorXd& result) const override {
    hessian_.matrix().multiply_add(x, result);
  }
  bool prepare(const std::vector<std::uint8_t>& fixed, double shift) override {
    return solver_->prepare(hessian_.matrix(), fixed, shift);
  }
  bool solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) override { return solver_->solve(b, x); }
  bool precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) override {
    return solver_->solve(r, z);
  }

 private:
  AssembledHessian hessian_;
  std::unique_ptr<LinearSolver> solver_;
};

}  // namespace

std::unique_ptr<LinearSystem> direct_system(const FiniteElements& elements) {
  return std::make_unique<DirectSystem>(elements, direct_solver());
}

std::unique_ptr<LinearSystem> eigen_system(const FiniteElements& elements) {
  return std::make_unique<DirectSystem>(elements, eigen_solver());
}

}  // namespace tissue
