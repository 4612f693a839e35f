#include "vertex_rings.h"

#include <algorithm>
#include <numeric>

namespace tissue {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

// Bytes as flags, because most tets touch none of the vertices and flags stay in the cache.
std::vector<std::uint32_t> tets_at(const std::vector<std::uint32_t>& vertices,
                                   const std::vector<Tet>& all_tets,
                                   const std::vector<TetRange>& where, std::size_t vertex_count) {
  std::vector<std::uint8_t> flags(vertex_count, 0);
  for (const std::uint32_t v : vertices) flags[v] = 1;
  std::vector<std::uint32_t> result;
  for (const TetRange& range : where) {
    for (std::size_t t = range.begin; t < range.end; ++t) {
      const Tet& tet = all_tets[t];
      if ((flags[tet[0]] | flags[tet[1]] | flags[tet[2]] | flags[tet[3]]) == 0) continue;
      result.push_back(static_cast<std::uint32_t>(t));
    }
  }
  return result;
}

// Blocks of vertices of equal size, and which of them share a tet.
class BlockGraph {
 public:
  explicit BlockGraph(std::size_t vertex_count)
      : block_size_(std::max(kMinBlock, (vertex_count + kMaxBlocks - 1) / kMaxBlocks)),
        vertex_count_(vertex_count),
        block_count_((vertex_count + block_size_ - 1) / block_size_),
        adjacent_(block_count_ * block_count_, 0) {}

  // Two vertices of one tet, by index.
  void join(std::uint32_t a, std::uint32_t b) {
    const std::size_t block_a = a / block_size_, block_b = b / block_size_;
    if (block_a == block_b) return;
    adjacent_[block_a * block_count_ + block_b] = 1;
    adjacent_[block_b * block_count_ + block_a] = 1;
  }

  // Takes for each block in turn the lowest colour that no neighbour has.
  std::vector<std::vector<VertexRings::Block>> coloured() const {
    std::vector<std::vector<VertexRings::Block>> result;
    std::vector<std::size_t> colours(block_count_);
    for (std::size_t block = 0; block < block_count_; ++block) {
      std::vector<bool> taken(result.size() + 1, false);
      for (std::size_t other = 0; other < block; ++other) {
        if (adjacent_[block * block_count_ + other] != 0) taken[colours[other]] = true;
      }
      const auto lowest = std::find(taken.begin(), taken.end(), false) - taken.begin();
      colours[block] = static_cast<std::size_t>(lowest);
      if (colours[block] == result.size()) result.emplace_back();
      result[colours[block]].push_back(
          {static_cast<std::uint32_t>(block * block_size_),
           static_cast<std::uint32_t>(std::min((block + 1) * block_size_, vertex_count_))});
    }
    return result;
  }

 private:
  static constexpr std::size_t kMinBlock = 128, kMaxBlocks = 2048;
  std::size_t block_size_, vertex_count_, block_count_;
  std::vector<std::uint8_t> adjacent_;
};

}  // namespace

VertexRings vertex_rings(std::vector<std::uint32_t> vertices, const std::vector<Tet>& all_tets,
                         const std::vector<TetRange>& where, std::size_t vertex_count,
                         const Run& run) {
  VertexRings rings;
  rings.vertices = std::move(vertices);
  std::vector<std::uint32_t> index(vertex_count, kNone);
  for (std::uint32_t i = 0; i < rings.vertices.size(); ++i) index[rings.vertices[i]] = i;
  const std::vector<std::uint32_t> touched = tets_at(rings.vertices, all_tets, where, vertex_count);
  rings.begin.assign(rings.vertices.size() + 1, 0);
  BlockGraph graph(rings.vertices.size());
  for (const std::uint32_t t : touched) {
    const Tet& tet = all_tets[t];
    for (int k = 0; k < 4; ++k) {
      const std::uint32_t i = index[tet[k]];
      if (i == kNone) continue;
      ++rings.begin[i];
      for (int other = 0; other < k; ++other) {
        if (index[tet[other]] != kNone) graph.join(i, index[tet[other]]);
      }
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
  rings.colours = graph.coloured();
  return rings;
}

}  // namespace tissue
