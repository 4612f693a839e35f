#include "node_hierarchy.h"

#include <algorithm>
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
  const std::size_t count = depths.size(), coarse = count - elements.parents().size();
  node_at.resize(count);
  std::iota(node_at.begin(), node_at.end(), 0u);
  std::stable_sort(node_at.begin(), node_at.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return depths[a] < depths[b]; });
  place_of.resize(count);
  for (std::uint32_t place = 0; place < count; ++place) place_of[node_at[place]] = place;
  for (std::uint32_t place = 0; place < count; ++place) {
    const std::uint32_t depth = depths[node_at[place]];
    if (sizes.size() <= depth) sizes.resize(depth + 1, place);
    sizes[depth] = place + 1;
    if (depth == 0) continue;
    const Edge& ends = elements.parents()[node_at[place] - coarse];
    parents.push_back({place_of[ends[0]], place_of[ends[1]]});
  }
}

}  // namespace tissue
