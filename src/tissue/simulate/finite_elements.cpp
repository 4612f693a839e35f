#include "tissue/simulate/finite_elements.h"

#include "tissue/base/error.h"
#include "tissue/base/tet_mesh.h"
#include "tissue/base/topology.h"

namespace tissue {

const std::vector<QuadraturePoint>& tet_quadrature(int order) {
  static const std::vector<QuadraturePoint> centroid = {{{0.25, 0.25, 0.25, 0.25}, 1.0}};
  static const std::vector<QuadraturePoint> four = [] {
    const double near = (5.0 + 3.0 * std::sqrt(5.0)) / 20.0, far = (5.0 - std::sqrt(5.0)) / 20.0;
    std::vector<QuadraturePoint> points(4, {{far, far, far, far}, 0.25});
    for (std::size_t corner = 0; corner < 4; ++corner) points[corner].place[corner] = near;
    return points;
  }();
  return order == 1 ? centroid : four;
}

FiniteElements::FiniteElements(const Body& body, int order, const std::vector<Tet>& rigid)
    : order_(order), element_count_(body.tets.size()), parents_(body.parents) {
  if (order != 1 && order != 2) {
    throw InputError(ErrorCode::kParam,
                     "element_order: " + std::to_string(order) + " is neither 1 nor 2");
  }
  rest_.reserve(body.rest.size());
  for (const Vec3f& place : body.rest) rest_.push_back(place.cast<double>());
  constexpr std::size_t kWhole = kFloatLanes / kLanes;
  packs_.resize((element_count_ + kFloatLanes - 1) / kFloatLanes * kWhole);
  nodes_.reserve(4 * kLanes * packs_.size());
  for (std::size_t i = 0; i < kLanes * packs_.size(); ++i) {
    const Tet& tet = body.tets[std::min(i, element_count_ - 1)];
    nodes_.insert(nodes_.end(), tet.begin(), tet.end());
    Mat3 edges;
    for (int k = 0; k < 3; ++k) edges.col(k) = rest_[tet[k + 1]] - rest_[tet[0]];
    const Mat3 gradients = edges.inverse();
    Pack& pack = packs_[i / kLanes];
    for_entries([&](int k, int j) { pack.gradients[k][j][i % kLanes] = gradients(k, j); });
    pack.volumes[i % kLanes] = i < element_count_ ? edges.determinant() / 6.0 : 0.0;
  }
  if (!rigid.empty()) rigid_volumes_.assign(body.rest.size(), 0.0);
  for (const Tet& tet : rigid) {
    const double six = determinant(body.rest, tet);
    for (const std::uint32_t v : tet) rigid_volumes_[v] += six / 24.0;
  }
  if (order == 2) add_midpoints(body);
}

void FiniteElements::add_midpoints(const Body& body) {
  EdgeTopology topology = edge_topology(body.tets, body.rest.size());
  const auto vertices = static_cast<std::uint32_t>(rest_.size());
  nodes_.clear();
  nodes_.reserve(10 * kLanes * packs_.size());
  for (std::size_t i = 0; i < kLanes * packs_.size(); ++i) {
    const std::size_t t = std::min(i, element_count_ - 1);
    nodes_.insert(nodes_.end(), body.tets[t].begin(), body.tets[t].end());
    for (const std::uint32_t edge : topology.tet_edges[t]) nodes_.push_back(vertices + edge);
  }
  midpoints_ = std::move(topology.edges);
  rest_.reserve(rest_.size() + midpoints_.size());
  for (const Edge& ends : midpoints_) rest_.push_back(0.5 * (rest_[ends[0]] + rest_[ends[1]]));
}

void FiniteElements::gradients(std::size_t element, const QuadraturePoint& point,
                               Gradients& result) const {
  Eigen::Matrix<double, 4, 3> barycentric;
  barycentric.row(0).setZero();
  for_entries([&](int k, int j) {
    barycentric(k + 1, j) = packs_[element / kLanes].gradients[k][j][element % kLanes];
    barycentric(0, j) -= barycentric(k + 1, j);
  });
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

std::vector<NodeWeight> FiniteElements::shape_at(std::size_t element,
                                                 const std::array<double, 4>& barycentric) const {
  const std::uint32_t* const own = nodes(element);
  std::vector<NodeWeight> shape;
  for (std::size_t i = 0; i < 4; ++i) {
    const double at_corner = barycentric[i];
    shape.push_back({own[i], order_ == 1 ? at_corner : at_corner * (2.0 * at_corner - 1.0)});
  }
  if (order_ == 1) return shape;
  for (std::size_t e = 0; e < kTetEdges.size(); ++e) {
    const auto& [a, b] = kTetEdges[e];
    shape.push_back({own[4 + e], 4.0 * barycentric[a] * barycentric[b]});
  }
  return shape;
}

Eigen::VectorXd rest_positions(const FiniteElements& elements) {
  Eigen::VectorXd positions(static_cast<Eigen::Index>(3 * elements.node_count()));
  for (std::size_t node = 0; node < elements.node_count(); ++node) {
    positions.segment<3>(static_cast<Eigen::Index>(3 * node)) = elements.rest()[node];
  }
  return positions;
}

}  // namespace tissue
