#include "tissue/field/surface_distance.h"

#include "tissue/base/parallel.h"

#include <cmath>

namespace tissue {
namespace {

// Distance to the first crossing of f from `place` along the unit vector `direction`, or more than
// `reach`.
template <class Function>
double crossing(const Function& f, const Vec3& place, double f_place, const Vec3& direction,
                double step, double reach) {
  Vec3 before = place;
  double f_before = f_place;
  for (double distance = step; distance < reach + step; distance += step) {
    const Vec3 here = place + distance * direction;
    const double f_here = f(here);
    if ((f_here < 0.0) != (f_before < 0.0)) {
      return distance - step + step * bracketed_root(f, before, here, f_before, f_here);
    }
    before = here;
    f_before = f_here;
  }
  return 2.0 * reach;
}

template <class Function>
double distance_to_surface(const Function& f, const Vec3& place, double step, double reach) {
  const double f_place = f(place);
  if (f_place == 0.0) return 0.0;
  Vec3 gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 offset = 0.25 * step * Vec3::Unit(axis);
    gradient[axis] = f(place + offset) - f(place - offset);
  }
  // Close by, one step of Newton's method is as good as a search.
  const double estimate = 0.5 * step * std::abs(f_place) / gradient.norm();
  if (estimate < 1e-3 * step) return estimate;
  double nearest = 2.0 * reach;
  if (gradient.norm() > 0.0) {
    const Vec3 downhill = (f_place > 0.0 ? -1.0 : 1.0) * gradient.normalized();
    nearest = crossing(f, place, f_place, downhill, 0.5 * step, reach);
  }
  if (nearest <= reach) return nearest;
  for (int direction = 0; direction < 27; ++direction) {
    const Vec3 step_to(direction % 3 - 1, direction / 3 % 3 - 1, direction / 9 - 1);
    if (step_to.isZero()) continue;
    nearest =
        std::min(nearest, crossing(f, place, f_place, step_to.normalized(), 0.5 * step, reach));
  }
  return std::min(nearest, reach);
}

}  // namespace

std::array<double, 2> surface_distance(const ImplicitSurface& surface,
                                       const std::vector<Vec3f>& vertices,
                                       const std::vector<Triangle>& boundary, double reach,
                                       int threads) {
  std::vector<std::uint8_t> on_boundary(vertices.size(), 0);
  for (const Triangle& triangle : boundary) {
    for (const std::uint32_t vertex : triangle) on_boundary[vertex] = 1;
  }
  std::vector<std::uint32_t> wanted;
  for (std::uint32_t v = 0; v < vertices.size(); ++v) {
    if (on_boundary[v] != 0) wanted.push_back(v);
  }
  if (wanted.empty()) return {0.0, 0.0};
  const double step = surface.field->grid.spacing.minCoeff();
  std::vector<float> distances(wanted.size());
  with_implicit_function(surface, [&](const auto& f) {
    parallel_ranges(wanted.size(), threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Vec3 place = vertices[wanted[i]].template cast<double>();
        distances[i] = static_cast<float>(distance_to_surface(f, place, step, reach));
      }
    });
  });
  double sum = 0.0, most = 0.0;
  for (const float distance : distances) {
    sum += static_cast<double>(distance);
    most = std::max(most, static_cast<double>(distance));
  }
  return {sum / static_cast<double>(wanted.size()), most};
}

}  // namespace tissue
