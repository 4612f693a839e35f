#include "repair.h"

#include "tissue/base/disjoint_sets.h"
#include "tissue/base/topology.h"

#include <algorithm>
#include <map>
#include <utility>

namespace tissue {
namespace {

using Indices = std::vector<std::uint32_t>;

// A mesh whose tets can be dropped one by one: the faces are found once and kept up to date.
class Workpiece {
 public:
  explicit Workpiece(LatticeMesh& lattice_mesh)
      : mesh(lattice_mesh),
        faces(face_topology(lattice_mesh.tets, lattice_mesh.vertices.size())),
        kept(lattice_mesh.tets.size(), 1) {}

  void drop(std::uint32_t t) {
    if (kept[t] == 0) return;
    kept[t] = 0;
    for (const std::uint32_t f : faces.tet_faces[t]) {
      auto& sides = faces.face_tets[f];
      if (sides[0] == t) sides[0] = sides[1];
      sides[1] = kNoTet;
    }
  }

  // Removes the dropped tets and the vertices that nothing uses, keeping the order of the rest.
  void compact() {
    Indices number(mesh.vertices.size(), 0);
    std::size_t next_tet = 0;
    for (std::size_t t = 0; t < kept.size(); ++t) {
      if (kept[t] == 0) continue;
      for (const std::uint32_t vertex : mesh.tets[t]) number[vertex] = 1;
      mesh.tets[next_tet] = mesh.tets[t];
      mesh.whole[next_tet] = mesh.whole[t];
      ++next_tet;
    }
    mesh.tets.resize(next_tet);
    mesh.whole.resize(next_tet);
    std::uint32_t next_vertex = 0;
    for (std::size_t v = 0; v < number.size(); ++v) {
      if (number[v] == 0) continue;
      mesh.vertices[next_vertex] = mesh.vertices[v];
      number[v] = next_vertex++;
    }
    mesh.vertices.resize(next_vertex);
    for (Tet& tet : mesh.tets) {
      for (std::uint32_t& vertex : tet) vertex = number[vertex];
    }
  }

  LatticeMesh& mesh;
  FaceTopology faces;
  std::vector<std::uint8_t> kept;
};

void keep_largest_component(Workpiece& piece) {
  const std::vector<std::uint8_t>& kept = piece.kept;
  DisjointSets sets(kept.size());
  for (const auto& sides : piece.faces.face_tets) {
    if (sides[1] != kNoTet) sets.unite(sides[0], sides[1]);
  }
  Indices sizes(kept.size(), 0);
  std::size_t components = 0;
  for (std::uint32_t t = 0; t < kept.size(); ++t) {
    if (kept[t] != 0) components += sizes[sets.find(t)]++ == 0;
  }
  if (components <= 1) return;
  const auto largest =
      static_cast<std::uint32_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  for (std::uint32_t t = 0; t < kept.size(); ++t) {
    if (sets.find(t) != largest) piece.drop(t);
  }
  piece.mesh.components_dropped += components - 1;
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

std::vector<BoundaryTriangle> boundary_triangles(const Workpiece& piece) {
  std::vector<BoundaryTriangle> boundary;
  for (std::uint32_t t = 0; t < piece.kept.size(); ++t) {
    if (piece.kept[t] == 0) continue;
    const Tet& tet = piece.mesh.tets[t];
    for (int f = 0; f < 4; ++f) {
      if (piece.faces.face_tets[piece.faces.tet_faces[t][f]][1] != kNoTet) continue;
      const auto& corner = kTetFaces[f];
      boundary.push_back({t, {tet[corner[0]], tet[corner[1]], tet[corner[2]]}});
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

Defects find_defects(const Workpiece& piece) {
  const std::vector<BoundaryTriangle> boundary = boundary_triangles(piece);
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
std::map<std::uint32_t, Indices> stars(const Workpiece& piece, const Indices& vertices) {
  std::vector<std::uint8_t> wanted(piece.mesh.vertices.size(), 0);
  for (const std::uint32_t vertex : vertices) wanted[vertex] = 1;
  std::map<std::uint32_t, Indices> result;
  for (std::uint32_t t = 0; t < piece.kept.size(); ++t) {
    if (piece.kept[t] == 0) continue;
    for (const std::uint32_t vertex : piece.mesh.tets[t]) {
      if (wanted[vertex] != 0) result[vertex].push_back(t);
    }
  }
  return result;
}

// Classes of the tets of a star that are joined by faces containing every one of `common`. Returns
// the class of each, numbered in the order of the tets.
Indices classes_around(const Workpiece& piece, const Indices& star, const Indices& common) {
  DisjointSets sets(star.size());
  for (std::uint32_t i = 0; i < star.size(); ++i) {
    for (int f = 0; f < 4; ++f) {
      // A face holds every vertex of its tet but the one that it lies opposite to.
      const std::uint32_t opposite = piece.mesh.tets[star[i]][f];
      if (std::find(common.begin(), common.end(), opposite) != common.end()) continue;
      const auto& sides = piece.faces.face_tets[piece.faces.tet_faces[star[i]][f]];
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

// Gives every class of tets at a vertex a vertex of its own. Tets on both sides of a face are in
// one class at each of its vertices, so that the faces stay as they are.
void copy_vertices(Workpiece& piece, const Indices& vertices) {
  LatticeMesh& mesh = piece.mesh;
  const std::map<std::uint32_t, Indices> all = stars(piece, vertices);
  std::map<std::uint32_t, Indices> classes_at;
  for (const auto& [vertex, star] : all) classes_at[vertex] = classes_around(piece, star, {vertex});
  for (const auto& [vertex, star] : all) {
    const Indices& classes = classes_at[vertex];
    const std::uint32_t count = *std::max_element(classes.begin(), classes.end());
    const auto first_copy = static_cast<std::uint32_t>(mesh.vertices.size());
    const Vec3 place = mesh.vertices[vertex];
    mesh.vertices.insert(mesh.vertices.end(), count, place);
    for (std::size_t i = 0; i < star.size(); ++i) {
      if (classes[i] == 0) continue;
      Tet& tet = mesh.tets[star[i]];
      *std::find(tet.begin(), tet.end(), vertex) = first_copy + classes[i] - 1;
    }
    mesh.vertices_copied += count;
  }
}

// The tets that meet the rest only in an edge, or else those at a vertex's smaller fans.
Indices tets_to_drop(const Workpiece& piece, const Defects& defects) {
  Indices result;
  const std::map<std::uint32_t, Indices> at_vertex = stars(piece, defects.vertices);
  for (const Edge& edge : defects.edges) {
    Indices star;
    for (const std::uint32_t t : at_vertex.at(edge[0])) {
      const Tet& tet = piece.mesh.tets[t];
      if (std::find(tet.begin(), tet.end(), edge[1]) != tet.end()) star.push_back(t);
    }
    const Indices classes = classes_around(piece, star, {edge[0], edge[1]});
    Indices sizes(star.size(), 0);
    for (const std::uint32_t c : classes) ++sizes[c];
    const auto largest =
        static_cast<std::uint32_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
    for (std::size_t i = 0; i < star.size(); ++i) {
      if (classes[i] != largest) result.push_back(star[i]);
    }
  }
  if (!result.empty()) return result;
  for (const auto& entry : defects.tets_of_smaller_fans) {
    result.insert(result.end(), entry.second.begin(), entry.second.end());
  }
  return result;
}

}  // namespace

void repair(LatticeMesh& mesh, bool all_components) {
  Workpiece piece(mesh);
  // Every round but the last drops tets, of which there are finitely many.
  while (true) {
    if (!all_components) keep_largest_component(piece);
    Defects defects = find_defects(piece);
    if (!defects.vertices.empty()) {
      copy_vertices(piece, defects.vertices);
      defects = find_defects(piece);
    }
    if (defects.vertices.empty()) break;
    for (const std::uint32_t t : tets_to_drop(piece, defects)) {
      mesh.tets_dropped += piece.kept[t];
      piece.drop(t);
    }
  }
  piece.compact();
}

}  // namespace tissue
