#include "filler.h"

#include "face_tables.h"
#include "tissue/base/parallel.h"

#include <algorithm>

namespace tissue {
namespace {

// Corners of a lattice face by ascending vertex number; every face point is numbered from them.
std::array<int, 3> sorted_corners(const Tet& tet, int face) {
  std::array<int, 3> corners = kTetFaces[face];
  std::sort(corners.begin(), corners.end(), [&](int a, int b) { return tet[a] < tet[b]; });
  return corners;
}

class Filler {
 public:
  Filler(const RefinableLattice& lattice, const RefinementPlan& plan, const VertexBlocks& blocks,
         RefinedMesh& mesh)
      : lattice_(lattice), plan_(plan), blocks_(blocks), mesh_(mesh) {
    for (const Template* filled : plan.templates) {
      for (const std::uint32_t parts : filled->face_parts) {
        if (parts > 2) face_tables_.prepare(parts);
      }
    }
  }

  void fill_lattice_vertices() {
    for (std::size_t v = 0; v < lattice_.mesh.vertices.size(); ++v) {
      mesh_.vertices[v] = lattice_.mesh.vertices[v].cast<float>();
    }
  }

  void fill_edge(std::size_t e) {
    const Edge& ends = lattice_.edges.edges[e];
    const std::uint32_t parts = 1u << plan_.edge_levels[e];
    const Vec3 a = lattice_.mesh.vertices[ends[0]], b = lattice_.mesh.vertices[ends[1]];
    const auto number = [&](std::uint32_t position) {
      if (position == 0) return ends[0];
      if (position == parts) return ends[1];
      return blocks_.edge_begin[e] + position - 1;
    };
    for (std::uint32_t i = 1; i < parts; ++i) {
      const std::uint32_t step = i & (~i + 1u);
      set_vertex(number(i), a + (double(i) / parts) * (b - a), number(i - step), number(i + step));
    }
  }

  void fill_face(std::size_t f) {
    const std::uint32_t parts = 1u << plan_.face_levels[f];
    if (parts < 4) return;
    const std::uint32_t t = lattice_.faces.face_tets[f][0];
    int face = 0;
    while (lattice_.faces.tet_faces[t][face] != f) ++face;
    const Tet& tet = lattice_.mesh.tets[t];
    const std::array<int, 3> c = sorted_corners(tet, face);
    std::array<Vec3, 3> places;
    for (int i = 0; i < 3; ++i) places[i] = lattice_.mesh.vertices[tet[c[i]]];
    const auto number = [&](const std::array<std::uint32_t, 3>& w) {
      for (int i = 0; i < 3; ++i) {
        if (w[i] == parts) return tet[c[i]];
        if (w[i] != 0) continue;
        const int low = i == 0 ? 1 : 0, high = i == 2 ? 1 : 2;
        const std::uint32_t e = lattice_.edges.tet_edges[t][tet_edge(c[low], c[high])];
        if (w[low] == 0 || w[high] == 0) continue;
        // The edge may be finer than the face.
        const std::uint32_t scale = (1u << plan_.edge_levels[e]) / parts;
        return blocks_.edge_begin[e] + w[high] * scale - 1;
      }
      return blocks_.face_begin[f] + face_index(w[1], w[2], parts);
    };
    for (std::uint32_t p = 1; p + 1 < parts; ++p) {
      for (std::uint32_t q = 1; p + q < parts; ++q) {
        const std::array<std::uint32_t, 3> w = {parts - p - q, p, q};
        const std::uint32_t any = w[0] | w[1] | w[2];
        const std::uint32_t step = any & (~any + 1u);
        // Two of the weights are odd multiples of the step: the point halves an edge along which
        // they change.
        const int even = (w[0] & step) == 0 ? 0 : (w[1] & step) == 0 ? 1 : 2;
        std::array<std::uint32_t, 3> before = w, after = w;
        before[(even + 1) % 3] -= step;
        before[(even + 2) % 3] += step;
        after[(even + 1) % 3] += step;
        after[(even + 2) % 3] -= step;
        const Vec3 place =
            (double(w[0]) * places[0] + double(w[1]) * places[1] + double(w[2]) * places[2]) /
            double(parts);
        set_vertex(number(w), place, number(before), number(after));
      }
    }
  }

  void fill_tet(std::size_t t, std::vector<std::uint32_t>& numbers) {
    const Template& filled = *plan_.templates[t];
    number_points(t, filled, numbers);
    const Tet& tet = lattice_.mesh.tets[t];
    for (std::size_t i = 0; i < filled.interior_weights.size(); ++i) {
      const auto& w = filled.interior_weights[i];
      const auto& parents = filled.interior_parents[i];
      Vec3 place = Vec3::Zero();
      for (int c = 0; c < 4; ++c) place += w[c] * lattice_.mesh.vertices[tet[c]];
      set_vertex(blocks_.tet_begin[t] + static_cast<std::uint32_t>(i), place, numbers[parents[0]],
                 numbers[parents[1]]);
    }
    std::size_t next = blocks_.first_tet[t];
    for (const auto& local : filled.tets) {
      mesh_.levels[next] = plan_.levels[t];
      mesh_.tets[next++] = {numbers[local[0]], numbers[local[1]], numbers[local[2]],
                            numbers[local[3]]};
    }
    std::size_t next_triangle = blocks_.first_triangle[t];
    for (int f = 0; f < 4; ++f) {
      if (lattice_.faces.face_tets[lattice_.faces.tet_faces[t][f]][1] != kNoTet) continue;
      for (const auto& local : filled.face_triangles[f]) {
        mesh_.surface[next_triangle++] = {numbers[local[0]], numbers[local[1]], numbers[local[2]]};
      }
    }
  }

 private:
  void set_vertex(std::uint32_t vertex, const Vec3& place, std::uint32_t parent_a,
                  std::uint32_t parent_b) {
    mesh_.vertices[vertex] = place.cast<float>();
    mesh_.parents[vertex - lattice_.mesh.vertices.size()] = {parent_a, parent_b};
  }

  // The vertices of a template's points, in the order of its local numbers.
  void number_points(std::size_t t, const Template& filled, std::vector<std::uint32_t>& numbers) {
    const Tet& tet = lattice_.mesh.tets[t];
    numbers.clear();
    numbers.insert(numbers.end(), tet.begin(), tet.end());
    for (int e = 0; e < 6; ++e) {
      const std::uint32_t begin = blocks_.edge_begin[lattice_.edges.tet_edges[t][e]];
      const std::uint32_t points = edge_points(filled.edge_parts[e]);
      const bool forward = tet[kTetEdges[e][0]] < tet[kTetEdges[e][1]];
      for (std::uint32_t i = 0; i < points; ++i) {
        numbers.push_back(begin + (forward ? i : points - 1 - i));
      }
    }
    for (int f = 0; f < 4; ++f) {
      const std::uint32_t parts = filled.face_parts[f];
      if (parts < 4) continue;
      const std::uint32_t begin = blocks_.face_begin[lattice_.faces.tet_faces[t][f]];
      const auto& c = kTetFaces[f];
      std::array<int, 3> ranks{};
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) ranks[i] += tet[c[j]] < tet[c[i]];
      }
      for (const std::uint32_t index : face_tables_.table(parts, ranks)) {
        numbers.push_back(begin + index);
      }
    }
    for (std::uint32_t i = 0; i < interior_points_count(filled.tet_parts); ++i) {
      numbers.push_back(blocks_.tet_begin[t] + i);
    }
  }

  const RefinableLattice& lattice_;
  const RefinementPlan& plan_;
  const VertexBlocks& blocks_;
  RefinedMesh& mesh_;
  FaceTables face_tables_;
};

// Fresh memory takes its time, too much to be asked only afterwards whether to go on.
template <class T>
void resize(std::vector<T>& values, std::size_t size, const Run& run) {
  constexpr std::size_t kStep = 1 << 20;
  values.reserve(size);
  while (values.size() < size) {
    run.go_on();
    values.resize(std::min(size, values.size() + kStep));
  }
}

}  // namespace

RefinedMesh fill_mesh(const RefinableLattice& lattice, const RefinementPlan& plan,
                      const VertexBlocks& blocks, const Run& run) {
  RefinedMesh mesh;
  resize(mesh.vertices, blocks.vertex_count, run);
  resize(mesh.parents, blocks.vertex_count - lattice.mesh.vertices.size(), run);
  resize(mesh.tets, blocks.first_tet.back(), run);
  resize(mesh.levels, blocks.first_tet.back(), run);
  resize(mesh.surface, blocks.first_triangle.back(), run);

  Filler filler(lattice, plan, blocks, mesh);
  filler.fill_lattice_vertices();
  parallel_ranges(plan.edge_levels.size(), 1024, run, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) filler.fill_edge(e);
  });
  parallel_ranges(plan.face_levels.size(), 1024, run, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) filler.fill_face(f);
  });
  parallel_ranges(plan.templates.size(), 1024, run, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> numbers;
    for (std::size_t t = begin; t < end; ++t) filler.fill_tet(t, numbers);
  });
  return mesh;
}

}  // namespace tissue
