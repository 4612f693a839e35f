#pragma once

#include "tissue/simulate/block_matrix.h"
#include "tissue/simulate/body.h"

#include <vector>

namespace tissue {

/// A place inside an element at which its energy is summed up.
struct QuadraturePoint {
  /// Barycentric.
  std::array<double, 4> place;
  /// Fraction of the element's volume.
  double weight;
};

/// Straight-edged tets of order 1 (4 nodes) or 2 (10 nodes: the corners, then the midpoints of
/// kTetEdges). The first nodes are the body's vertices.
class FiniteElements {
 public:
  static constexpr int kMaxNodes = 10;

  /// Throws InputError E_PARAM if `order` is neither 1 nor 2.
  FiniteElements(const Body& body, int order);

  int order() const { return order_; }
  std::size_t element_count() const { return volumes_.size(); }
  std::size_t node_count() const { return rest_.size(); }
  int nodes_per_element() const { return order_ == 1 ? 4 : 10; }
  const std::uint32_t* nodes(std::size_t element) const {
    return &nodes_[element * static_cast<std::size_t>(nodes_per_element())];
  }
  /// At rest [m].
  const std::vector<Vec3>& rest() const { return rest_; }
  double volume(std::size_t element) const { return volumes_[element]; }
  /// For each node after the vertices the edge whose midpoint it is; empty for order 1.
  const std::vector<Edge>& midpoints() const { return midpoints_; }
  /// For each of the last nodes the two between which it lay half-way when it was made: parents of
  /// the body's vertices, then `midpoints`.
  const std::vector<Edge>& parents() const { return parents_; }

  /// The centroid for order 1; four points that integrate quadratics exactly for order 2.
  const std::vector<QuadraturePoint>& quadrature() const { return quadrature_; }
  /// Gradients of the shape functions of all nodes at a quadrature point [1/m], a row for each.
  using Gradients = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor, kMaxNodes, 3>;
  void gradients(std::size_t element, const QuadraturePoint& point, Gradients& result) const;

  /// By how much each node of an element weighs in an integral over it, as a fraction of the
  /// volume: 1/4 each for order 1; −1/20 at corners and 1/5 at midpoints for order 2.
  double node_weight(int local) const { return order_ == 1 ? 0.25 : local < 4 ? -0.05 : 0.2; }

  /// For each node the elements around it as numbers `element · nodes_per_element + local`,
  /// ascending, from incidence_begin()[node] on.
  const std::vector<std::size_t>& incidence_begin() const { return incidence_begin_; }
  const std::vector<std::uint64_t>& incidence() const { return incidence_; }

  /// A matrix of zeros with a block wherever two nodes share an element.
  BlockMatrix empty_matrix() const;

 private:
  void add_midpoints(const Body& body);
  void find_incidence();

  int order_;
  std::vector<QuadraturePoint> quadrature_;
  std::vector<Vec3> rest_;
  std::vector<std::uint32_t> nodes_;
  std::vector<Edge> midpoints_, parents_;
  // Gradients of the four barycentric coordinates, a row for each.
  std::vector<Eigen::Matrix<double, 4, 3, Eigen::RowMajor>> barycentric_gradients_;
  std::vector<double> volumes_;
  std::vector<std::size_t> incidence_begin_;
  std::vector<std::uint64_t> incidence_;
};

/// Positions of the nodes, three after three.
Eigen::VectorXd rest_positions(const FiniteElements& elements);

}  // namespace tissue
