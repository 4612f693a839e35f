#pragma once

#include "tissue/base/types.h"

#include <vector>

namespace tissue {

/// Where the sections of the density's cumulative distribution end (Eq. 5).
struct LevelOptions {
  /// Number of sections N, at least 1. Each further one allows the softest tissue one more level.
  int sections = 3;
  /// Level of the densest section: 0 as in the paper's figures, 1 as in its Eq. 6.
  int base_level = 0;
  /// How often densities are averaged over neighbouring tets before the thresholds are taken. 0 is
  /// the paper to the letter; more makes levels jump less, and closure smaller.
  int smooth_levels = 2;
  /// Densities lie in [0, d_max].
  double d_max = 255.0;
};

/// T_i (Eq. 1): the mean of the densities of a tet's four vertices.
std::vector<double> tet_means(const std::vector<Tet>& tets, const std::vector<float>& densities);

/// Averages the tets' values to the vertices and back, `times` times.
std::vector<double> smoothed(std::vector<double> values, const std::vector<Tet>& tets,
                             std::size_t vertex_count, int times);

/// d_th(0) … d_th(N−1) (Eqs. 2 to 5): d_th(0) = 0 and d_th(n) is the smallest k with
/// CD(k) >= n·floor(nTinit/N), where CD(k) counts the tets with floor(T_i) <= k.
///
/// Throws InputError E_N if `sections` is below 1, E_PARAM if a density does not lie in [0, d_max].
std::vector<std::uint32_t> density_thresholds(const std::vector<double>& densities,
                                              const LevelOptions& options);

/// The number of different floor(T_i); all are at least 0.
std::size_t distinct_densities(const std::vector<double>& densities);

/// l = base_level + N − 1 − m with the largest m for which d_th(m) <= T_i (Eq. 6): the softer the
/// tissue, the higher.
std::vector<std::uint8_t> wished_levels(const std::vector<double>& densities,
                                        const std::vector<std::uint32_t>& thresholds,
                                        int base_level);

/// Densities to take levels from where interfaces are kept: a tet whose corners differ by more than
/// `jump` counts as dense as the softest of them, and any other as its mean says. So a tet that
/// straddles the border of a tumour takes the level of the tissue around it.
std::vector<double> softest_at_jumps(std::vector<double> means, const std::vector<Tet>& tets,
                                     const std::vector<float>& densities, double jump);

/// Levels that ignore density (Park and Choi): the finest for tets that touch the boundary,
/// `base_level` for all others; raise_levels() grades between them. `on_boundary` is set for
/// vertices of the boundary.
std::vector<std::uint8_t> surface_levels(const std::vector<Tet>& tets,
                                         const std::vector<std::uint8_t>& on_boundary,
                                         const LevelOptions& options);

/// Σ 8^level, at most 2^64 − 1.
std::uint64_t predicted_tets(const std::vector<std::uint8_t>& levels);

/// Raises levels until tets that share an edge differ by at most one, and no further than that
/// takes, so that the order of the tets does not matter. `tet_edges` names the six edges of each
/// tet among `edge_count`.
void raise_levels(std::vector<std::uint8_t>& levels,
                  const std::vector<std::array<std::uint32_t, 6>>& tet_edges,
                  std::size_t edge_count);

}  // namespace tissue
