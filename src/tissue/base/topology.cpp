#include "tissue/base/topology.h"

#include "tissue/base/error.h"

#include <algorithm>

namespace tissue {
namespace {

// One bucket for each lowest vertex holds what hangs on it. Buckets are short (a dozen entries) and
// lie in the order of the vertices, so a linear search in them beats any hash.
std::vector<std::uint32_t> bucket_starts(std::vector<std::uint32_t> counts) {
  std::uint32_t total = 0;
  for (std::uint32_t& count : counts) {
    const std::uint32_t start = total;
    total += count;
    count = start;
  }
  counts.push_back(total);
  return counts;
}

struct FaceEntry {
  std::uint32_t middle, high, face;
};

}  // namespace

FaceTopology face_topology(const std::vector<Tet>& tets, std::size_t vertex_count) {
  const auto sorted_face = [&](std::size_t t, int f) {
    Triangle key = {tets[t][kTetFaces[f][0]], tets[t][kTetFaces[f][1]], tets[t][kTetFaces[f][2]]};
    if (key[0] > key[1]) std::swap(key[0], key[1]);
    if (key[1] > key[2]) std::swap(key[1], key[2]);
    if (key[0] > key[1]) std::swap(key[0], key[1]);
    return key;
  };

  std::vector<std::uint32_t> counts(vertex_count, 0);
  for (std::size_t t = 0; t < tets.size(); ++t) {
    for (int f = 0; f < 4; ++f) ++counts[sorted_face(t, f)[0]];
  }
  const std::vector<std::uint32_t> starts = bucket_starts(std::move(counts));
  std::vector<std::uint32_t> ends(starts.begin(), starts.end() - 1);
  std::vector<FaceEntry> entries(tets.size() * 4);

  FaceTopology topology;
  topology.tet_faces.resize(tets.size());
  topology.face_tets.reserve(tets.size() * 2 + tets.size() / 8);
  for (std::size_t t = 0; t < tets.size(); ++t) {
    for (int f = 0; f < 4; ++f) {
      const Triangle key = sorted_face(t, f);
      std::uint32_t entry = starts[key[0]];
      const std::uint32_t end = ends[key[0]];
      while (entry < end && (entries[entry].middle != key[1] || entries[entry].high != key[2])) {
        ++entry;
      }
      if (entry == end) {
        entries[entry] = {key[1], key[2], static_cast<std::uint32_t>(topology.face_tets.size())};
        topology.face_tets.push_back({static_cast<std::uint32_t>(t), kNoTet});
        ++ends[key[0]];
      } else if (topology.face_tets[entries[entry].face][1] != kNoTet) {
        throw InputError(ErrorCode::kConformity,
                         "face_topology: tet " + std::to_string(t) + " is the third at face " +
                             std::to_string(key[0]) + " " + std::to_string(key[1]) + " " +
                             std::to_string(key[2]));
      } else {
        topology.face_tets[entries[entry].face][1] = static_cast<std::uint32_t>(t);
      }
      topology.tet_faces[t][f] = entries[entry].face;
    }
  }
  return topology;
}

EdgeTopology edge_topology(const std::vector<Tet>& tets, std::size_t vertex_count) {
  const auto sorted_edge = [&](std::size_t t, int e) {
    const std::uint32_t a = tets[t][kTetEdges[e][0]], b = tets[t][kTetEdges[e][1]];
    return a < b ? Edge{a, b} : Edge{b, a};
  };

  // An edge of the interior is named by five tets or so; the bucket is made for each naming, which
  // costs memory only while this function runs.
  std::vector<std::uint32_t> counts(vertex_count, 0);
  for (std::size_t t = 0; t < tets.size(); ++t) {
    for (int e = 0; e < 6; ++e) ++counts[sorted_edge(t, e)[0]];
  }
  const std::vector<std::uint32_t> starts = bucket_starts(std::move(counts));
  std::vector<std::uint32_t> ends(starts.begin(), starts.end() - 1);
  struct EdgeEntry {
    std::uint32_t high, edge;
  };
  std::vector<EdgeEntry> entries(starts.back());

  EdgeTopology topology;
  topology.tet_edges.resize(tets.size());
  topology.edges.reserve(tets.size() + tets.size() / 3);
  for (std::size_t t = 0; t < tets.size(); ++t) {
    for (int e = 0; e < 6; ++e) {
      const Edge key = sorted_edge(t, e);
      std::uint32_t entry = starts[key[0]];
      const std::uint32_t end = ends[key[0]];
      while (entry < end && entries[entry].high != key[1]) ++entry;
      if (entry == end) {
        entries[entry] = {key[1], static_cast<std::uint32_t>(topology.edges.size())};
        topology.edges.push_back(key);
        ++ends[key[0]];
      }
      topology.tet_edges[t][e] = entries[entry].edge;
    }
  }
  return topology;
}

std::vector<std::uint32_t> vertices_of(const std::vector<Triangle>& triangles,
                                       std::size_t vertex_count) {
  std::vector<std::uint8_t> used(vertex_count, 0);
  for (const Triangle& triangle : triangles) {
    for (const std::uint32_t vertex : triangle) used[vertex] = 1;
  }
  std::vector<std::uint32_t> result;
  for (std::uint32_t v = 0; v < vertex_count; ++v) {
    if (used[v] != 0) result.push_back(v);
  }
  return result;
}

}  // namespace tissue
