#include "node_hierarchy.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace tissue {
namespace {

// How often each node's ancestors were halved: 0 without parents, else one more than the higher of
// theirs. A node that is its own ancestor has none.
std::vector<std::uint32_t> depths_of(const FiniteElements& elements) {
  const std::size_t count = elements.vertex_count(), coarse = count - elements.parents().size();
  constexpr std::uint32_t kUnknown = 0xffffffffu;
  std::vector<std::uint32_t> depths(count, kUnknown);
  std::fill(depths.begin(), depths.begin() + static_cast<std::ptrdiff_t>(coarse), 0u);
  for (bool found = true; found;) {
    found = false;
    for (std::size_t i = 0; i < elements.parents().size(); ++i) {
      const auto [a, b] = elements.parents()[i];
      if (depths[coarse + i] != kUnknown || depths[a] == kUnknown || depths[b] == kUnknown)
        continue;
      depths[coarse + i] = 1 + std::max(depths[a], depths[b]);
      found = true;
    }
  }
  std::replace(depths.begin(), depths.end(), kUnknown, 0u);
  return depths;
}

}  // namespace

NodeHierarchy::NodeHierarchy(const FiniteElements& elements) {
  const std::vector<std::uint32_t> depths = depths_of(elements);
  const std::size_t count = depths.size(), first_child = count - elements.parents().size();
  node_at.resize(count);
  std::iota(node_at.begin(), node_at.end(), 0u);
  std::stable_sort(node_at.begin(), node_at.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return depths[a] < depths[b]; });
  place_of.resize(count);
  for (std::uint32_t place = 0; place < count; ++place) place_of[node_at[place]] = place;
  std::uint32_t coarsest = 0;
  while (coarsest < count && depths[node_at[coarsest]] == 0) ++coarsest;
  for (std::uint32_t place = coarsest; place < count; ++place) {
    const std::uint32_t depth = depths[node_at[place]];
    if (steps.size() < depth) {
      steps.emplace_back();
      steps.back().coarse_size = place;
    }
    Coarsening& step = steps.back();
    for (const std::uint32_t end : elements.parents()[node_at[place] - first_child]) {
      step.add(place_of[end], 0.5f);
    }
    step.end_node();
    step.fine_size = place + 1;
  }
  std::vector<Vec3> points;
  for (std::uint32_t place = 0; place < coarsest; ++place) {
    points.push_back(elements.rest()[node_at[place]]);
  }
  add_lattices(elements, std::move(points));
}

// Lattices of cubes, each split into six tets, in which points lie; the first has a node for about
// eight points, the next for eight nodes.
void NodeHierarchy::add_lattices(const FiniteElements& elements, std::vector<Vec3> points) {
  constexpr std::size_t kSmall = 400;
  double volume = 0.0;
  for (std::size_t e = 0; e < elements.element_count(); ++e) volume += elements.volume(e);
  double spacing = 2.0 * std::cbrt(volume / static_cast<double>(points.size()));
  while (points.size() > kSmall) {
    Coarsening step;
    step.nested = false;
    step.fine_size = static_cast<std::uint32_t>(points.size());
    std::map<std::array<int, 3>, std::uint32_t> numbers;
    std::vector<Vec3> nodes;
    for (const Vec3& point : points) {
      std::array<int, 3> cell, axes = {0, 1, 2};
      Vec3 within;
      for (int i = 0; i < 3; ++i) {
        const double at = point[i] / spacing;
        cell[i] = static_cast<int>(std::floor(at));
        within[i] = at - cell[i];
      }
      std::sort(axes.begin(), axes.end(), [&](int a, int b) { return within[a] > within[b]; });
      // Along the axes in this order from corner to corner of the tet that the point is in.
      double left = 1.0;
      for (int corner = 0; corner < 4; ++corner) {
        const double next = corner < 3 ? within[axes[corner]] : 0.0;
        if (left - next > 0.0) {
          const auto [found, is_new] =
              numbers.try_emplace(cell, static_cast<std::uint32_t>(nodes.size()));
          if (is_new) nodes.push_back(spacing * Vec3(cell[0], cell[1], cell[2]));
          step.add(found->second, static_cast<float>(left - next));
        }
        left = next;
        if (corner < 3) ++cell[axes[corner]];
      }
      step.end_node();
    }
    step.coarse_size = static_cast<std::uint32_t>(nodes.size());
    if (2 * nodes.size() > points.size()) {
      spacing *= 2.0;
      continue;
    }
    steps.insert(steps.begin(), std::move(step));
    points = std::move(nodes);
    spacing *= 2.0;
  }
}

}  // namespace tissue
