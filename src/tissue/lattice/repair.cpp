#include "repair.h"

#include "tissue/base/boundary.h"
#include "tissue/base/disjoint_sets.h"

#include <algorithm>
#include <map>
#include <utility>

namespace tissue {
namespace {

using Indices = std::vector<std::uint32_t>;

// A mesh whose tets can be dropped one by one.
struct Workpiece {
  LatticeMesh& mesh;
  std::vector<std::uint8_t> on_surface;
  /// Empty as long as no tet has been dropped.
  std::vector<std::uint8_t> kept;

  bool keeps(std::uint32_t t) const { return kept.empty() || kept[t] != 0; }
  // All of the tet's vertices may lie on the boundary afterwards.
  bool drop(std::uint32_t t) {
    if (kept.empty()) kept.assign(mesh.tets.size(), 1);
    for (const std::uint32_t vertex : mesh.tets[t]) on_surface[vertex] = 1;
    return std::exchange(kept[t], std::uint8_t{0}) != 0;
  }
};

// Removes the dropped tets and the vertices that nothing uses, keeping the order of the rest.
void compact(LatticeMesh& mesh, const std::vector<std::uint8_t>& kept) {
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
  for (Triangle& triangle : mesh.surface) {
    for (std::uint32_t& vertex : triangle) vertex = number[vertex];
  }
}

// The component with the most tets, after dropping has torn the mesh. Where every vertex has one
// fan of tets, those that share a vertex hang together.
void keep_largest_component(Workpiece& piece) {
  const std::vector<Tet>& tets = piece.mesh.tets;
  DisjointSets sets(piece.mesh.vertices.size());
  for (std::uint32_t t = 0; t < tets.size(); ++t) {
    if (!piece.keeps(t)) continue;
    for (int i = 1; i < 4; ++i) sets.unite(tets[t][0], tets[t][i]);
  }
  Indices sizes(piece.mesh.vertices.size(), 0);
  std::size_t components = 0;
  for (std::uint32_t t = 0; t < tets.size(); ++t) {
    if (piece.keeps(t)) components += sizes[sets.find(tets[t][0])]++ == 0;
  }
  if (components <= 1) return;
  const auto largest =
      static_cast<std::uint32_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  for (std::uint32_t t = 0; t < tets.size(); ++t) {
    if (sets.find(tets[t][0]) != largest) piece.kept[t] = 0;
  }
  piece.mesh.components_dropped += components - 1;
}

// The tets at each of the given vertices.
std::map<std::uint32_t, Indices> stars(const Workpiece& piece, const Indices& vertices) {
  std::vector<std::uint8_t> wanted(piece.mesh.vertices.size(), 0);
  for (const std::uint32_t vertex : vertices) wanted[vertex] = 1;
  std::map<std::uint32_t, Indices> result;
  for (std::uint32_t t = 0; t < piece.mesh.tets.size(); ++t) {
    if (!piece.keeps(t)) continue;
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
  std::map<Triangle, std::uint32_t> first_at;
  for (std::uint32_t i = 0; i < star.size(); ++i) {
    const Tet& tet = piece.mesh.tets[star[i]];
    for (int f = 0; f < 4; ++f) {
      // A face holds every vertex of its tet but the one that it lies opposite to.
      if (std::find(common.begin(), common.end(), tet[f]) != common.end()) continue;
      Triangle face = {tet[kTetFaces[f][0]], tet[kTetFaces[f][1]], tet[kTetFaces[f][2]]};
      std::sort(face.begin(), face.end());
      const auto [here, is_new] = first_at.emplace(face, i);
      if (!is_new) sets.unite(here->second, i);
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
    piece.on_surface.insert(piece.on_surface.end(), count, std::uint8_t{1});
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

void repair(LatticeMesh& mesh, std::vector<std::uint8_t> on_surface, bool all_components,
            const Run& run) {
  Workpiece piece = {mesh, std::move(on_surface), {}};
  std::vector<BoundaryTriangle> boundary;
  const auto look_again = [&] {
    run.go_on();
    boundary = boundary_triangles(mesh.tets, piece.kept, piece.on_surface);
    return find_defects(boundary, mesh.vertices.size());
  };
  // Every round but the last drops tets, of which there are finitely many.
  while (true) {
    Defects defects = look_again();
    if (!defects.vertices.empty()) {
      copy_vertices(piece, defects.vertices);
      defects = look_again();
    }
    if (defects.vertices.empty()) break;
    for (const std::uint32_t t : tets_to_drop(piece, defects)) mesh.tets_dropped += piece.drop(t);
  }
  if (!piece.kept.empty() && !all_components) keep_largest_component(piece);
  mesh.surface.reserve(boundary.size());
  for (const BoundaryTriangle& triangle : boundary) {
    if (piece.keeps(triangle.tet)) mesh.surface.push_back(triangle.corners);
  }
  if (!piece.kept.empty()) compact(mesh, piece.kept);
}

}  // namespace tissue
