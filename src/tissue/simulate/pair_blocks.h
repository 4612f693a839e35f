#pragma once

#include "element_lanes.h"
#include "material_tensor.h"

namespace tissue {

/// The stiffness between each two nodes of a pack's elements: block of nodes a > b at a (a − 1)/2 +
/// b. What a node has with itself is minus the sum of what it has with others, for where all nodes
/// move alike no force arises.
template <int order>
struct PairBlocks {
  static constexpr int kCount = kNodes<order> * (kNodes<order> - 1) / 2;
  LaneMatrix<Lanes> of[kCount] = {};

  /// Adds what a quadrature point does.
  void add(const QuadraturePoint& point, const LaneMatrix<Lanes>& barycentric,
           const MaterialTensor& tensor) {
    constexpr int n = kNodes<order>;
    Lanes gradients[n][3], turned[n][3];
    shape_gradients<order>(point, barycentric, gradients);
    for (int a = 0; a < n; ++a) turn(tensor, gradients[a], turned[a]);
    LaneMatrix<Lanes>* block = of;
    for (int a = 0; a < n; ++a) {
      for (int b = 0; b < a; ++b) add_coupling(tensor, turned[a], turned[b], *block++);
    }
  }
};

/// What the gradients of the four barycentric coordinates have with each other, for a ≤ b.
struct CornerCouplings {
  LaneMatrix<Lanes> of[4][4] = {};

  CornerCouplings(const LaneMatrix<Lanes>& barycentric, const MaterialTensor& tensor) {
    Lanes turned[3][3];
    for (int a = 0; a < 3; ++a) turn(tensor, barycentric[a], turned[a]);
    for (int a = 0; a < 3; ++a) {
      for (int b = a; b < 3; ++b) add_coupling(tensor, turned[a], turned[b], of[a + 1][b + 1]);
    }
    // The first gradient is minus the sum of the others.
    for_entries([&](int r, int c) {
      for (int b = 1; b < 4; ++b) {
        for (int a = 1; a < 4; ++a) {
          of[0][b][r][c] -= a <= b ? of[a][b][r][c] : of[b][a][c][r];
        }
        of[0][0][r][c] -= of[0][b][r][c];
      }
    });
  }
};

}  // namespace tissue
