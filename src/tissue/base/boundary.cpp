#include "tissue/base/boundary.h"

#include "tissue/base/disjoint_sets.h"

#include <algorithm>
#include <numeric>

namespace tissue {
namespace {

using Indices = std::vector<std::uint32_t>;

Triangle sorted(Triangle corners) {
  if (corners[0] > corners[1]) std::swap(corners[0], corners[1]);
  if (corners[1] > corners[2]) std::swap(corners[1], corners[2]);
  if (corners[0] > corners[1]) std::swap(corners[0], corners[1]);
  return corners;
}

// Turns counts into the places where buckets begin; one more at the end.
Indices bucket_starts(Indices counts) {
  std::exclusive_scan(counts.begin(), counts.end(), counts.begin(), 0u);
  return counts;
}

// A corner of a boundary triangle: its vertex's bucket holds the two others, in outward order.
struct Corner {
  std::uint32_t next, previous, triangle;
};

// True if the triangles make one closed fan: going from each to the one across its edge to
// `previous` meets all of them before the first comes again.
bool is_one_fan(const Corner* corners, std::uint32_t count) {
  std::uint32_t here = 0;
  for (std::uint32_t steps = 1; steps <= count; ++steps) {
    std::uint32_t across = 0;
    while (across < count && corners[across].next != corners[here].previous) ++across;
    if (across == count) return false;
    if (across == 0) return steps == count;
    here = across;
  }
  return false;
}

void describe_defect(std::uint32_t vertex, const Corner* corners, std::uint32_t count,
                     const std::vector<BoundaryTriangle>& boundary, Defects& defects) {
  defects.vertices.push_back(vertex);
  DisjointSets fans(count);
  std::map<std::uint32_t, Indices> at_edge;
  for (std::uint32_t i = 0; i < count; ++i) {
    at_edge[corners[i].next].push_back(i);
    at_edge[corners[i].previous].push_back(i);
  }
  for (const auto& [other, local] : at_edge) {
    for (const std::uint32_t i : local) fans.unite(local.front(), i);
    if (local.size() != 2 && vertex < other) defects.edges.push_back({vertex, other});
  }
  Indices sizes(count, 0);
  for (std::uint32_t i = 0; i < count; ++i) ++sizes[fans.find(i)];
  const auto largest =
      static_cast<std::uint32_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  for (std::uint32_t i = 0; i < count; ++i) {
    if (fans.find(i) == largest) continue;
    defects.tets_of_smaller_fans[vertex].push_back(boundary[corners[i].triangle].tet);
  }
}

}  // namespace

std::vector<BoundaryTriangle> boundary_triangles(const std::vector<Tet>& tets,
                                                 const std::vector<std::uint8_t>& kept,
                                                 const std::vector<std::uint8_t>& on_surface) {
  struct Face {
    std::uint32_t tet;
    Triangle corners;
  };
  std::vector<Face> candidates;
  for (std::uint32_t t = 0; t < tets.size(); ++t) {
    const Tet& tet = tets[t];
    if (!kept.empty() && kept[t] == 0) continue;
    const int inner =
        4 - on_surface[tet[0]] - on_surface[tet[1]] - on_surface[tet[2]] - on_surface[tet[3]];
    if (inner > 1) continue;
    for (int f = 0; f < 4; ++f) {
      if (inner == 1 && on_surface[tet[f]] != 0) continue;
      const auto& c = kOutwardFaces[f];
      candidates.push_back({t, {tet[c[0]], tet[c[1]], tet[c[2]]}});
    }
  }

  // One bucket for each lowest vertex; a face that comes a second time is no boundary.
  Indices counts(on_surface.size() + 1, 0);
  for (const Face& face : candidates) {
    ++counts[*std::min_element(face.corners.begin(), face.corners.end())];
  }
  Indices ends = bucket_starts(std::move(counts));
  struct Entry {
    std::uint32_t middle, high, candidate;
  };
  std::vector<Entry> entries(candidates.size());
  const Indices starts = ends;
  std::vector<std::uint8_t> met_again(candidates.size(), 0);
  for (std::uint32_t i = 0; i < candidates.size(); ++i) {
    const Triangle key = sorted(candidates[i].corners);
    std::uint32_t entry = starts[key[0]];
    const std::uint32_t end = ends[key[0]];
    while (entry < end && (entries[entry].middle != key[1] || entries[entry].high != key[2])) {
      ++entry;
    }
    if (entry == end) {
      entries[entry] = {key[1], key[2], i};
      ++ends[key[0]];
    } else {
      met_again[i] = met_again[entries[entry].candidate] = 1;
    }
  }
  std::vector<BoundaryTriangle> boundary;
  for (std::uint32_t i = 0; i < candidates.size(); ++i) {
    if (met_again[i] == 0) boundary.push_back({candidates[i].tet, candidates[i].corners});
  }
  return boundary;
}

Defects find_defects(const std::vector<BoundaryTriangle>& boundary, std::size_t vertex_count) {
  Indices counts(vertex_count + 1, 0);
  for (const BoundaryTriangle& triangle : boundary) {
    for (const std::uint32_t vertex : triangle.corners) ++counts[vertex];
  }
  const Indices starts = bucket_starts(std::move(counts));
  Indices ends = starts;
  std::vector<Corner> corners(boundary.size() * 3);
  for (std::uint32_t i = 0; i < boundary.size(); ++i) {
    const Triangle& c = boundary[i].corners;
    for (int k = 0; k < 3; ++k) corners[ends[c[k]]++] = {c[(k + 1) % 3], c[(k + 2) % 3], i};
  }
  Defects defects;
  for (std::uint32_t v = 0; v < vertex_count; ++v) {
    const std::uint32_t count = starts[v + 1] - starts[v];
    if (count == 0 || is_one_fan(&corners[starts[v]], count)) continue;
    describe_defect(v, &corners[starts[v]], count, boundary, defects);
  }
  return defects;
}

}  // namespace tissue
