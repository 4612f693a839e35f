#include "probe_points.h"

namespace tissue {
namespace {

// Four times the centroid's weight of each vertex: the volume of the dense tets around it.
std::map<std::uint32_t, double> weights_of(const DensityProbe& probe, const Body& body) {
  std::map<std::uint32_t, double> weights;
  double total = 0.0;
  for (std::size_t t = 0; t < body.tet_densities.size(); ++t) {
    if (!(body.tet_densities[t] > probe.above)) continue;
    const Tet& tet = body.tets[t];
    const double volume =
        determinant(body.rest[tet[0]], body.rest[tet[1]], body.rest[tet[2]], body.rest[tet[3]]);
    for (const std::uint32_t v : tet) weights[v] += 0.25 * volume;
    total += volume;
  }
  for (auto& [vertex, weight] : weights) weight /= total;
  return weights;
}

// Barycentric coordinates in the tet that holds the place.
std::map<std::uint32_t, double> weights_of(const Vec3& place, const Body& body) {
  constexpr double kSlack = 1e-9;
  for (const Tet& tet : body.tets) {
    Mat3 edges;
    const Vec3 origin = body.rest[tet[0]].cast<double>();
    for (int k = 0; k < 3; ++k) edges.col(k) = body.rest[tet[k + 1]].cast<double>() - origin;
    const Vec3 weights = edges.inverse() * (place - origin);
    if (weights.minCoeff() < -kSlack || weights.sum() > 1.0 + kSlack) continue;
    return {{tet[0], 1.0 - weights.sum()},
            {tet[1], weights[0]},
            {tet[2], weights[1]},
            {tet[3], weights[2]}};
  }
  return {};
}

}  // namespace

ProbePoints::ProbePoints(const std::map<std::string, Probe>& probes, const Body& body) {
  for (const auto& [name, probe] : probes) {
    std::vector<Weight>& weights = weights_[name];
    const auto found = std::visit([&](const auto& p) { return weights_of(p, body); }, probe);
    for (const auto& [vertex, weight] : found) weights.push_back({vertex, weight});
  }
}

std::map<std::string, std::optional<Vec3>> ProbePoints::places(const State& state) const {
  std::map<std::string, std::optional<Vec3>> result;
  for (const auto& [name, weights] : weights_) {
    std::optional<Vec3>& place = result[name];
    if (weights.empty()) continue;
    place = Vec3::Zero();
    for (const Weight& weight : weights) *place += weight.weight * state.positions[weight.vertex];
  }
  return result;
}

}  // namespace tissue
