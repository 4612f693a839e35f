#pragma once

#include "tissue/base/quality.h"
#include "vertex_rings.h"

#include <vector>

namespace tissue {

/// Says whether a vertex may move: the tets around it, gathered once, so that several places can be
/// tried and the loop over the ring vectorises. Places are taken relative to the vertex and in
/// units of `unit` [m], where single precision tells angles to a hundredth of a degree.
class RingGuard {
 public:
  explicit RingGuard(double unit) : scale_(static_cast<float>(1.0 / unit)) {}

  /// `bounds[i]` is for the i-th tet of the ring.
  void gather(std::uint32_t vertex, const std::uint32_t* ring, std::size_t count,
              const std::vector<Tet>& tets, const std::vector<Vec3f>& vertices);
  /// Lets a tet keep angles only within these bounds.
  void bound(std::size_t tet, const AngleBounds& bounds) {
    values_[9 * stride_ + tet] = static_cast<float>(bounds.highest);
    values_[10 * stride_ + tet] = static_cast<float>(bounds.lowest);
  }
  /// True if after the vertex has moved by `step` every tet has positive volume and angles within
  /// its bounds, or if it was beyond them already, no worse ones than it has.
  bool allows(const Vec3f& step);

 private:
  float scale_;
  std::size_t count_ = 0, padded_ = 0, stride_ = 0;
  // Rows of `stride_`: b, c and d by axis, the corners that follow the vertex in an order that
  // keeps the volume positive; then the bounds, highest and lowest.
  static constexpr std::size_t kRows = 11;
  std::vector<float> values_, slack_now_, slack_then_;
  bool measured_now_ = false;
};

}  // namespace tissue
