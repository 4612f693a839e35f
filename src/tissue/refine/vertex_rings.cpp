#include "vertex_rings.h"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace tissue {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

// Bytes as flags, because most tets touch none of the vertices and flags stay in the cache.
std::vector<std::uint32_t> tets_at(const std::vector<std::uint32_t>& vertices,
                                   const std::vector<Tet>& all_tets, std::size_t vertex_count) {
  std::vector<std::uint8_t> flags(vertex_count, 0);
  for (const std::uint32_t v : vertices) flags[v] = 1;
  std::vector<std::uint32_t> result;
  for (std::uint32_t t = 0; t < all_tets.size(); ++t) {
    const Tet& tet = all_tets[t];
    if ((flags[tet[0]] | flags[tet[1]] | flags[tet[2]] | flags[tet[3]]) != 0) result.push_back(t);
  }
  return result;
}

// Takes for each vertex in turn the lowest colour that no neighbour has.
std::vector<std::uint8_t> colours_of(const VertexRings& rings, const std::vector<Tet>& all_tets,
                                     const std::vector<std::uint32_t>& index) {
  constexpr std::uint8_t kUncoloured = 255;
  std::vector<std::uint8_t> colours(rings.vertices.size(), kUncoloured);
  for (std::size_t i = 0; i < rings.vertices.size(); ++i) {
    std::array<bool, 256> taken{};
    for (std::uint32_t k = rings.begin[i]; k < rings.begin[i + 1]; ++k) {
      for (const std::uint32_t v : all_tets[rings.tets[k]]) {
        if (index[v] < i) taken[colours[index[v]]] = true;
      }
    }
    const auto lowest = std::find(taken.begin(), taken.end(), false) - taken.begin();
    assert(lowest < kUncoloured && "angles of 8 degrees and more leave room for few neighbours");
    colours[i] = static_cast<std::uint8_t>(lowest);
  }
  return colours;
}

}  // namespace

VertexRings vertex_rings(std::vector<std::uint32_t> vertices, const std::vector<Tet>& all_tets,
                         std::size_t vertex_count, const Run& run) {
  VertexRings rings;
  rings.vertices = std::move(vertices);
  std::vector<std::uint32_t> index(vertex_count, kNone);
  for (std::uint32_t i = 0; i < rings.vertices.size(); ++i) index[rings.vertices[i]] = i;
  const std::vector<std::uint32_t> touched = tets_at(rings.vertices, all_tets, vertex_count);
  rings.begin.assign(rings.vertices.size() + 1, 0);
  for (const std::uint32_t t : touched) {
    for (const std::uint32_t v : all_tets[t]) {
      if (index[v] != kNone) ++rings.begin[index[v]];
    }
  }
  run.go_on();
  std::exclusive_scan(rings.begin.begin(), rings.begin.end(), rings.begin.begin(), 0u);
  rings.tets.resize(rings.begin.back());
  std::vector<std::uint32_t> next(rings.begin.begin(), rings.begin.end() - 1);
  for (const std::uint32_t t : touched) {
    for (const std::uint32_t v : all_tets[t]) {
      if (index[v] != kNone) rings.tets[next[index[v]]++] = t;
    }
  }
  run.go_on();
  const std::vector<std::uint8_t> colours = colours_of(rings, all_tets, index);
  for (std::uint32_t i = 0; i < colours.size(); ++i) {
    if (colours[i] >= rings.colours.size()) rings.colours.resize(colours[i] + 1u);
    rings.colours[colours[i]].push_back(i);
  }
  return rings;
}

}  // namespace tissue
