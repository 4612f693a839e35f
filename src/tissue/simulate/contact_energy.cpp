#include "contact_energy.h"

#include "closest_points.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

namespace tissue {
namespace {

// The pressure of tissue in which a tool is as deep as its radius, by Young's modulus. Hertz's
// pressure under a tool that is pressed in by a tenth of its radius is a quarter of the modulus:
// what is lost of that depth is some thousandths of it.
constexpr double kStiffness = 500.0;

std::vector<double> young_of_nodes(const FiniteElements& elements,
                                   const std::vector<double>& young) {
  std::vector<double> sums(elements.node_count(), 0.0), shares(elements.node_count(), 0.0);
  for (std::size_t e = 0; e < elements.element_count(); ++e) {
    for (int a = 0; a < elements.nodes_per_element(); ++a) {
      sums[elements.nodes(e)[a]] += elements.volume(e) * young[e];
      shares[elements.nodes(e)[a]] += elements.volume(e);
    }
  }
  // Rigid tissue has no elements; what touches it need not give way less than what is around it.
  const double mean = std::accumulate(sums.begin(), sums.end(), 0.0) /
                      std::accumulate(shares.begin(), shares.end(), 0.0);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    sums[i] = shares[i] > 0.0 ? sums[i] / shares[i] : mean;
  }
  return sums;
}

}  // namespace

ContactEnergy::ContactEnergy(const FiniteElements& elements, const Body& body,
                             const std::vector<double>& young, const std::vector<double>& radii)
    : surface_(elements, body) {
  for (const double radius : radii) tools_.push_back({radius});
  const std::vector<double> young_at = young_of_nodes(elements, young);
  std::map<Edge, Edges> edges;
  for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t) {
    const Triangle& corners = surface_.triangles[t];
    const double mean = (young_at[corners[0]] + young_at[corners[1]] + young_at[corners[2]]) / 3.0;
    triangle_stiffness_.push_back(kStiffness * mean * surface_.areas[t]);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(corners[k], corners[(k + 1) % 3]);
      const auto [found, is_new] = edges.try_emplace({low, high}, Edges{{low, high}, {t, t}, 0.0});
      if (!is_new) found->second.triangles[1] = t;
      found->second.stiffness += triangle_stiffness_.back() / 3.0;
    }
  }
  for (const auto& [ends, edge] : edges) edges_.push_back(edge);
}

void ContactEnergy::place(std::size_t tool, const std::optional<Capsule>& capsule) {
  tools_[tool].capsule = capsule;
  if (capsule) return;
  soften(tool);
  pairs_.erase(std::remove_if(pairs_.begin(), pairs_.end(),
                              [&](const Pair& pair) { return pair.tool == tool; }),
               pairs_.end());
}

ContactEnergy::Nearest ContactEnergy::nearest(const Pair& pair, const Eigen::VectorXd& positions,
                                              const Capsule& capsule) const {
  const Vec3 a = node_at(positions, pair.nodes[0]), b = node_at(positions, pair.nodes[1]);
  Nearest result;
  if (pair.part == Part::kAxis) {
    const AlongSegments along = closest_of_segments(capsule.tip, capsule.end, a, b);
    result.on_axis = capsule.tip + along.first * (capsule.end - capsule.tip);
    result.weights = {1.0 - along.second, along.second, 0.0};
    result.off = (1.0 - along.second) * a + along.second * b - result.on_axis;
  } else {
    const Vec3 c = node_at(positions, pair.nodes[2]);
    result.on_axis = pair.part == Part::kTip ? capsule.tip : capsule.end;
    result.weights = closest_in_triangle(result.on_axis, a, b, c);
    result.off =
        result.weights[0] * a + result.weights[1] * b + result.weights[2] * c - result.on_axis;
  }
  result.distance = result.off.norm();
  return result;
}

// How the weights change along the triangle or edge on which the nearest place lies [1/m]. Where a
// face turns under a large tool that place runs away and the tool enters farther, so faces resist
// turning: of the distance's second derivative this is what matters, and is positive.
std::array<Vec3, 3> ContactEnergy::weight_slopes(const Pair& pair, const Nearest& at,
                                                 const Eigen::VectorXd& positions) const {
  std::array<Vec3, 3> slopes = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  std::array<std::size_t, 3> used{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (at.weights[i] > 0.0) used[count++] = i;
  }
  const auto place = [&](std::size_t k) { return node_at(positions, pair.nodes[used[k]]); };
  if (count == 2) {
    const Vec3 edge = place(1) - place(0);
    slopes[used[1]] = edge / edge.squaredNorm();
    slopes[used[0]] = -slopes[used[1]];
  } else if (count == 3) {
    const Vec3 normal = (place(1) - place(0)).cross(place(2) - place(0));
    for (std::size_t k = 0; k < 3; ++k) {
      slopes[used[k]] =
          normal.cross(place((k + 2) % 3) - place((k + 1) % 3)) / normal.squaredNorm();
    }
  }
  return slopes;
}

void ContactEnergy::find_pairs(const Eigen::VectorXd& positions, double reach) {
  pairs_.clear();
  std::vector<std::uint8_t> near;
  for (std::uint32_t tool = 0; tool < tools_.size(); ++tool) {
    if (!tools_[tool].capsule) continue;
    const Capsule& capsule = *tools_[tool].capsule;
    const double within = capsule.radius + reach * tools_[tool].radius;
    const Vec3 low = capsule.tip.cwiseMin(capsule.end).array() - within,
               high = capsule.tip.cwiseMax(capsule.end).array() + within;
    near.assign(surface_.triangles.size(), 0);
    const auto add = [&](Part part, const std::array<std::uint32_t, 3>& nodes, double stiffness) {
      const Pair pair = {tool, part, nodes, stiffness};
      if (nearest(pair, positions).distance <= within) pairs_.push_back(pair);
    };
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      const Triangle& corners = surface_.triangles[t];
      const std::array<Vec3, 3> at = corners_of(corners, positions);
      // What lies behind the tissue is not to be pushed away from it.
      if ((at[0].cwiseMax(at[1]).cwiseMax(at[2]).array() < low.array()).any() ||
          (at[0].cwiseMin(at[1]).cwiseMin(at[2]).array() > high.array()).any() ||
          !faces(at, capsule)) {
        continue;
      }
      near[t] = 1;
      add(Part::kTip, corners, triangle_stiffness_[t]);
      if (!capsule.is_ball()) add(Part::kEnd, corners, triangle_stiffness_[t]);
    }
    if (capsule.is_ball()) continue;
    for (const Edges& edge : edges_) {
      if (near[edge.triangles[0]] == 0 && near[edge.triangles[1]] == 0) continue;
      add(Part::kAxis, {edge.nodes[0], edge.nodes[1], edge.nodes[1]}, edge.stiffness);
    }
  }
}

double ContactEnergy::depth(std::size_t tool, const Eigen::VectorXd& positions) const {
  double deepest = -std::numeric_limits<double>::infinity();
  for (const Pair& pair : pairs_) {
    if (pair.tool != tool) continue;
    deepest = std::max(deepest, tools_[tool].capsule->radius - nearest(pair, positions).distance);
  }
  return deepest;
}

double ContactEnergy::evaluate(const Eigen::VectorXd& positions, Eigen::VectorXd* gradient,
                               Hessian* hessian) const {
  double sum = 0.0;
  for (const Pair& pair : pairs_) {
    const Nearest at = nearest(pair, positions);
    const double deep = tools_[pair.tool].capsule->radius - at.distance;
    if (deep <= 0.0) continue;
    const double k = stiffness(pair);
    sum += 0.5 * k * deep * deep;
    if (gradient == nullptr && hessian == nullptr) continue;
    const Vec3 direction = at.direction();
    const Mat3 along = direction * direction.transpose();
    const std::array<Vec3, 3> slopes =
        hessian != nullptr ? weight_slopes(pair, at, positions) : std::array<Vec3, 3>{};
    for (std::size_t i = 0; i < 3; ++i) {
      const double weight = at.weights[i];
      if (weight == 0.0) continue;
      if (gradient != nullptr) {
        gradient->segment<3>(3 * Eigen::Index{pair.nodes[i]}) -= k * deep * weight * direction;
      }
      if (hessian == nullptr) continue;
      for (std::size_t j = 0; j <= i; ++j) {
        if (at.weights[j] == 0.0) continue;
        const double turning = deep * at.distance * slopes[i].dot(slopes[j]);
        hessian->add(pair.nodes[i], pair.nodes[j], k * (weight * at.weights[j] + turning) * along);
      }
    }
  }
  return sum;
}

// Both by differences: where a tool touches turns as it moves aside, and that matters more than how
// stiff the touch is.
template <class Add>
void ContactEnergy::for_each_change(std::size_t tool, const Eigen::VectorXd& positions,
                                    const Vec3& direction, const Eigen::VectorXd& response,
                                    const Add& add) const {
  constexpr double kPart = 1e-6;
  const Tool& one = tools_[tool];
  const double farthest = response.size() > 0 ? response.cwiseAbs().maxCoeff() : 0.0;
  const double step = kPart * one.radius / std::max(1.0, farthest);
  for (const double side : {-step, step}) {
    Capsule moved = *one.capsule;
    moved.tip += side * direction;
    moved.end += side * direction;
    const Eigen::VectorXd there =
        response.size() > 0 ? Eigen::VectorXd(positions + side * response) : positions;
    for (const Pair& pair : pairs_) {
      if (pair.tool != tool) continue;
      const Nearest at = nearest(pair, there, moved);
      const double deep = moved.radius - at.distance;
      // Of the tissue on the tool.
      if (deep > 0.0) add(pair, at, -stiffness(pair) * deep / (2.0 * side) * at.direction());
    }
  }
}

void ContactEnergy::add_pull(std::size_t tool, const Eigen::VectorXd& positions,
                             const Vec3& direction, Eigen::VectorXd& gradient) const {
  for_each_change(
      tool, positions, direction, {}, [&](const Pair& pair, const Nearest& at, const Vec3& change) {
        for (std::size_t i = 0; i < 3; ++i) {
          gradient.segment<3>(3 * Eigen::Index{pair.nodes[i]}) += at.weights[i] * change;
        }
      });
}

Vec3 ContactEnergy::force_change(std::size_t tool, const Eigen::VectorXd& positions,
                                 const Vec3& direction, const Eigen::VectorXd& response) const {
  Vec3 sum = Vec3::Zero();
  for_each_change(tool, positions, direction, response,
                  [&](const Pair&, const Nearest&, const Vec3& change) { sum += change; });
  return sum;
}

std::size_t ContactEnergy::bytes() const {
  return surface_.triangles.size() * (sizeof(Triangle) + 2 * sizeof(double)) +
         edges_.size() * sizeof(Edges) + pairs_.capacity() * sizeof(Pair);
}

}  // namespace tissue
