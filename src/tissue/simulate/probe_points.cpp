#include "probe_points.h"

#include "tissue/simulate/material_places.h"

#include <algorithm>

namespace tissue {
namespace {

// So far outside the tissue, in barycentric coordinates, a place still counts as inside.
constexpr double kSlack = 1e-9;

// The mean place of all tets that are dense, each by its volume.
std::vector<NodeWeight> weights_of(const DensityProbe& probe, const Body& body,
                                   const DeformationModel& model) {
  std::map<std::uint32_t, double> weights;
  double total = 0.0;
  for (std::uint32_t t = 0; t < body.tet_densities.size(); ++t) {
    if (!(body.tet_densities[t] > probe.above)) continue;
    const double volume = determinant(body.rest, body.tets[t]);
    for (const QuadraturePoint& point : tet_quadrature(2)) {
      for (const NodeWeight& of : model.shape_at({t, point.place})) {
        weights[of.node] += volume * point.weight * of.weight;
      }
    }
    total += volume;
  }
  std::vector<NodeWeight> result;
  for (const auto& [node, weight] : weights) result.push_back({node, weight / total});
  return result;
}

std::vector<NodeWeight> weights_of(const Vec3& place, const Body& body,
                                   const DeformationModel& model) {
  const TetPlace found = material_places(body, {place}).front();
  const auto lowest = std::min_element(found.barycentric.begin(), found.barycentric.end());
  if (*lowest < -kSlack) return {};
  return model.shape_at(found);
}

}  // namespace

ProbePoints::ProbePoints(const std::map<std::string, Probe>& probes, const Body& body,
                         const DeformationModel& model) {
  for (const auto& [name, probe] : probes) {
    weights_[name] = std::visit([&](const auto& p) { return weights_of(p, body, model); }, probe);
  }
}

std::map<std::string, std::optional<Vec3>> ProbePoints::places(
    const DeformationModel& model) const {
  std::map<std::string, std::optional<Vec3>> result;
  for (const auto& [name, weights] : weights_) {
    std::optional<Vec3>& place = result[name];
    if (!weights.empty()) place = model.mean_of(weights);
  }
  return result;
}

}  // namespace tissue
