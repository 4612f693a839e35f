#include "ring_guard.h"

#include <algorithm>

namespace tissue {
namespace {

// Written out, because the vector instructions are these and not std::max.
inline float larger(float a, float b) { return a > b ? a : b; }
inline float smaller(float a, float b) { return a < b ? a : b; }

// For each of `count` tets how far its angles are within its bounds, negative beyond; or a large
// negative number if its volume is not positive. `corners` holds b, c and d by axis, then come the
// bounds, each at a distance of `stride`; (x, y, z) is where the vertex would be.
void measure(const float* __restrict__ corners, std::size_t stride, std::size_t count, float x,
             float y, float z, float* __restrict__ slack) {
  const float *bx = corners, *by = bx + stride, *bz = by + stride;
  const float *cx = bz + stride, *cy = cx + stride, *cz = cy + stride;
  const float *dx = cz + stride, *dy = dx + stride, *dz = dy + stride;
  const float *highest = dz + stride, *lowest = highest + stride;
  const auto square = [](float dot, float scale) { return -dot * std::abs(dot) / scale; };
  for (std::size_t i = 0; i < count; ++i) {
    // Edges from the vertex, where it would be.
    const float b0 = bx[i] - x, b1 = by[i] - y, b2 = bz[i] - z;
    const float c0 = cx[i] - x, c1 = cy[i] - y, c2 = cz[i] - z;
    const float d0 = dx[i] - x, d1 = dy[i] - y, d2 = dz[i] - z;
    // Outward normals of the faces opposite b, c and d; with that opposite the vertex they add up
    // to zero.
    const float p0 = d1 * c2 - d2 * c1, p1 = d2 * c0 - d0 * c2, p2 = d0 * c1 - d1 * c0;
    const float q0 = b1 * d2 - b2 * d1, q1 = b2 * d0 - b0 * d2, q2 = b0 * d1 - b1 * d0;
    const float r0 = c1 * b2 - c2 * b1, r1 = c2 * b0 - c0 * b2, r2 = c0 * b1 - c1 * b0;
    const float o0 = -(p0 + q0 + r0), o1 = -(p1 + q1 + r1), o2 = -(p2 + q2 + r2);
    const float determinant = -(r0 * d0 + r1 * d1 + r2 * d2);
    const float oo = o0 * o0 + o1 * o1 + o2 * o2, pp = p0 * p0 + p1 * p1 + p2 * p2;
    const float qq = q0 * q0 + q1 * q1 + q2 * q2, rr = r0 * r0 + r1 * r1 + r2 * r2;
    const float op = square(o0 * p0 + o1 * p1 + o2 * p2, oo * pp),
                oq = square(o0 * q0 + o1 * q1 + o2 * q2, oo * qq),
                orr = square(o0 * r0 + o1 * r1 + o2 * r2, oo * rr),
                pq = square(p0 * q0 + p1 * q1 + p2 * q2, pp * qq),
                pr = square(p0 * r0 + p1 * r1 + p2 * r2, pp * rr),
                qr = square(q0 * r0 + q1 * r1 + q2 * r2, qq * rr);
    const float largest = larger(larger(larger(op, oq), larger(orr, pq)), larger(pr, qr));
    const float smallest = smaller(smaller(smaller(op, oq), smaller(orr, pq)), smaller(pr, qr));
    const float within = smaller(highest[i] - largest, smallest - lowest[i]);
    // A flat tet divides by zero: what is not a number is not within either.
    slack[i] = determinant > 0.0f ? within : -1e9f;
  }
}

}  // namespace

void RingGuard::gather(std::uint32_t vertex, const std::uint32_t* ring, std::size_t count,
                       const std::vector<Tet>& tets, const std::vector<Vec3f>& vertices) {
  // The corners that follow the vertex when the tet is turned so that it comes first.
  constexpr int kOthers[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  count_ = count;
  measured_now_ = false;
  // Whole vectors of eight: what is computed beyond the ring is not looked at.
  padded_ = (count + 7) / 8 * 8;
  if (stride_ < padded_) {
    stride_ = padded_;
    values_.assign(kRows * stride_, 0.0f);
    slack_now_.resize(stride_);
    slack_then_.resize(stride_);
  }
  const Vec3f& origin = vertices[vertex];
  for (std::size_t i = 0; i < count; ++i) {
    const Tet& tet = tets[ring[i]];
    const int own = tet[0] == vertex ? 0 : tet[1] == vertex ? 1 : tet[2] == vertex ? 2 : 3;
    for (int k = 0; k < 3; ++k) {
      const Vec3f& other = vertices[tet[kOthers[own][k]]];
      for (int axis = 0; axis < 3; ++axis) {
        values_[(3 * k + axis) * stride_ + i] = scale_ * (other[axis] - origin[axis]);
      }
    }
  }
}

bool RingGuard::allows(const Vec3f& step) {
  measure(values_.data(), stride_, padded_, scale_ * step[0], scale_ * step[1], scale_ * step[2],
          slack_then_.data());
  bool all_within = true;
  for (std::size_t i = 0; i < count_; ++i) all_within = all_within && slack_then_[i] >= 0.0f;
  if (all_within) return true;
  if (!measured_now_) {
    measure(values_.data(), stride_, padded_, 0.0f, 0.0f, 0.0f, slack_now_.data());
  }
  measured_now_ = true;
  for (std::size_t i = 0; i < count_; ++i) {
    if (!(slack_then_[i] >= std::min(slack_now_[i], 0.0f))) return false;
  }
  return true;
}

}  // namespace tissue
