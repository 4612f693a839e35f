#include "tissue/simulate/material_places.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tissue {
namespace {

// Points in the cells of a grid, so that a tet looks only at those near it.
class PointGrid {
 public:
  explicit PointGrid(const std::vector<Vec3>& points) : points_(points) {
    low_ = high_ = points.front();
    for (const Vec3& point : points) {
      low_ = low_.cwiseMin(point);
      high_ = high_.cwiseMax(point);
    }
    // About two points in a cell.
    const Vec3 extent = (high_ - low_).cwiseMax(1e-9 * (1.0 + low_.norm() + high_.norm()));
    cell_ = std::cbrt(2.0 * extent.prod() / static_cast<double>(points.size()));
    cell_ = std::max(cell_, extent.maxCoeff() / 256.0);
    for (int axis = 0; axis < 3; ++axis) counts_[axis] = 1 + coordinate(high_[axis], axis);
    cells_.resize(static_cast<std::size_t>(counts_[0] * counts_[1] * counts_[2]));
    for (std::uint32_t i = 0; i < points.size(); ++i) cells_[cell_of(points[i])].push_back(i);
  }

  // Calls body(point) for all points in cells that meet the box.
  template <class Body>
  void for_each_near(const Vec3& low, const Vec3& high, const Body& body) const {
    std::array<std::ptrdiff_t, 3> from{}, to{};
    for (int axis = 0; axis < 3; ++axis) {
      if (high[axis] < low_[axis] || low[axis] > high_[axis]) return;
      from[axis] = coordinate(std::max(low[axis], low_[axis]), axis);
      to[axis] = coordinate(std::min(high[axis], high_[axis]), axis);
    }
    for (std::ptrdiff_t z = from[2]; z <= to[2]; ++z) {
      for (std::ptrdiff_t y = from[1]; y <= to[1]; ++y) {
        for (std::ptrdiff_t x = from[0]; x <= to[0]; ++x) {
          for (const std::uint32_t point : cells_[index(x, y, z)]) body(point);
        }
      }
    }
  }

 private:
  std::ptrdiff_t coordinate(double place, int axis) const {
    return static_cast<std::ptrdiff_t>(std::floor((place - low_[axis]) / cell_));
  }
  std::size_t index(std::ptrdiff_t x, std::ptrdiff_t y, std::ptrdiff_t z) const {
    return static_cast<std::size_t>((z * counts_[1] + y) * counts_[0] + x);
  }
  std::size_t cell_of(const Vec3& place) const {
    return index(coordinate(place[0], 0), coordinate(place[1], 1), coordinate(place[2], 2));
  }

  const std::vector<Vec3>& points_;
  Vec3 low_, high_;
  double cell_ = 0.0;
  std::array<std::ptrdiff_t, 3> counts_{};
  std::vector<std::vector<std::uint32_t>> cells_;
};

// A tet that tells where a place is in it.
struct PlacedTet {
  Vec3 origin;
  Mat3 inverse;
  // The height over each face [m].
  std::array<double, 4> heights{};
  Vec3 low, high;

  PlacedTet(const Body& body, const Tet& tet) : origin(body.rest[tet[0]].cast<double>()) {
    Mat3 edges;
    low = high = origin;
    for (int k = 0; k < 3; ++k) {
      const Vec3 corner = body.rest[tet[k + 1]].cast<double>();
      edges.col(k) = corner - origin;
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
    inverse = edges.inverse();
    heights[0] = 1.0 / inverse.colwise().sum().norm();
    for (int k = 0; k < 3; ++k) heights[k + 1] = 1.0 / inverse.row(k).norm();
  }

  std::array<double, 4> barycentric(const Vec3& place) const {
    const Vec3 b = inverse * (place - origin);
    return {1.0 - b.sum(), b[0], b[1], b[2]};
  }
  // How far a place lies beyond the face from which it is farthest [m]; 0 within.
  double outside(const std::array<double, 4>& barycentric) const {
    double farthest = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      farthest = std::max(farthest, -barycentric[k] * heights[k]);
    }
    return farthest;
  }
};

}  // namespace

std::vector<TetPlace> material_places(const Body& body, const std::vector<Vec3>& points) {
  std::vector<TetPlace> places(points.size());
  if (points.empty()) return places;
  const PointGrid grid(points);
  std::vector<double> nearest(points.size(), std::numeric_limits<double>::infinity());
  // First what tets hold, then ever farther around them.
  double reach = 0.0, largest_tet = 0.0;
  for (bool all_found = false; !all_found; reach = std::max(largest_tet, 2.0 * reach)) {
    for (std::uint32_t t = 0; t < body.tets.size(); ++t) {
      const PlacedTet tet(body, body.tets[t]);
      largest_tet = std::max(largest_tet, (tet.high - tet.low).maxCoeff());
      const Vec3 margin = Vec3::Constant(reach);
      grid.for_each_near(tet.low - margin, tet.high + margin, [&](std::uint32_t point) {
        const std::array<double, 4> barycentric = tet.barycentric(points[point]);
        const double outside = tet.outside(barycentric);
        if (!(outside < nearest[point])) return;
        nearest[point] = outside;
        places[point] = {t, barycentric};
      });
    }
    all_found = std::all_of(nearest.begin(), nearest.end(),
                            [&](double distance) { return distance <= reach; });
  }
  return places;
}

}  // namespace tissue
