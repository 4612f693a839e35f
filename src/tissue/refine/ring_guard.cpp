#include "ring_guard.h"

#include "tissue/base/tet_shape.h"

#include <algorithm>

namespace tissue {
namespace {

// For each of `count` tets how far its angles are within its bounds, negative beyond; or a large
// negative number if its volume is not positive. `corners` holds b, c and d by axis, then come the
// bounds, each at a distance of `stride`; (x, y, z) is where the vertex would be.
void measure(const float* __restrict__ corners, std::size_t stride, std::size_t count, float x,
             float y, float z, float* __restrict__ slack) {
  const float *bx = corners, *by = bx + stride, *bz = by + stride;
  const float *cx = bz + stride, *cy = cx + stride, *cz = cy + stride;
  const float *dx = cz + stride, *dy = dx + stride, *dz = dy + stride;
  const float *highest = dz + stride, *lowest = highest + stride;
  for (std::size_t i = 0; i < count; ++i) {
    // Edges from the vertex, where it would be.
    const float b0 = bx[i] - x, b1 = by[i] - y, b2 = bz[i] - z;
    const float c0 = cx[i] - x, c1 = cy[i] - y, c2 = cz[i] - z;
    const float d0 = dx[i] - x, d1 = dy[i] - y, d2 = dz[i] - z;
    const TetShape<float> shape = tet_shape(b0, b1, b2, c0, c1, c2, d0, d1, d2);
    const float over = highest[i] - shape.highest, under = shape.lowest - lowest[i];
    const float within = over < under ? over : under;
    // A flat tet divides by zero: what is not a number is not within either.
    slack[i] = shape.determinant > 0.0f ? within : -1e9f;
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
    // Without branches, which nobody could predict.
    const int own = (tet[1] == vertex) + 2 * (tet[2] == vertex) + 3 * (tet[3] == vertex);
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
