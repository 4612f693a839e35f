#include "tissue/refine/levels.h"

#include "tissue/base/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tissue {

std::vector<double> tet_means(const std::vector<Tet>& tets, const std::vector<float>& densities) {
  std::vector<double> means(tets.size());
  for (std::size_t t = 0; t < tets.size(); ++t) {
    double sum = 0.0;
    for (const std::uint32_t vertex : tets[t]) sum += static_cast<double>(densities[vertex]);
    means[t] = sum / 4.0;
  }
  return means;
}

std::vector<double> smoothed(std::vector<double> values, const std::vector<Tet>& tets,
                             std::size_t vertex_count, int times) {
  if (times <= 0) return values;
  std::vector<double> tets_at_vertex(vertex_count, 0.0);
  for (const Tet& tet : tets) {
    for (const std::uint32_t vertex : tet) tets_at_vertex[vertex] += 1.0;
  }
  std::vector<double> at_vertex(vertex_count);
  for (int round = 0; round < times; ++round) {
    std::fill(at_vertex.begin(), at_vertex.end(), 0.0);
    for (std::size_t t = 0; t < tets.size(); ++t) {
      for (const std::uint32_t vertex : tets[t]) at_vertex[vertex] += values[t];
    }
    for (std::size_t v = 0; v < vertex_count; ++v) at_vertex[v] /= tets_at_vertex[v];
    for (std::size_t t = 0; t < tets.size(); ++t) {
      double sum = 0.0;
      for (const std::uint32_t vertex : tets[t]) sum += at_vertex[vertex];
      values[t] = sum / 4.0;
    }
  }
  return values;
}

std::vector<std::uint32_t> density_thresholds(const std::vector<double>& densities,
                                              const LevelOptions& options) {
  if (options.sections < 1) {
    throw InputError(ErrorCode::kN,
                     "level_sections: " + std::to_string(options.sections) + " is below 1");
  }
  const auto highest = static_cast<std::size_t>(std::floor(options.d_max));
  std::vector<std::uint64_t> counts(highest + 1, 0);
  for (const double density : densities) {
    if (!(density >= 0.0 && density <= options.d_max)) {
      throw InputError(ErrorCode::kParam, "density: " + to_text(density) + " is not within 0 to " +
                                              to_text(options.d_max));
    }
    ++counts[static_cast<std::size_t>(std::floor(density))];
  }
  const std::uint64_t section = densities.size() / static_cast<std::uint64_t>(options.sections);
  std::vector<std::uint32_t> thresholds(static_cast<std::size_t>(options.sections), 0);
  std::uint64_t cumulated = counts[0];
  std::size_t k = 0;
  for (std::size_t n = 1; n < thresholds.size(); ++n) {
    while (cumulated < n * section) cumulated += counts[++k];
    thresholds[n] = static_cast<std::uint32_t>(k);
  }
  return thresholds;
}

std::size_t distinct_densities(const std::vector<double>& densities) {
  std::vector<std::uint8_t> seen;
  for (const double density : densities) {
    const auto whole = static_cast<std::size_t>(std::floor(density));
    if (whole >= seen.size()) seen.resize(whole + 1, 0);
    seen[whole] = 1;
  }
  return static_cast<std::size_t>(std::count(seen.begin(), seen.end(), 1));
}

std::vector<std::uint8_t> wished_levels(const std::vector<double>& densities,
                                        const std::vector<std::uint32_t>& thresholds,
                                        int base_level) {
  const int finest = base_level + static_cast<int>(thresholds.size()) - 1;
  if (base_level < 0 || finest > std::numeric_limits<std::uint8_t>::max()) {
    throw InputError(ErrorCode::kN, "base_level: " + std::to_string(base_level) + " with " +
                                        std::to_string(thresholds.size()) +
                                        " sections leaves the levels 0 to 255");
  }
  std::vector<std::uint8_t> levels(densities.size());
  for (std::size_t t = 0; t < densities.size(); ++t) {
    const auto above = std::upper_bound(thresholds.begin(), thresholds.end(), densities[t],
                                        [](double density, std::uint32_t threshold) {
                                          return density < static_cast<double>(threshold);
                                        });
    const int m = static_cast<int>(above - thresholds.begin()) - 1;
    levels[t] = static_cast<std::uint8_t>(finest - m);
  }
  return levels;
}

std::vector<double> softest_at_jumps(std::vector<double> means, const std::vector<Tet>& tets,
                                     const std::vector<float>& densities, double jump) {
  for (std::size_t t = 0; t < tets.size(); ++t) {
    float softest = densities[tets[t][0]], hardest = softest;
    for (const std::uint32_t vertex : tets[t]) {
      softest = std::min(softest, densities[vertex]);
      hardest = std::max(hardest, densities[vertex]);
    }
    if (static_cast<double>(hardest) - static_cast<double>(softest) > jump) {
      means[t] = static_cast<double>(softest);
    }
  }
  return means;
}

std::vector<std::uint8_t> surface_levels(const std::vector<Tet>& tets,
                                         const std::vector<std::uint8_t>& on_boundary,
                                         const LevelOptions& options) {
  std::vector<std::uint8_t> levels;
  levels.reserve(tets.size());
  for (const Tet& tet : tets) {
    const bool at_boundary = on_boundary[tet[0]] != 0 || on_boundary[tet[1]] != 0 ||
                             on_boundary[tet[2]] != 0 || on_boundary[tet[3]] != 0;
    levels.push_back(
        static_cast<std::uint8_t>(options.base_level + (at_boundary ? options.sections - 1 : 0)));
  }
  return levels;
}

std::uint64_t predicted_tets(const std::vector<std::uint8_t>& levels) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
  std::array<std::uint64_t, 256> counts{};
  for (const std::uint8_t level : levels) ++counts[level];
  std::uint64_t total = 0;
  for (std::size_t level = 0; level < counts.size(); ++level) {
    if (counts[level] == 0) continue;
    if (level >= 21) return kMost;
    const std::uint64_t each = std::uint64_t{1} << (3 * level);
    if (counts[level] > (kMost - total) / each) return kMost;
    total += counts[level] * each;
  }
  return total;
}

void raise_levels(std::vector<std::uint8_t>& levels,
                  const std::vector<std::array<std::uint32_t, 6>>& tet_edges,
                  std::size_t edge_count) {
  if (levels.empty()) return;
  const int finest = *std::max_element(levels.begin(), levels.end());
  std::vector<std::uint8_t> marked(edge_count);
  // From the finest down: what one pass raises to level − 1 is what the next pass grades around, so
  // each level needs one pass and no queue.
  for (int level = finest; level > 1; --level) {
    std::fill(marked.begin(), marked.end(), 0);
    for (std::size_t t = 0; t < levels.size(); ++t) {
      if (levels[t] != level) continue;
      for (const std::uint32_t edge : tet_edges[t]) marked[edge] = 1;
    }
    for (std::size_t t = 0; t < levels.size(); ++t) {
      if (levels[t] >= level - 1) continue;
      for (const std::uint32_t edge : tet_edges[t]) {
        if (marked[edge] != 0) levels[t] = static_cast<std::uint8_t>(level - 1);
      }
    }
  }
}

}  // namespace tissue
