#pragma once

#include "tissue/simulate/finite_elements.h"
#include "tissue/simulate/hessian.h"

#include <Eigen/Core>

namespace tissue {

/// Of a Hessian only what it does to a vector.
class HessianProduct : public Hessian {
 public:
  /// References must outlive this.
  HessianProduct(const FiniteElements& elements, const Eigen::VectorXd& x)
      : elements_(elements), x_(x), result_(Eigen::VectorXd::Zero(x.size())) {}

  const Eigen::VectorXd& result() const { return result_; }

  void add(std::uint32_t a, std::uint32_t b, const Mat3& block) override;
  void add_mass(const MassMatrix& mass, double factor) override;
  void add_elements(std::size_t first_pack, const std::vector<MaterialTensor>& tensors) override;
  void add_squares(const SquareSum& squares) override { squares.multiply_add(x_, result_); }

 private:
  template <int order>
  void add_elements_of_order(std::size_t first_pack, const std::vector<MaterialTensor>& tensors);

  const FiniteElements& elements_;
  const Eigen::VectorXd& x_;
  Eigen::VectorXd result_;
};

/// A multiple of what is added goes to another Hessian.
class ScaledHessian : public Hessian {
 public:
  /// The reference must outlive this.
  ScaledHessian(Hessian& to, double factor) : to_(to), factor_(factor) {}
  void add(std::uint32_t a, std::uint32_t b, const Mat3& block) override {
    to_.add(a, b, factor_ * block);
  }
  void add_mass(const MassMatrix& mass, double factor) override {
    to_.add_mass(mass, factor_ * factor);
  }
  void add_elements(std::size_t first_pack, const std::vector<MaterialTensor>& tensors) override;

 private:
  Hessian& to_;
  double factor_;
};

}  // namespace tissue
