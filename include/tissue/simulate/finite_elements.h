#pragma once

#include "tissue/simulate/body.h"
#include "tissue/simulate/lanes.h"

#include <vector>

namespace tissue {

/// A place inside an element at which its energy is summed up.
struct QuadraturePoint {
  /// Barycentric.
  std::array<double, 4> place;
  /// Fraction of the element's volume.
  double weight;
};

/// The centroid for order 1; four points that integrate quadratics exactly for order 2 (Keast
/// 1986).
const std::vector<QuadraturePoint>& tet_quadrature(int order);

/// By how much of a node's value something consists of it.
struct NodeWeight {
  std::uint32_t node;
  double weight;
};

/// Straight-edged tets of order 1 (4 nodes) or 2 (10 nodes: the corners, then the midpoints of
/// kTetEdges). The first nodes are the body's vertices.
class FiniteElements {
 public:
  static constexpr int kMaxNodes = 10;

  /// Throws InputError E_PARAM if `order` is neither 1 nor 2.
  /// `rigid` tets have mass, which is shared by their vertices, and are no elements.
  FiniteElements(const Body& body, int order, const std::vector<Tet>& rigid = {});

  int order() const { return order_; }
  std::size_t element_count() const { return element_count_; }
  std::size_t node_count() const { return rest_.size(); }
  std::size_t vertex_count() const { return rest_.size() - midpoints_.size(); }
  int nodes_per_element() const { return order_ == 1 ? 4 : 10; }
  const std::uint32_t* nodes(std::size_t element) const {
    return &nodes_[element * static_cast<std::size_t>(nodes_per_element())];
  }
  /// At rest [m].
  const std::vector<Vec3>& rest() const { return rest_; }
  double volume(std::size_t element) const {
    return packs_[element / kLanes].volumes[element % kLanes];
  }
  /// For each node after the vertices the edge whose midpoint it is; empty for order 1.
  const std::vector<Edge>& midpoints() const { return midpoints_; }
  /// For each of the last vertices the two between which it lay half-way when it was made.
  const std::vector<Edge>& parents() const { return parents_; }

  const std::vector<QuadraturePoint>& quadrature() const { return tet_quadrature(order_); }
  /// Gradients of the shape functions of all nodes at a quadrature point [1/m], a row for each.
  using Gradients = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor, kMaxNodes, 3>;
  void gradients(std::size_t element, const QuadraturePoint& point, Gradients& result) const;

  /// The shape functions of an element's nodes at a place inside it.
  std::vector<NodeWeight> shape_at(std::size_t element,
                                   const std::array<double, 4>& barycentric) const;

  /// A quarter of the rigid tets around each vertex [m³]; empty without any.
  const std::vector<double>& rigid_volumes() const { return rigid_volumes_; }

  /// By how much each node of an element weighs in an integral over it, as a fraction of the
  /// volume: 1/4 each for order 1; −1/20 at corners and 1/5 at midpoints for order 2.
  double node_weight(int local) const { return order_ == 1 ? 0.25 : local < 4 ? -0.05 : 0.2; }

  /// Elements in the lanes of wide registers, in their order. Lanes behind the last element repeat
  /// it without volume; packs come by the pair, for what takes twice as many lanes.
  struct Pack {
    /// Gradients of the barycentric coordinates 1 to 3, a row for each [1/m].
    LaneMatrix<Lanes> gradients;
    /// [m³]
    Lanes volumes;
  };
  std::size_t pack_count() const { return packs_.size(); }
  const Pack& pack(std::size_t number) const { return packs_[number]; }
  /// How many of a pack's lanes are elements.
  std::size_t lanes_in_use(std::size_t pack) const {
    return std::min(kLanes, element_count_ - std::min(element_count_, pack * kLanes));
  }

 private:
  void add_midpoints(const Body& body);

  int order_;
  std::size_t element_count_;
  std::vector<Vec3> rest_;
  std::vector<std::uint32_t> nodes_;
  std::vector<Edge> midpoints_, parents_;
  std::vector<double> rigid_volumes_;
  std::vector<Pack> packs_;
};

/// Positions of the nodes, three after three.
Eigen::VectorXd rest_positions(const FiniteElements& elements);

}  // namespace tissue
