#include "tissue/simulate/finite_elements.h"

#include "tissue/base/error.h"
#include "tissue/base/topology.h"

#include <numeric>

namespace tissue {

FiniteElements::FiniteElements(const Body& body, int order) : order_(order) {
  if (order != 1 && order != 2) {
    throw InputError(ErrorCode::kParam,
                     "element_order: " + std::to_string(order) + " is neither 1 nor 2");
  }
  if (order == 1) {
    quadrature_ = {{{0.25, 0.25, 0.25, 0.25}, 1.0}};
  } else {
    // Keast (1986), degree 2.
    const double near = (5.0 + 3.0 * std::sqrt(5.0)) / 20.0, far = (5.0 - std::sqrt(5.0)) / 20.0;
    for (int corner = 0; corner < 4; ++corner) {
      QuadraturePoint point = {{far, far, far, far}, 0.25};
      point.place[corner] = near;
      quadrature_.push_back(point);
    }
  }
  rest_.reserve(body.rest.size());
  for (const Vec3f& place : body.rest) rest_.push_back(place.cast<double>());
  barycentric_gradients_.reserve(body.tets.size());
  volumes_.reserve(body.tets.size());
  for (const Tet& tet : body.tets) {
    Mat3 edges;
    for (int k = 0; k < 3; ++k) edges.col(k) = rest_[tet[k + 1]] - rest_[tet[0]];
    Eigen::Matrix<double, 4, 3, Eigen::RowMajor> gradients;
    gradients.bottomRows<3>() = edges.inverse();
    gradients.row(0) = -gradients.bottomRows<3>().colwise().sum();
    barycentric_gradients_.push_back(gradients);
    volumes_.push_back(edges.determinant() / 6.0);
    nodes_.insert(nodes_.end(), tet.begin(), tet.end());
  }
  parents_ = body.parents;
  if (order == 2) add_midpoints(body);
  find_incidence();
}

void FiniteElements::add_midpoints(const Body& body) {
  EdgeTopology topology = edge_topology(body.tets, body.rest.size());
  const auto vertices = static_cast<std::uint32_t>(rest_.size());
  nodes_.clear();
  nodes_.reserve(10 * body.tets.size());
  for (std::size_t t = 0; t < body.tets.size(); ++t) {
    nodes_.insert(nodes_.end(), body.tets[t].begin(), body.tets[t].end());
    for (const std::uint32_t edge : topology.tet_edges[t]) nodes_.push_back(vertices + edge);
  }
  midpoints_ = std::move(topology.edges);
  parents_.insert(parents_.end(), midpoints_.begin(), midpoints_.end());
  rest_.reserve(rest_.size() + midpoints_.size());
  for (const Edge& ends : midpoints_) rest_.push_back(0.5 * (rest_[ends[0]] + rest_[ends[1]]));
}

void FiniteElements::find_incidence() {
  incidence_begin_.assign(rest_.size() + 1, 0);
  for (const std::uint32_t node : nodes_) ++incidence_begin_[node];
  std::exclusive_scan(incidence_begin_.begin(), incidence_begin_.end(), incidence_begin_.begin(),
                      std::size_t{0});
  incidence_.resize(nodes_.size());
  std::vector<std::size_t> next(incidence_begin_.begin(), incidence_begin_.end() - 1);
  for (std::size_t i = 0; i < nodes_.size(); ++i) incidence_[next[nodes_[i]]++] = i;
}

void FiniteElements::gradients(std::size_t element, const QuadraturePoint& point,
                               Gradients& result) const {
  const auto& barycentric = barycentric_gradients_[element];
  if (order_ == 1) {
    result = barycentric;
    return;
  }
  result.resize(10, 3);
  for (int i = 0; i < 4; ++i) result.row(i) = (4.0 * point.place[i] - 1.0) * barycentric.row(i);
  for (int e = 0; e < 6; ++e) {
    const auto [i, j] = kTetEdges[e];
    result.row(4 + e) =
        4.0 * (point.place[i] * barycentric.row(j) + point.place[j] * barycentric.row(i));
  }
}

BlockMatrix FiniteElements::empty_matrix() const {
  return {node_count(), nodes_, nodes_per_element()};
}

Eigen::VectorXd rest_positions(const FiniteElements& elements) {
  Eigen::VectorXd positions(static_cast<Eigen::Index>(3 * elements.node_count()));
  for (std::size_t node = 0; node < elements.node_count(); ++node) {
    positions.segment<3>(static_cast<Eigen::Index>(3 * node)) = elements.rest()[node];
  }
  return positions;
}

}  // namespace tissue
