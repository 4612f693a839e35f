#pragma once

#include "tissue/simulate/body.h"
#include "tissue/simulate/push_options.h"

#include <algorithm>
#include <cmath>

namespace tissue {

/// By how much of the tool's displacement each vertex moves.
template <class Scalar>
struct PushField {
  std::vector<std::uint32_t> vertices;
  /// f_att(d) · r(ρ); in literal mode f_att(d) / (2ρ), to be multiplied by t² [s²].
  std::vector<Scalar> weights;
};

/// The median of the densities within R of the target.
template <class Scalar>
Scalar median_density(const std::vector<std::uint32_t>& vertices,
                      const std::vector<Scalar>& densities) {
  if (vertices.empty()) return Scalar(1);
  std::vector<Scalar> values;
  values.reserve(vertices.size());
  for (const std::uint32_t vertex : vertices) values.push_back(densities[vertex]);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Eq. 8 with the density's response: r = min(1, ρ_ref/ρ), and 1 at the target itself, so that the
/// target meets the tool. A density that is not positive counts as the softest.
template <class Scalar>
PushField<Scalar> push_field(const std::vector<Eigen::Matrix<Scalar, 3, 1>>& rest,
                             const std::vector<Scalar>& densities, std::uint32_t target,
                             const PushOptions& options) {
  PushField<Scalar> field;
  const auto range = static_cast<Scalar>(options.range);
  for (std::uint32_t v = 0; v < rest.size(); ++v) {
    const Scalar distance = (rest[v] - rest[target]).norm();
    if (!(distance < range)) continue;
    field.vertices.push_back(v);
    field.weights.push_back((range - distance) / range);
  }
  if (options.literal) {
    for (std::size_t i = 0; i < field.vertices.size(); ++i) {
      const Scalar density = options.density_response ? densities[field.vertices[i]] : Scalar(0.5);
      field.weights[i] /= 2 * density;
    }
  } else if (options.density_response) {
    const Scalar reference = options.reference_density > 0.0
                                 ? static_cast<Scalar>(options.reference_density)
                                 : median_density(field.vertices, densities);
    for (std::size_t i = 0; i < field.vertices.size(); ++i) {
      const Scalar density = densities[field.vertices[i]];
      if (field.vertices[i] == target || !(density > reference)) continue;
      field.weights[i] *= std::max(reference / density, Scalar(0));
    }
  }
  return field;
}

/// Eq. 7: v_b = v_a + weight · displacement for the field's vertices; the others stay at rest.
template <class Scalar>
void displace(const std::vector<Eigen::Matrix<Scalar, 3, 1>>& rest, const PushField<Scalar>& field,
              const Eigen::Matrix<Scalar, 3, 1>& displacement, std::vector<Vec3>& positions) {
  for (std::size_t i = 0; i < field.vertices.size(); ++i) {
    const std::uint32_t vertex = field.vertices[i];
    const Eigen::Matrix<Scalar, 3, 1> moved = field.weights[i] * displacement;
    positions[vertex] = rest[vertex].template cast<double>() + moved.template cast<double>();
  }
}

}  // namespace tissue
