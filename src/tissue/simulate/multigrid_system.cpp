#include "tissue/simulate/multigrid_system.h"

#include "conjugate_gradients.h"
#include "multigrid.h"
#include "vertex_hessian.h"

namespace tissue {
namespace {

class MultigridSystem : public LinearSystem {
 public:
  MultigridSystem(const FiniteElements& elements, NodeHierarchy hierarchy, double tolerance,
                  Run run)
      : hierarchy_(std::move(hierarchy)),
        hessian_(elements, hierarchy_.place_of, std::move(run)),
        multigrid_(hierarchy_, hessian_.rows()),
        tolerance_(tolerance) {}

  const char* name() const override { return "multigrid"; }
  void set_zero() override { hessian_.set_zero(); }
  void add(std::uint32_t a, std::uint32_t b, const Mat3& block) override {
    hessian_.add(a, b, block);
  }
  void add_mass(const MassMatrix& mass, double factor) override { hessian_.add_mass(mass, factor); }
  void add_elements(std::size_t first_pack, const std::vector<MaterialTensor>& tensors) override {
    hessian_.add_elements(first_pack, tensors);
  }
  void finish() override { hessian_.finish(); }
  void forget() override { multigrid_.forget(); }
  double largest_diagonal() const override { return hessian_.largest_diagonal(); }

  void multiply_add(const Eigen::VectorXd& x, Eigen::VectorXd& result) const override {
    Eigen::VectorXd there(x.size()), product(x.size());
    to_places(x, there);
    multiply(there, product);
    for (std::size_t place = 0; place < hierarchy_.node_at.size(); ++place) {
      result.segment<3>(3 * Eigen::Index{hierarchy_.node_at[place]}) +=
          product.segment<3>(static_cast<Eigen::Index>(3 * place));
    }
  }

  bool prepare(const std::vector<std::uint8_t>& fixed, double shift) override {
    return shift == 0.0 && multigrid_.prepare(fixed);
  }

  bool solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) override {
    Eigen::VectorXd right(b.size()), found;
    to_places(b, right);
    clear_fixed(right);
    const bool found_it = multigrid_.retry([&] {
      return conjugate_gradients(
          right, tolerance_,
          [&](const Eigen::VectorXd& from, Eigen::VectorXd& product) {
            multiply(from, product);
            clear_fixed(product);
          },
          [&](const Eigen::VectorXd& residual, Eigen::VectorXd& z) {
            precondition_places(residual, z);
          },
          found);
    });
    if (found_it) from_places(found, x);
    return found_it;
  }

  bool precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) override {
    Eigen::VectorXd there(r.size()), found;
    to_places(r, there);
    clear_fixed(there);
    precondition_places(there, found);
    from_places(found, z);
    return true;
  }

 private:
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& product) const {
    hessian_.rows().multiply(x.data(), product.data());
  }

  void to_places(const Eigen::VectorXd& x, Eigen::VectorXd& there) const {
    for (std::size_t place = 0; place < hierarchy_.node_at.size(); ++place) {
      there.segment<3>(static_cast<Eigen::Index>(3 * place)) =
          x.segment<3>(3 * Eigen::Index{hierarchy_.node_at[place]});
    }
  }

  void from_places(const Eigen::VectorXd& there, Eigen::VectorXd& x) const {
    x.resize(there.size());
    for (std::size_t place = 0; place < hierarchy_.node_at.size(); ++place) {
      x.segment<3>(3 * Eigen::Index{hierarchy_.node_at[place]}) =
          there.segment<3>(static_cast<Eigen::Index>(3 * place));
    }
  }

  void clear_fixed(Eigen::VectorXd& vector) const {
    for (const std::uint32_t i : multigrid_.fixed()) vector[i] = 0.0;
  }

  // z = M⁻¹ r, scaled so that single precision neither overflows nor vanishes.
  void precondition_places(const Eigen::VectorXd& r, Eigen::VectorXd& z) {
    const double scale = r.norm();
    Eigen::Map<Eigen::VectorXf>(multigrid_.right().data(), r.size()) = (r / scale).cast<float>();
    multigrid_.cycle();
    z = scale * Eigen::Map<const Eigen::VectorXf>(multigrid_.x().data(), r.size()).cast<double>();
  }

  NodeHierarchy hierarchy_;
  VertexHessian hessian_;
  Multigrid multigrid_;
  double tolerance_;
};

}  // namespace

std::unique_ptr<LinearSystem> multigrid_system(const FiniteElements& elements, double tolerance,
                                               Run run) {
  NodeHierarchy hierarchy(elements);
  if (elements.order() != 1 || hierarchy.steps.empty()) return nullptr;
  return std::make_unique<MultigridSystem>(elements, std::move(hierarchy), tolerance,
                                           std::move(run));
}

}  // namespace tissue
