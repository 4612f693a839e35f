#include "tissue/simulate/quadratic_system.h"

#include "block_jacobi.h"
#include "conjugate_gradients.h"
#include "multigrid.h"
#include "pair_blocks.h"
#include "quadratic_operator.h"
#include "tissue/simulate/mass_matrix.h"
#include "vertex_hessian.h"

#include <algorithm>
#include <cmath>

namespace tissue {
namespace {

using Mat3f = Eigen::Matrix3f;

// Blocks that couple two nodes, besides what elements do.
struct Coupling {
  std::uint32_t a, b;
  Mat3f block;
};

class QuadraticSystem : public LinearSystem {
 public:
  QuadraticSystem(const FiniteElements& elements, Constitution constitution, double tolerance,
                  Run run)
      : elements_(elements),
        tolerance_(tolerance),
        operator_(quadratic_operator(elements, constitution)),
        hierarchy_(elements),
        vertices_(elements, hierarchy_.place_of, std::move(run)),
        multigrid_(hierarchy_, vertices_.rows()),
        diagonal_(elements.node_count(), Mat3f::Zero()) {}

  const char* name() const override { return "p-multigrid"; }

  void set_zero() override {
    operator_->set_zero();
    vertices_.set_zero();
    couplings_.clear();
    is_finished_ = false;
    diagonal_.assign(elements_.node_count(), Mat3f::Zero());
  }

  void add(std::uint32_t a, std::uint32_t b, const Mat3& block) override {
    couplings_.push_back({a, b, block.cast<float>()});
    // What is left of it where midpoints stay half-way between their ends.
    const Edge of_a = ends(a), of_b = ends(b);
    for (const std::uint32_t i : of_a) {
      for (const std::uint32_t j : of_b) {
        if (i == j) {
          vertices_.add(i, i,
                        a == b ? Mat3(0.25 * block) : Mat3(0.25 * (block + block.transpose())));
        } else if (a != b || i < j) {
          vertices_.add(i, j, 0.25 * block);
        }
      }
    }
  }

  void add_mass(const MassMatrix& mass, double factor) override {
    operator_->add_mass(factor * mass.density());
    vertices_.add_mass(mass, factor);
    for (std::uint32_t v = 0; v < elements_.rigid_volumes().size(); ++v) {
      const Mat3f block = static_cast<float>(factor * mass.rigid_at_vertex(v)) * Mat3f::Identity();
      couplings_.push_back({v, v, block});
    }
  }

  void add_elements(std::size_t first_pack, const std::vector<MaterialTensor>& tensors) override {
    operator_->add_elements(first_pack, tensors);
    vertices_.add_elements(first_pack, tensors);
    add_diagonal(first_pack, tensors);
  }

  void finish() override {
    if (is_finished_) return;
    is_finished_ = true;
    vertices_.finish();
    // In the proportions of the mass matrix's diagonal (Hinton, Rock, Zienkiewicz, 1976).
    lumped_.assign(elements_.node_count(), 0.0f);
    for (std::size_t e = 0; e < elements_.element_count(); ++e) {
      const double mass = operator_->mass() * elements_.volume(e);
      for (int a = 0; a < 10; ++a) {
        lumped_[elements_.nodes(e)[a]] +=
            static_cast<float>(mass * (a < 4 ? 1.0 / 36.0 : 4.0 / 27.0));
      }
    }
    for (std::size_t node = 0; node < lumped_.size(); ++node) {
      diagonal_[node].diagonal().array() += lumped_[node];
    }
    for (const Coupling& one : couplings_) {
      if (one.a == one.b) diagonal_[one.a] += one.block;
    }
  }

  void forget() override {
    jacobi_.forget();
    multigrid_.forget();
  }

  double largest_diagonal() const override {
    double largest = 0.0, sum = 0.0;
    for (const Mat3f& block : diagonal_) {
      largest = std::max(largest, static_cast<double>(block.diagonal().maxCoeff()));
      sum += block.sum();
    }
    return std::isfinite(sum) ? largest : sum;
  }

  void multiply_add(const Eigen::VectorXd& x, Eigen::VectorXd& result) const override {
    multiply_add(x.data(), result.data());
  }

  bool prepare(const std::vector<std::uint8_t>& fixed, double shift) override {
    fixed_.clear();
    for (std::uint32_t i = 0; i < fixed.size(); ++i) {
      if (fixed[i] != 0) fixed_.push_back(i);
    }
    if (shift != 0.0 || !jacobi_.prepare(diagonal_, fixed)) return false;
    const std::vector<std::uint8_t> of_vertices(
        fixed.begin(), fixed.begin() + static_cast<std::ptrdiff_t>(3 * elements_.vertex_count()));
    return multigrid_.prepare(of_vertices) &&
           jacobi_.find_longest_step([&](const Eigen::VectorXf& from) -> const Eigen::VectorXf& {
             return multiply_roughly(from);
           });
  }

  bool solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) override {
    Eigen::VectorXd right = b;
    clear_fixed(right);
    return multigrid_.retry([&] {
      return conjugate_gradients(
          right, tolerance_,
          [&](const Eigen::VectorXd& from, Eigen::VectorXd& product) {
            product.setZero();
            multiply_add(from.data(), product.data());
            clear_fixed(product);
          },
          [&](const Eigen::VectorXd& residual, Eigen::VectorXd& z) {
            precondition_free(residual, z);
          },
          x);
    });
  }

  bool precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) override {
    Eigen::VectorXd free = r;
    clear_fixed(free);
    precondition_free(free, z);
    return true;
  }

 private:
  // The blocks of nodes with themselves, from what the barycentric coordinates' gradients have with
  // each other.
  void add_diagonal(std::size_t first_pack, const std::vector<MaterialTensor>& tensors) {
    const std::vector<QuadraturePoint>& points = elements_.quadrature();
    for (std::size_t i = 0; i < tensors.size(); i += points.size()) {
      const std::size_t pack = first_pack + i / points.size();
      LaneMatrix<Lanes> own[10] = {};
      for (std::size_t q = 0; q < points.size(); ++q) {
        const CornerCouplings pairs(elements_.pack(pack).gradients, tensors[i + q]);
        const std::array<double, 4>& place = points[q].place;
        for (int a = 0; a < 4; ++a) {
          const double share = (4.0 * place[a] - 1.0) * (4.0 * place[a] - 1.0);
          for_entries([&](int r, int c) { own[a][r][c] += share * pairs.of[a][a][r][c]; });
        }
        for (int e = 0; e < 6; ++e) {
          const auto a = kTetEdges[e][0], b = kTetEdges[e][1];
          const double aa = 16.0 * place[b] * place[b], bb = 16.0 * place[a] * place[a],
                       ab = 16.0 * place[a] * place[b];
          for_entries([&](int r, int c) {
            own[4 + e][r][c] += aa * pairs.of[a][a][r][c] + bb * pairs.of[b][b][r][c] +
                                ab * (pairs.of[a][b][r][c] + pairs.of[a][b][c][r]);
          });
        }
      }
      for (std::size_t lane = 0; lane < elements_.lanes_in_use(pack); ++lane) {
        for (int a = 0; a < 10; ++a) {
          Mat3f& block = diagonal_[elements_.nodes(pack * kLanes + lane)[a]];
          for_entries([&](int r, int c) { block(r, c) += static_cast<float>(own[a][r][c][lane]); });
        }
      }
    }
  }

  Edge ends(std::uint32_t node) const {
    const std::size_t vertices = elements_.vertex_count();
    return node < vertices ? Edge{node, node} : elements_.midpoints()[node - vertices];
  }

  template <class Vector>
  void clear_fixed(Vector& vector) const {
    for (const std::uint32_t i : fixed_) vector[i] = 0;
  }

  template <class Scalar>
  void add_couplings(const Scalar* x, Scalar* result) const {
    using Vector = Eigen::Matrix<Scalar, 3, 1>;
    for (const Coupling& one : couplings_) {
      const std::size_t a = 3 * std::size_t{one.a}, b = 3 * std::size_t{one.b};
      const Eigen::Matrix<Scalar, 3, 3> block = one.block.template cast<Scalar>();
      Eigen::Map<Vector>(result + a) += block * Eigen::Map<const Vector>(x + b);
      if (a == b) continue;
      Eigen::Map<Vector>(result + b) += block.transpose() * Eigen::Map<const Vector>(x + a);
    }
  }

  void multiply_add(const double* x, double* result) const {
    operator_->multiply_add(x, result);
    add_couplings(x, result);
  }

  // A x, near enough to precondition with: mass is lumped.
  const Eigen::VectorXf& multiply_roughly(const Eigen::VectorXf& x) {
    product_.resize(x.size());
    for (std::size_t node = 0; node < lumped_.size(); ++node) {
      const auto i = static_cast<Eigen::Index>(3 * node);
      product_.segment<3>(i) = lumped_[node] * x.segment<3>(i);
    }
    operator_->add_stiffness(x.data(), product_.data());
    add_couplings(x.data(), product_.data());
    return product_;
  }

  // z = M⁻¹ r, scaled so that single precision neither overflows nor vanishes.
  void precondition_free(const Eigen::VectorXd& residual, Eigen::VectorXd& z) {
    const double scale = residual.norm();
    right_ = (residual / scale).cast<float>();
    x_.setZero(right_.size());
    jacobi_.smooth(right_, x_);
    set_residual();
    correct_by_vertices();
    set_residual();
    jacobi_.smooth(r_, x_);
    z = scale * x_.cast<double>();
  }

  void set_residual() {
    r_ = right_ - multiply_roughly(x_);
    clear_fixed(r_);
  }

  void correct_by_vertices() {
    const std::size_t count = elements_.vertex_count();
    std::vector<float>& right = multigrid_.right();
    const auto place = [&](std::uint32_t v) { return 3 * std::size_t{hierarchy_.place_of[v]}; };
    for (std::uint32_t v = 0; v < count; ++v) {
      for (std::size_t i = 0; i < 3; ++i) right[place(v) + i] = r_[3 * std::size_t{v} + i];
    }
    for (std::size_t m = 0; m < elements_.midpoints().size(); ++m) {
      for (const std::uint32_t end : elements_.midpoints()[m]) {
        for (std::size_t i = 0; i < 3; ++i) {
          right[place(end) + i] += 0.5f * r_[3 * (count + m) + i];
        }
      }
    }
    for (const std::uint32_t i : multigrid_.fixed()) right[i] = 0.0f;
    multigrid_.cycle();
    const std::vector<float>& found = multigrid_.x();
    for (std::uint32_t v = 0; v < count; ++v) {
      for (std::size_t i = 0; i < 3; ++i) x_[3 * std::size_t{v} + i] += found[place(v) + i];
    }
    for (std::size_t m = 0; m < elements_.midpoints().size(); ++m) {
      const auto [a, b] = elements_.midpoints()[m];
      for (std::size_t i = 0; i < 3; ++i) {
        x_[3 * (count + m) + i] += 0.5f * (found[place(a) + i] + found[place(b) + i]);
      }
    }
    clear_fixed(x_);
  }

  const FiniteElements& elements_;
  double tolerance_;
  std::unique_ptr<QuadraticOperator> operator_;
  NodeHierarchy hierarchy_;
  VertexHessian vertices_;
  Multigrid multigrid_;
  std::vector<Coupling> couplings_;
  std::vector<Mat3f> diagonal_;
  BlockJacobi jacobi_;
  std::vector<float> lumped_;
  std::vector<std::uint32_t> fixed_;
  Eigen::VectorXf right_, x_, r_, product_;
  bool is_finished_ = false;
};

}  // namespace

std::unique_ptr<LinearSystem> quadratic_system(const FiniteElements& elements,
                                               Constitution constitution, double tolerance,
                                               Run run) {
  if (elements.order() != 2) return nullptr;
  return std::make_unique<QuadraticSystem>(elements, constitution, tolerance, std::move(run));
}

}  // namespace tissue
