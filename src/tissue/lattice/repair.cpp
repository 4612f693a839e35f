#include "repair.h"

#include "tissue/base/disjoint_sets.h"
#include "tissue/base/topology.h"

#include <algorithm>
#include <map>
#include <utility>

namespace tissue {
namespace {

using Indices = std::vector<std::uint32_t>;

// Keeps the tets for which `kept` is set, in their order.
void keep_tets(LatticeMesh& mesh, const std::vector<std::uint8_t>& kept) {
  std::size_t next = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (kept[t] == 0) continue;
    mesh.tets[next] = mesh.tets[t];
    mesh.whole[next] = mesh.whole[t];
    ++next;
  }
  mesh.tets.resize(next);
  mesh.whole.resize(next);
}

bool keep_largest_component(LatticeMesh& mesh) {
  const FaceTopology faces = face_topology(mesh.tets, mesh.vertices.size());
  DisjointSets sets(mesh.tets.size());
  for (const auto& tets : faces.face_tets) {
    if (tets[1] != kNoTet) sets.unite(tets[0], tets[1]);
  }
  Indices sizes(mesh.tets.size(), 0);
  std::size_t components = 0;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) components += sizes[sets.find(t)]++ == 0;
  if (components <= 1) return false;
  const auto largest =
      static_cast<std::uint32_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  std::vector<std::uint8_t> kept(mesh.tets.size());
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) kept[t] = sets.find(t) == largest;
  keep_tets(mesh, kept);
  mesh.components_dropped += components - 1;
  return true;
}

// A corner of the boundary: triangle (tet, face) at one of its vertices, with the other two.
struct BoundaryCorner {
  std::uint32_t vertex, other, triangle;
  bool operator<(const BoundaryCorner& right) const {
    return std::tie(vertex, other, triangle) < std::tie(right.vertex, right.other, right.triangle);
  }
};

struct BoundaryTriangle {
  std::uint32_t tet;
  Triangle corners;
};

// The boundary where it is not a manifold.
struct Defects {
  // Vertices with more than one fan of boundary triangles or with an edge of more than two.
  Indices vertices;
  // For each such vertex, the tets at its smaller fans.
  std::map<std::uint32_t, Indices> tets_of_smaller_fans;
  // Edges in more than two boundary triangles.
  std::vector<Edge> edges;
};

std::vector<BoundaryTriangle> boundary_triangles(const LatticeMesh& mesh,
                                                 const FaceTopology& faces) {
  std::vector<BoundaryTriangle> boundary;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    for (int f = 0; f < 4; ++f) {
      if (faces.face_tets[faces.tet_faces[t][f]][1] != kNoTet) continue;
      const auto& corner = kTetFaces[f];
      boundary.push_back(
          {t, {mesh.tets[t][corner[0]], mesh.tets[t][corner[1]], mesh.tets[t][corner[2]]}});
    }
  }
  return boundary;
}

void inspect_vertex(const std::vector<BoundaryTriangle>& boundary,
                    const std::vector<BoundaryCorner>& corners, std::size_t begin, std::size_t end,
                    Defects& defects) {
  // Triangles at the vertex that share an edge there belong to one fan.
  std::map<std::uint32_t, std::uint32_t> local;
  for (std::size_t i = begin; i < end; ++i) {
    local.emplace(corners[i].triangle, static_cast<std::uint32_t>(local.size()));
  }
  DisjointSets fans(local.size());
  std::size_t fan_count = local.size();
  bool sound = true;
  for (std::size_t i = begin; i < end;) {
    std::size_t next = i;
    while (next < end && corners[next].other == corners[i].other) {
      fan_count -= fans.unite(local[corners[i].triangle], local[corners[next].triangle]) ? 1 : 0;
      ++next;
    }
    if (next - i != 2) {
      sound = false;
      if (corners[i].vertex < corners[i].other) {
        defects.edges.push_back({corners[i].vertex, corners[i].other});
      }
    }
    i = next;
  }
  if (sound && fan_count == 1) return;
  const std::uint32_t vertex = corners[begin].vertex;
  defects.vertices.push_back(vertex);
  Indices sizes(local.size(), 0);
  for (const auto& entry : local) ++sizes[fans.find(entry.second)];
  const auto largest =
      static_cast<std::uint32_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  for (const auto& [triangle, index] : local) {
    if (fans.find(index) == largest) continue;
    defects.tets_of_smaller_fans[vertex].push_back(boundary[triangle].tet);
  }
}

Defects find_defects(const LatticeMesh& mesh, const FaceTopology& faces) {
  const std::vector<BoundaryTriangle> boundary = boundary_triangles(mesh, faces);
  std::vector<BoundaryCorner> corners;
  corners.reserve(boundary.size() * 6);
  for (std::uint32_t i = 0; i < boundary.size(); ++i) {
    for (const std::uint32_t vertex : boundary[i].corners) {
      for (const std::uint32_t other : boundary[i].corners) {
        if (other != vertex) corners.push_back({vertex, other, i});
      }
    }
  }
  std::sort(corners.begin(), corners.end());
  Defects defects;
  for (std::size_t begin = 0; begin < corners.size();) {
    std::size_t end = begin;
    while (end < corners.size() && corners[end].vertex == corners[begin].vertex) ++end;
    inspect_vertex(boundary, corners, begin, end, defects);
    begin = end;
  }
  return defects;
}

// The tets at each of the given vertices.
std::map<std::uint32_t, Indices> stars(const LatticeMesh& mesh, const Indices& vertices) {
  std::vector<std::uint8_t> wanted(mesh.vertices.size(), 0);
  for (const std::uint32_t vertex : vertices) wanted[vertex] = 1;
  std::map<std::uint32_t, Indices> result;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    for (const std::uint32_t vertex : mesh.tets[t]) {
      if (wanted[vertex] != 0) result[vertex].push_back(t);
    }
  }
  return result;
}

// Classes of the tets of a star that are joined by faces containing every one of `common`. Returns
// the class of each, numbered in the order of the tets.
Indices classes_around(const Tet* tets, const FaceTopology& faces, const Indices& star,
                       const Indices& common) {
  DisjointSets sets(star.size());
  for (std::uint32_t i = 0; i < star.size(); ++i) {
    for (int f = 0; f < 4; ++f) {
      // A face holds every vertex of its tet but the one that it lies opposite to.
      const std::uint32_t opposite = tets[star[i]][f];
      if (std::find(common.begin(), common.end(), opposite) != common.end()) continue;
      const auto& sides = faces.face_tets[faces.tet_faces[star[i]][f]];
      const std::uint32_t neighbour = sides[0] == star[i] ? sides[1] : sides[0];
      const auto found = std::lower_bound(star.begin(), star.end(), neighbour);
      if (found != star.end() && *found == neighbour) {
        sets.unite(i, static_cast<std::uint32_t>(found - star.begin()));
      }
    }
  }
  Indices classes(star.size());
  std::map<std::uint32_t, std::uint32_t> names;
  for (std::uint32_t i = 0; i < star.size(); ++i) {
    classes[i] =
        names.emplace(sets.find(i), static_cast<std::uint32_t>(names.size())).first->second;
  }
  return classes;
}

// Gives every class of tets at a vertex a vertex of its own.
std::size_t copy_vertices(LatticeMesh& mesh, const FaceTopology& faces, const Indices& vertices) {
  std::size_t copies = 0;
  // Faces and stars are those before any copy, and so are the vertices that they are compared with.
  const std::vector<Tet> before = mesh.tets;
  for (const auto& [vertex, star] : stars(mesh, vertices)) {
    const Indices classes = classes_around(before.data(), faces, star, {vertex});
    const std::uint32_t count = *std::max_element(classes.begin(), classes.end());
    const auto first_copy = static_cast<std::uint32_t>(mesh.vertices.size());
    const Vec3 place = mesh.vertices[vertex];
    mesh.vertices.insert(mesh.vertices.end(), count, place);
    for (std::size_t i = 0; i < star.size(); ++i) {
      if (classes[i] == 0) continue;
      Tet& tet = mesh.tets[star[i]];
      *std::find(tet.begin(), tet.end(), vertex) = first_copy + classes[i] - 1;
    }
    copies += count;
  }
  return copies;
}

// Drops the tets that meet the rest only in an edge, or that belong to a vertex's smaller fans.
std::size_t drop_defects(LatticeMesh& mesh, const FaceTopology& faces, const Defects& defects) {
  std::vector<std::uint8_t> kept(mesh.tets.size(), 1);
  const std::map<std::uint32_t, Indices> at_vertex = stars(mesh, defects.vertices);
  bool dropped_at_edge = false;
  for (const Edge& edge : defects.edges) {
    Indices star;
    for (const std::uint32_t t : at_vertex.at(edge[0])) {
      const Tet& tet = mesh.tets[t];
      if (std::find(tet.begin(), tet.end(), edge[1]) != tet.end()) star.push_back(t);
    }
    const Indices classes = classes_around(mesh.tets.data(), faces, star, {edge[0], edge[1]});
    Indices sizes(star.size(), 0);
    for (const std::uint32_t c : classes) ++sizes[c];
    const auto largest =
        static_cast<std::uint32_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
    for (std::size_t i = 0; i < star.size(); ++i) {
      if (classes[i] == largest) continue;
      kept[star[i]] = 0;
      dropped_at_edge = true;
    }
  }
  if (!dropped_at_edge) {
    for (const auto& entry : defects.tets_of_smaller_fans) {
      for (const std::uint32_t t : entry.second) kept[t] = 0;
    }
  }
  const std::size_t before = mesh.tets.size();
  keep_tets(mesh, kept);
  return before - mesh.tets.size();
}

void remove_unused_vertices(LatticeMesh& mesh) {
  Indices number(mesh.vertices.size(), 0);
  for (const Tet& tet : mesh.tets) {
    for (const std::uint32_t vertex : tet) number[vertex] = 1;
  }
  std::uint32_t next = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (number[v] == 0) continue;
    mesh.vertices[next] = mesh.vertices[v];
    number[v] = next++;
  }
  mesh.vertices.resize(next);
  for (Tet& tet : mesh.tets) {
    for (std::uint32_t& vertex : tet) vertex = number[vertex];
  }
}

}  // namespace

void repair(LatticeMesh& mesh, bool all_components) {
  // Every round copies vertices or drops tets, of which there are finitely many.
  while (!mesh.tets.empty()) {
    if (!all_components) keep_largest_component(mesh);
    const FaceTopology faces = face_topology(mesh.tets, mesh.vertices.size());
    const Defects defects = find_defects(mesh, faces);
    if (defects.vertices.empty()) break;
    const std::size_t copies = copy_vertices(mesh, faces, defects.vertices);
    mesh.vertices_copied += copies;
    if (copies == 0) mesh.tets_dropped += drop_defects(mesh, faces, defects);
  }
  remove_unused_vertices(mesh);
}

}  // namespace tissue
