#include "support/mesh_checks.h"

#include "tissue/base/error.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace tissue_test {
namespace {

using tissue::Edge;
using tissue::Tet;
using tissue::TetMesh;
using tissue::Triangle;
using tissue::Vec3;

Vec3 place(const TetMesh& mesh, std::uint32_t vertex) {
  return mesh.vertices[vertex].cast<double>();
}

// By the angle between the two other corners, seen along the edge: not by normals.
double dihedral_deg(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 along = (b - a).normalized();
  const Vec3 u = (c - a) - along * along.dot(c - a), v = (d - a) - along * along.dot(d - a);
  return std::atan2(u.cross(v).norm(), u.dot(v)) * 180.0 / M_PI;
}

Triangle sorted(Triangle triangle) {
  std::sort(triangle.begin(), triangle.end());
  return triangle;
}

Triangle rotated(Triangle triangle) {
  std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
  return triangle;
}

template <class T>
void sort_and_drop_doubles(std::vector<T>& items) {
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

std::size_t different_places(const TetMesh& mesh, std::size_t count) {
  std::vector<std::array<float, 3>> places(count);
  for (std::size_t v = 0; v < count; ++v) {
    places[v] = {mesh.vertices[v].x(), mesh.vertices[v].y(), mesh.vertices[v].z()};
  }
  sort_and_drop_doubles(places);
  return places.size();
}

std::vector<Triangle> outward_boundary(const TetMesh& mesh, MeshFindings& findings) {
  // Each face by its corners in order, beside the way its tet sees it.
  std::vector<std::pair<Triangle, Triangle>> faces;
  faces.reserve(4 * mesh.tets.size());
  for (const Tet& t : mesh.tets) {
    for (const Triangle& face : {Triangle{t[1], t[2], t[3]}, Triangle{t[0], t[3], t[2]},
                                 Triangle{t[0], t[1], t[3]}, Triangle{t[0], t[2], t[1]}}) {
      faces.emplace_back(sorted(face), face);
    }
  }
  std::sort(faces.begin(), faces.end());
  std::vector<Triangle> boundary;
  for (std::size_t i = 0, end = 0; i < faces.size(); i = end) {
    while (end < faces.size() && faces[end].first == faces[i].first) ++end;
    if (end - i == 1) boundary.push_back(faces[i].second);
    findings.faces_of_three_tets += end - i > 2;
  }
  return boundary;
}

void inspect_boundary(const TetMesh& mesh, const std::vector<Triangle>& boundary,
                      MeshFindings& findings) {
  std::map<Edge, int> edges;
  std::map<std::uint32_t, std::map<std::uint32_t, std::uint32_t>> next_around;
  for (const Triangle& t : boundary) {
    findings.volume_inside_boundary +=
        place(mesh, t[0]).dot(place(mesh, t[1]).cross(place(mesh, t[2]))) / 6.0;
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
      ++edges[{std::min(a, b), std::max(a, b)}];
      next_around[a][b] = c;
    }
  }
  for (const auto& entry : edges) findings.open_or_branching_edges += entry.second != 2;
  // Walking from triangle to triangle around a vertex must pass all of them before it closes.
  for (const auto& [vertex, next] : next_around) {
    std::uint32_t here = next.begin()->first;
    std::size_t steps = 0;
    do {
      const auto found = next.find(here);
      if (found == next.end()) break;
      here = found->second;
      ++steps;
    } while (here != next.begin()->first && steps <= next.size());
    findings.pinched_vertices += steps != next.size();
  }
}

}  // namespace

MeshFindings inspect(const TetMesh& mesh) {
  MeshFindings findings;
  std::vector<bool> used(mesh.vertices.size(), false);
  std::vector<Edge> edges;
  edges.reserve(6 * mesh.tets.size());
  for (const Tet& t : mesh.tets) {
    std::array<Vec3, 4> x;
    for (int i = 0; i < 4; ++i) x[i] = place(mesh, t[i]);
    const double volume = (x[1] - x[0]).dot((x[2] - x[0]).cross(x[3] - x[0])) / 6.0;
    findings.not_positive += !(volume > 0.0);
    findings.tet_volume += volume;
    for (const std::uint32_t vertex : t) used.at(vertex) = true;
    constexpr int pairs[6][4] = {{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2},
                                 {1, 2, 0, 3}, {1, 3, 0, 2}, {2, 3, 0, 1}};
    for (const auto& p : pairs) {
      const double angle = dihedral_deg(x[p[0]], x[p[1]], x[p[2]], x[p[3]]);
      findings.min_dihedral_deg = std::min(findings.min_dihedral_deg, angle);
      findings.max_dihedral_deg = std::max(findings.max_dihedral_deg, angle);
      edges.push_back({std::min(t[p[0]], t[p[1]]), std::max(t[p[0]], t[p[1]])});
    }
  }
  findings.unused_vertices = static_cast<std::size_t>(std::count(used.begin(), used.end(), false));
  sort_and_drop_doubles(edges);
  for (const Edge& ends : mesh.parents) {
    findings.hanging_nodes += std::binary_search(
        edges.begin(), edges.end(), Edge{std::min(ends[0], ends[1]), std::max(ends[0], ends[1])});
  }
  findings.twins = mesh.vertices.size() - different_places(mesh, mesh.vertices.size());

  const std::vector<Triangle> boundary = outward_boundary(mesh, findings);
  inspect_boundary(mesh, boundary, findings);
  std::set<Triangle> expected, given;
  for (const Triangle& triangle : boundary) expected.insert(rotated(triangle));
  for (const Triangle& triangle : mesh.surface) given.insert(rotated(triangle));
  findings.surface_differs = expected != given || given.size() != mesh.surface.size();
  return findings;
}

MeshFindings expect_sound(const TetMesh& mesh, std::size_t copies) {
  const MeshFindings found = inspect(mesh);
  EXPECT_GT(mesh.tets.size(), 0u);
  EXPECT_EQ(found.faces_of_three_tets, 0u);
  EXPECT_EQ(found.not_positive, 0u);
  EXPECT_EQ(found.unused_vertices, 0u);
  EXPECT_EQ(found.hanging_nodes, 0u);
  EXPECT_LE(found.twins, copies);
  EXPECT_EQ(found.open_or_branching_edges, 0u);
  EXPECT_EQ(found.pinched_vertices, 0u);
  EXPECT_FALSE(found.surface_differs);
  EXPECT_NEAR(found.tet_volume, found.volume_inside_boundary, 1e-9 * found.tet_volume);
  return found;
}

void expect_conforming(const TetMesh& mesh) {
  // Copies that share an edge have twins on all of it when it is split.
  const std::size_t copied = mesh.statistics.vertices_copied;
  const MeshFindings found = expect_sound(mesh, copied == 0 ? 0 : mesh.vertices.size());
  EXPECT_LE(mesh.lattice_vertices - different_places(mesh, mesh.lattice_vertices), copied);
  EXPECT_NEAR(mesh.statistics.volume, found.tet_volume, 1e-9 * found.tet_volume);
  // The statistics' angles are those of exact positions, the mesh's have been rounded to float.
  EXPECT_NEAR(mesh.statistics.dihedral[0] * 180.0 / M_PI, found.min_dihedral_deg, 0.02);
  EXPECT_NEAR(mesh.statistics.dihedral[1] * 180.0 / M_PI, found.max_dihedral_deg, 0.02);
}

std::string refusal(const std::function<void()>& call) {
  try {
    call();
  } catch (const tissue::InputError& error) {
    return std::string(tissue::name(error.code())) + ": " + error.what();
  }
  return "";
}

}  // namespace tissue_test
