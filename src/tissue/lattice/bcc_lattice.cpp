#include "tissue/lattice/bcc_lattice.h"

#include "tissue/base/tet_mesh.h"

#include <cassert>
#include <utility>

namespace tissue {
namespace {

using Step = std::array<int, 3>;

Vec3 as_vector(const Step& step) { return Vec3(step[0], step[1], step[2]); }

double signed_volume(const BccTet& tet) {
  return determinant(as_vector(tet.corners[0]), as_vector(tet.corners[1]),
                     as_vector(tet.corners[2]), as_vector(tet.corners[3])) /
         6.0;
}

BccTet::NamedEdge named_edge(const BccTet& tet, int a, int b) {
  for (int direction = 0; direction < BccLattice::kDirections; ++direction) {
    const Vec3 step = as_vector(BccLattice::kStep[direction]);
    const Vec3 from_a = as_vector(tet.corners[b]) - as_vector(tet.corners[a]);
    if (from_a == step) return {a, direction};
    if (from_a == -step) return {b, direction};
  }
  assert(false && "two corners of a BCC tet are always joined by an edge of the lattice");
  return {a, 0};
}

std::array<BccTet, 12> make_tets() {
  std::array<BccTet, 12> tets{};
  // Around the long edge from the odd point P along an axis stand four even points.
  constexpr int ring[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (int axis = 0; axis < 3; ++axis) {
    const auto step = [axis](int along, int second, int third) {
      Step result{};
      result[axis] = along;
      result[(axis + 1) % 3] = second;
      result[(axis + 2) % 3] = third;
      return result;
    };
    for (int q = 0; q < 4; ++q) {
      BccTet& tet = tets[4 * axis + q];
      const int* here = ring[q];
      const int* next = ring[(q + 1) % 4];
      tet.corners = {step(0, 0, 0), step(1, here[0], here[1]), step(2, 0, 0),
                     step(1, next[0], next[1])};
      if (signed_volume(tet) < 0.0) std::swap(tet.corners[0], tet.corners[2]);
      for (int e = 0; e < 6; ++e) {
        tet.edges[e] = named_edge(tet, kTetEdges[e][0], kTetEdges[e][1]);
      }
    }
  }
  return tets;
}

}  // namespace

const std::array<BccTet, 12>& bcc_tets() {
  static const std::array<BccTet, 12> tets = make_tets();
  return tets;
}

}  // namespace tissue
