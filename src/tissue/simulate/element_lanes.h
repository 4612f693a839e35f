#pragma once

#include "tissue/base/tet_shape.h"
#include "tissue/simulate/finite_elements.h"

#include <Eigen/Core>

#include <cstring>

namespace tissue {

/// Nodes of an element, by its order.
template <int order>
constexpr int kNodes = order == 1 ? 4 : 10;

/// What nodes have, three numbers each, for a pack of elements.
template <int order>
inline void gather(const FiniteElements& elements, std::size_t pack, const Eigen::VectorXd& x,
                   Lanes (&result)[kNodes<order>][3]) {
  constexpr int n = kNodes<order>;
  static_assert(kLanes == 4);
  const std::uint32_t* nodes = elements.nodes(kLanes * pack);
  for (int a = 0; a < n; ++a) {
    const double* at[kLanes];
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      at[lane] = x.data() + 3 * std::size_t{nodes[lane * n + static_cast<std::size_t>(a)]};
    }
    for (int i = 0; i < 3; ++i) result[a][i] = Lanes{at[0][i], at[1][i], at[2][i], at[3][i]};
  }
}

/// The reverse: adds up, element by element.
template <int order>
inline void scatter(const FiniteElements& elements, std::size_t pack,
                    const Lanes (&forces)[kNodes<order>][3], Eigen::VectorXd& result) {
  constexpr int n = kNodes<order>;
  const std::uint32_t* nodes = elements.nodes(kLanes * pack);
  for (std::size_t lane = 0; lane < elements.lanes_in_use(pack); ++lane) {
    for (int a = 0; a < n; ++a) {
      double* to = result.data() + 3 * std::size_t{nodes[lane * n + static_cast<std::size_t>(a)]};
      for (int i = 0; i < 3; ++i) to[i] += forces[a][i][lane];
    }
  }
}

/// The gradient at a quadrature point of what the nodes have: of positions, F.
template <int order, class L>
inline LaneMatrix<L> gradient_at(const QuadraturePoint& point, const LaneMatrix<L>& barycentric,
                                 const L (&nodes)[kNodes<order>][3]) {
  using Scalar = std::decay_t<decltype(L{}[0])>;
  // What multiplies the gradient of each barycentric coordinate; their sum is zero.
  L corner[4][3];
  for (int i = 0; i < 4; ++i) {
    for (int r = 0; r < 3; ++r) corner[i][r] = nodes[i][r];
  }
  if constexpr (order == 2) {
    for (int i = 0; i < 4; ++i) {
      for (int r = 0; r < 3; ++r) corner[i][r] *= static_cast<Scalar>(4.0 * point.place[i] - 1.0);
    }
    for (int e = 0; e < 6; ++e) {
      const auto [i, j] = kTetEdges[e];
      for (int r = 0; r < 3; ++r) {
        corner[i][r] += static_cast<Scalar>(4.0 * point.place[j]) * nodes[4 + e][r];
        corner[j][r] += static_cast<Scalar>(4.0 * point.place[i]) * nodes[4 + e][r];
      }
    }
  }
  LaneMatrix<L> differences;
  for_entries([&](int r, int k) { differences[r][k] = corner[k + 1][r] - corner[0][r]; });
  return product(differences, barycentric);
}

/// The transpose of that: forces on nodes by a stress, times weight and volume.
template <int order, class L>
inline void add_forces(const QuadraturePoint& point, const LaneMatrix<L>& barycentric,
                       const LaneMatrix<L>& stress, L (&forces)[kNodes<order>][3]) {
  using Scalar = std::decay_t<decltype(L{}[0])>;
  const LaneMatrix<L> pull = product_transpose(stress, barycentric);
  L corner[4][3];
  for (int r = 0; r < 3; ++r) {
    for (int k = 0; k < 3; ++k) corner[k + 1][r] = pull[r][k];
    corner[0][r] = -(pull[r][0] + pull[r][1] + pull[r][2]);
  }
  for (int i = 0; i < 4; ++i) {
    const auto share = static_cast<Scalar>(order == 1 ? 1.0 : 4.0 * point.place[i] - 1.0);
    for (int r = 0; r < 3; ++r) forces[i][r] += share * corner[i][r];
  }
  if constexpr (order == 2) {
    for (int e = 0; e < 6; ++e) {
      const auto [i, j] = kTetEdges[e];
      for (int r = 0; r < 3; ++r) {
        forces[4 + e][r] += static_cast<Scalar>(4.0 * point.place[j]) * corner[i][r] +
                            static_cast<Scalar>(4.0 * point.place[i]) * corner[j][r];
      }
    }
  }
}

/// Shape gradients of all nodes at a quadrature point.
template <int order, class L>
inline void shape_gradients(const QuadraturePoint& point, const LaneMatrix<L>& barycentric,
                            L (&result)[kNodes<order>][3]) {
  using Scalar = std::decay_t<decltype(L{}[0])>;
  L corner[4][3];
  for (int r = 0; r < 3; ++r) {
    for (int k = 0; k < 3; ++k) corner[k + 1][r] = barycentric[k][r];
    corner[0][r] = -(barycentric[0][r] + barycentric[1][r] + barycentric[2][r]);
  }
  for (int i = 0; i < 4; ++i) {
    const auto share = static_cast<Scalar>(order == 1 ? 1.0 : 4.0 * point.place[i] - 1.0);
    for (int r = 0; r < 3; ++r) result[i][r] = share * corner[i][r];
  }
  if constexpr (order == 2) {
    for (int e = 0; e < 6; ++e) {
      const auto [i, j] = kTetEdges[e];
      const auto share_i = static_cast<Scalar>(4.0 * point.place[i]);
      const auto share_j = static_cast<Scalar>(4.0 * point.place[j]);
      for (int r = 0; r < 3; ++r) {
        result[4 + e][r] = share_i * corner[j][r] + share_j * corner[i][r];
      }
    }
  }
}

/// Adds unit · (MassMatrix::quadratic_share) · x.
template <class L>
inline void add_quadratic_mass(const L (&x)[10][3], const L& unit, L (&result)[10][3]) {
  // Numbered as kTetEdges: opposite edges share no corner.
  constexpr int kOpposite[6] = {5, 4, 3, 2, 1, 0};
  for (int r = 0; r < 3; ++r) {
    L corners = {}, middles = {}, touching[4] = {};
    for (int i = 0; i < 4; ++i) corners += x[i][r];
    for (int e = 0; e < 6; ++e) {
      const auto [i, j] = kTetEdges[e];
      middles += x[4 + e][r];
      touching[i] += x[4 + e][r];
      touching[j] += x[4 + e][r];
    }
    for (int i = 0; i < 4; ++i) {
      result[i][r] += unit * (5 * x[i][r] + corners - 6 * middles + 2 * touching[i]);
    }
    for (int e = 0; e < 6; ++e) {
      const auto [i, j] = kTetEdges[e];
      result[4 + e][r] += unit * (16 * (middles + x[4 + e][r]) - 8 * x[4 + kOpposite[e]][r] -
                                  6 * corners + 2 * (x[i][r] + x[j][r]));
    }
  }
}

}  // namespace tissue
