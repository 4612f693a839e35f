#include "tissue/simulate/anchors.h"

#include "tissue/base/disjoint_sets.h"
#include "tissue/base/error.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace tissue {
namespace {

struct Bounds {
  Vec3 low, high;
  explicit Bounds(const Body& body)
      : low(body.rest.front().cast<double>()), high(body.rest.front().cast<double>()) {
    for (const Vec3f& place : body.rest) {
      low = low.cwiseMin(place.cast<double>());
      high = high.cwiseMax(place.cast<double>());
    }
  }
  Vec3 at(const CoordinateTriple& triple) const {
    Vec3 result;
    for (int axis = 0; axis < 3; ++axis) {
      result[axis] = triple[static_cast<std::size_t>(axis)].within(low[axis], high[axis]);
    }
    return result;
  }
};

Bed bed_at(const PlaneAnchor& anchor, const Bounds& bounds) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  const double low = bounds.low[anchor.axis], high = bounds.high[anchor.axis];
  return {0, anchor.axis, anchor.above ? anchor.above->within(low, high) : -kFar,
          anchor.below ? anchor.below->within(low, high) : kFar, anchor.stiffness};
}

// Gives vertices to anchors; who comes first keeps them.
class Holds {
 public:
  explicit Holds(const Body& body)
      : body_(body), bounds_(body), holders_(body.rest.size(), kNobody) {}

  void take(int anchor, const Anchor& which) {
    anchor_ = anchor;
    if (std::visit(*this, which) == 0) {
      throw InputError(ErrorCode::kScene,
                       "anchors[" + std::to_string(anchor) + "]: holds no vertex of the mesh");
    }
  }
  const std::vector<int>& holders() const { return holders_; }

  std::size_t operator()(const PlaneAnchor& anchor) {
    const Bed side = bed_at(anchor, bounds_);
    const auto within = [&](std::size_t v) { return side.reaches(body_.rest[v].cast<double>()); };
    if (anchor.stiffness == 0.0) return hold_where(within);
    std::size_t count = 0;
    for (std::size_t v = 0; v < holders_.size(); ++v) count += within(v);
    return count;
  }
  std::size_t operator()(const BoxAnchor& anchor) {
    const Vec3 low = bounds_.at(anchor.low), high = bounds_.at(anchor.high);
    return hold_where([&](std::size_t v) {
      const Vec3 place = body_.rest[v].cast<double>();
      return (place.array() >= low.array()).all() && (place.array() <= high.array()).all();
    });
  }
  std::size_t operator()(const SphereAnchor& anchor) {
    const Vec3 centre = bounds_.at(anchor.centre);
    const double radius = anchor.radius.within(0.0, (bounds_.high - bounds_.low).norm());
    return hold_where(
        [&](std::size_t v) { return (body_.rest[v].cast<double>() - centre).norm() <= radius; });
  }
  std::size_t operator()(const LabelAnchor& anchor) {
    return hold_where(
        [&](std::size_t v) { return std::abs(body_.densities[v] - anchor.density) < 0.5; });
  }
  std::size_t operator()(const VertexAnchor& anchor) {
    for (const std::uint32_t v : anchor.vertices) {
      if (v >= holders_.size()) {
        throw InputError(ErrorCode::kScene, "anchors: vertex " + std::to_string(v) +
                                                " is not one of the mesh's " +
                                                std::to_string(holders_.size()));
      }
      hold(v);
    }
    return anchor.vertices.size();
  }

 private:
  std::size_t hold_where(const std::function<bool(std::size_t)>& holds) {
    std::size_t count = 0;
    for (std::size_t v = 0; v < holders_.size(); ++v) {
      if (!holds(v)) continue;
      hold(v);
      ++count;
    }
    return count;
  }
  void hold(std::size_t v) {
    if (holders_[v] == kNobody) holders_[v] = anchor_;
  }

  const Body& body_;
  Bounds bounds_;
  std::vector<int> holders_;
  int anchor_ = 0;
};

// Numbers the connected parts of a body, each by its lowest vertex.
std::vector<std::uint32_t> parts_of(const Body& body) {
  DisjointSets sets(body.rest.size());
  for (const Tet& tet : body.tets) {
    for (int k = 1; k < 4; ++k) sets.unite(tet[0], tet[k]);
  }
  std::vector<std::uint32_t> parts(body.rest.size());
  for (std::uint32_t v = 0; v < parts.size(); ++v) parts[v] = sets.find(v);
  return parts;
}

// How many independent directions the held vertices of a part span: 2 hold it.
class Span {
 public:
  void add(const Vec3& place, double size) {
    if (!first_) {
      first_ = place;
    } else if (!direction_) {
      if ((place - *first_).norm() > kLeast * size) direction_ = (place - *first_).normalized();
    } else if (!holds_) {
      holds_ = (place - *first_).cross(*direction_).norm() > kLeast * size;
    }
  }
  bool holds() const { return holds_; }

 private:
  static constexpr double kLeast = 1e-6;
  std::optional<Vec3> first_, direction_;
  bool holds_ = false;
};

}  // namespace

std::vector<int> anchors_of_vertices(const Body& body, const std::vector<Anchor>& anchors) {
  Holds holds(body);
  for (std::size_t i = 0; i < anchors.size(); ++i) holds.take(static_cast<int>(i), anchors[i]);
  return holds.holders();
}

bool is_bed(const Anchor& anchor) {
  const auto* const plane = std::get_if<PlaneAnchor>(&anchor);
  return plane != nullptr && plane->stiffness > 0.0;
}

std::vector<Bed> beds_of(const Body& body, const std::vector<Anchor>& anchors) {
  std::vector<Bed> beds;
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    if (!is_bed(anchors[i])) continue;
    beds.push_back(bed_at(std::get<PlaneAnchor>(anchors[i]), Bounds(body)));
    beds.back().anchor = i;
  }
  return beds;
}

void require_held(const Body& body, const std::vector<int>& holders, const std::vector<Bed>& beds) {
  const std::vector<std::uint32_t> parts = parts_of(body);
  const Bounds bounds(body);
  const double size = (bounds.high - bounds.low).norm();
  std::vector<Span> spans(body.rest.size());
  std::vector<std::size_t> vertices(body.rest.size(), 0);
  for (std::size_t v = 0; v < parts.size(); ++v) {
    ++vertices[parts[v]];
    if (holders[v] != kNobody) spans[parts[v]].add(body.rest[v].cast<double>(), size);
  }
  for (const Triangle& triangle : body.surface) {
    for (const std::uint32_t v : triangle) {
      const Vec3 place = body.rest[v].cast<double>();
      const bool lies_on_bed =
          std::any_of(beds.begin(), beds.end(), [&](const Bed& bed) { return bed.reaches(place); });
      if (lies_on_bed) spans[parts[v]].add(place, size);
    }
  }
  std::string list;
  std::size_t loose = 0;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    // A vertex of no tet is no part.
    if (parts[part] != part || vertices[part] < 4 || spans[part].holds()) continue;
    if (++loose > 3) continue;
    list += (list.empty() ? "" : ", ") + std::to_string(vertices[part]) +
            " vertices around vertex " + std::to_string(part);
  }
  if (loose == 0) return;
  throw InputError(ErrorCode::kUnconstrained,
                   "anchors: " + std::to_string(loose) +
                       " parts of the mesh are not held by three vertices that do not lie on a "
                       "line: " +
                       list + (loose > 3 ? ", …" : ""));
}

}  // namespace tissue
