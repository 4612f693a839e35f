#pragma once

#include "tissue/base/types.h"

#include <cmath>

namespace tissue {

/// Six times the volume, and the extremes of the dihedral angles as in DihedralRange; those of a
/// flat tet are not defined.
template <class Real>
struct TetShape {
  Real determinant, lowest, highest;
};

/// The shape of a tet from the edges b, c and d that leave its first corner. Without branches, so
/// that a loop over it vectorises; by faces' normals, which need no roots.
template <class Real>
inline TetShape<Real> tet_shape(Real b0, Real b1, Real b2, Real c0, Real c1, Real c2, Real d0,
                                Real d1, Real d2) {
  // Written out, because the vector instructions are these and not std::max.
  const auto larger = [](Real a, Real b) { return a > b ? a : b; };
  const auto smaller = [](Real a, Real b) { return a < b ? a : b; };
  // cos·|cos| between faces; their outward normals enclose the angle's supplement.
  const auto square = [](Real dot, Real scale) { return -dot * std::abs(dot) / scale; };
  // Outward normals of the faces opposite b, c and d; with that opposite the first corner they add
  // up to zero.
  const Real p0 = d1 * c2 - d2 * c1, p1 = d2 * c0 - d0 * c2, p2 = d0 * c1 - d1 * c0;
  const Real q0 = b1 * d2 - b2 * d1, q1 = b2 * d0 - b0 * d2, q2 = b0 * d1 - b1 * d0;
  const Real r0 = c1 * b2 - c2 * b1, r1 = c2 * b0 - c0 * b2, r2 = c0 * b1 - c1 * b0;
  const Real o0 = -(p0 + q0 + r0), o1 = -(p1 + q1 + r1), o2 = -(p2 + q2 + r2);
  const Real oo = o0 * o0 + o1 * o1 + o2 * o2, pp = p0 * p0 + p1 * p1 + p2 * p2;
  const Real qq = q0 * q0 + q1 * q1 + q2 * q2, rr = r0 * r0 + r1 * r1 + r2 * r2;
  const Real op = square(o0 * p0 + o1 * p1 + o2 * p2, oo * pp),
             oq = square(o0 * q0 + o1 * q1 + o2 * q2, oo * qq),
             orr = square(o0 * r0 + o1 * r1 + o2 * r2, oo * rr),
             pq = square(p0 * q0 + p1 * q1 + p2 * q2, pp * qq),
             pr = square(p0 * r0 + p1 * r1 + p2 * r2, pp * rr),
             qr = square(q0 * r0 + q1 * r1 + q2 * r2, qq * rr);
  return {-(r0 * d0 + r1 * d1 + r2 * d2),
          smaller(smaller(smaller(op, oq), smaller(orr, pq)), smaller(pr, qr)),
          larger(larger(larger(op, oq), larger(orr, pq)), larger(pr, qr))};
}

/// Up to 64 tets as the edges from their first corners, one array per coordinate. In single
/// precision, which tells angles of 8 degrees and more to a thousandth of a degree.
class TetBatch {
 public:
  static constexpr int kCapacity = 64;
  /// Lengths are counted in `unit` [m], about the length of an edge: their twelfth powers have to
  /// fit into a float.
  explicit TetBatch(double unit) : scale_(static_cast<float>(1.0 / unit)) {}

  int count() const { return count_; }
  void clear() { count_ = 0; }
  /// Corners are places of float or double.
  template <class Place>
  void add(const Place& a, const Place& b, const Place& c, const Place& d) {
    const Place* ends[3] = {&b, &c, &d};
    for (int k = 0; k < 3; ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        edges_[3 * k + axis][count_] = scale_ * static_cast<float>((*ends[k])[axis] - a[axis]);
      }
    }
    ++count_;
  }
  /// Extremes of each tet's angles, as in DihedralRange, whichever way it is turned. A flat one
  /// gives 0 and 180 degrees.
  void measure(float* lowest, float* highest) const;

 private:
  float scale_;
  int count_ = 0;
  alignas(64) float edges_[9][kCapacity] = {};
};

}  // namespace tissue
