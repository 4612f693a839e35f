#include "template_library.h"

#include "numbering.h"
#include "tissue/base/tet_shape.h"

#include <algorithm>
#include <cassert>

namespace tissue {
namespace {

// Finds the local number of a point from its barycentric coordinates.
class LocalNumbering {
 public:
  explicit LocalNumbering(const TemplateKey& key) : whole_(2 << key.level) {
    std::uint32_t next = 4;
    for (int e = 0; e < 6; ++e) {
      edge_parts[e] = std::uint32_t{1} << (key.level + static_cast<int>(key.finer_edges >> e & 1u));
      edge_begin_[e] = next;
      next += edge_points(edge_parts[e]);
    }
    for (int f = 0; f < 4; ++f) {
      face_parts[f] = std::uint32_t{1} << (key.level + static_cast<int>(key.finer_faces >> f & 1u));
      face_begin_[f] = next;
      next += face_points(face_parts[f]);
    }
    tet_parts = std::uint32_t{1} << key.level;
    interior_begin_ = next;
    point_count = next + interior_points_count(tet_parts);
  }

  std::uint32_t number(const Barycentric& place) const {
    std::array<int, 4> used{};
    int count = 0;
    for (int i = 0; i < 4; ++i) {
      if (place[i] != 0) used[count++] = i;
    }
    const auto weight = [&](int corner, std::uint32_t parts) {
      return static_cast<std::uint32_t>(place[corner]) * parts / whole_;
    };
    if (count == 1) return static_cast<std::uint32_t>(used[0]);
    if (count == 2) {
      const int e = tet_edge(used[0], used[1]);
      return edge_begin_[e] + weight(used[1], edge_parts[e]) - 1;
    }
    if (count == 3) {
      const int f = 6 - used[0] - used[1] - used[2];
      const std::uint32_t n = face_parts[f];
      return face_begin_[f] + face_index(weight(used[1], n), weight(used[2], n), n);
    }
    return interior_begin_ + interior_index(weight(1, tet_parts), weight(2, tet_parts),
                                            weight(3, tet_parts), tet_parts);
  }

  std::array<std::uint32_t, 6> edge_parts{};
  std::array<std::uint32_t, 4> face_parts{};
  std::uint32_t tet_parts = 1;
  std::uint32_t point_count = 0;

 private:
  std::uint32_t whole_;
  std::array<std::uint32_t, 6> edge_begin_{};
  std::array<std::uint32_t, 4> face_begin_{};
  std::uint32_t interior_begin_ = 0;
};

Barycentric place_of(const Blueprint::Part& part, SplitPoint point) {
  if (point < 4) return part.corners[point];
  const auto& ends = kTetEdges[point - 4];
  Barycentric place{};
  for (int i = 0; i < 4; ++i) {
    place[i] = (part.corners[ends[0]][i] + part.corners[ends[1]][i]) / 2;
  }
  return place;
}

// The face of the lattice tet on which a face of a part lies, or −1.
int lattice_face(const Blueprint::Part& part, int face) {
  for (int f = 0; f < 4; ++f) {
    bool lies_on = true;
    for (const int corner : kTetFaces[face]) lies_on = lies_on && part.corners[corner][f] == 0;
    if (lies_on) return f;
  }
  return -1;
}

Template fill(const Blueprint& blueprint, const Choices& choices) {
  const LocalNumbering local(blueprint.key);
  Template result;
  result.edge_parts = local.edge_parts;
  result.face_parts = local.face_parts;
  result.tet_parts = local.tet_parts;
  result.point_count = local.point_count;
  for (const Blueprint::Part& part : blueprint.parts) {
    const Blueprint::Shape& shape = blueprint.shapes[part.shape];
    std::array<std::uint32_t, 10> numbers{};
    for (SplitPoint p = 0; p < 10; ++p) {
      const bool used = p < 4 || (shape.pattern.marks >> (p - 4) & 1u) != 0;
      if (used) numbers[p] = local.number(place_of(part, p));
    }
    for (const auto& tet : (*shape.splittings)[choices[part.shape]]) {
      result.tets.push_back({numbers[tet[0]], numbers[tet[1]], numbers[tet[2]], numbers[tet[3]]});
    }
    for (int face = 0; face < 4; ++face) {
      const int f = lattice_face(part, face);
      if (f < 0) continue;
      for (const auto& triangle : face_triangles(shape.pattern, face)) {
        result.face_triangles[f].push_back(
            {numbers[triangle[0]], numbers[triangle[1]], numbers[triangle[2]]});
      }
    }
  }
  for (const InteriorPoint& point : interior_points(blueprint.key.level)) {
    std::array<double, 4> weights{};
    for (int i = 0; i < 4; ++i) weights[i] = point.place[i] / double(2 << blueprint.key.level);
    result.interior_weights.push_back(weights);
    result.interior_parents.push_back(
        {local.number(point.parents[0]), local.number(point.parents[1])});
  }
  return result;
}

// Corners of the lattice's own tets, up to motion and scale: edges (0, 2) and (1, 3) are long.
const std::array<Vec3, 4> kWholeCorners = {Vec3(-1, 0, 0), Vec3(0, 1, -1), Vec3(1, 0, 0),
                                           Vec3(0, 1, 1)};

// Measures all splittings of all shapes of a blueprint, batch by batch, and takes the best.
class Fitting {
 public:
  Fitting(const Blueprint& blueprint, const std::array<Vec3, 4>& corners)
      : blueprint_(blueprint), batch_((corners[1] - corners[0]).norm()) {
    ranges_.reserve(4 * blueprint.shapes.size());
    for (const Blueprint::Shape& shape : blueprint.shapes) {
      const std::array<Vec3f, 10> points = points_of(shape, corners);
      for (const Splitting& splitting : *shape.splittings) {
        ranges_.emplace_back();
        for (const auto& tet : splitting) {
          owners_[batch_.count()] = ranges_.size() - 1;
          batch_.add(points[tet[0]], points[tet[1]], points[tet[2]], points[tet[3]]);
          if (batch_.count() == TetBatch::kCapacity) measure();
        }
      }
    }
    measure();
  }

  Fit best() const {
    Fit result;
    result.choices.reserve(blueprint_.shapes.size());
    auto next = ranges_.begin();
    for (const Blueprint::Shape& shape : blueprint_.shapes) {
      const auto begin = next, end = begin + static_cast<std::ptrdiff_t>(shape.splittings->size());
      const auto best =
          end - begin == 1 ? begin : std::max_element(begin, end, [](const auto& a, const auto& b) {
            return shape_score(a) < shape_score(b);
          });
      result.range.include(*best);
      result.choices.push_back(static_cast<std::uint8_t>(best - begin));
      next = end;
    }
    return result;
  }

 private:
  // The corners of a part of this shape and the midpoints of its edges, from its first corner.
  static std::array<Vec3f, 10> points_of(const Blueprint::Shape& shape,
                                         const std::array<Vec3, 4>& corners) {
    std::array<Vec3, 4> ends = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    for (int k = 0; k < 3; ++k) {
      for (int i = 0; i < 4; ++i) ends[k + 1] += shape.steps[k][i] * corners[i];
    }
    std::array<Vec3f, 10> points;
    for (int i = 0; i < 4; ++i) points[i] = ends[i].cast<float>();
    for (int e = 0; e < 6; ++e) {
      points[4 + e] = 0.5f * (points[kTetEdges[e][0]] + points[kTetEdges[e][1]]);
    }
    return points;
  }

  void measure() {
    std::array<float, TetBatch::kCapacity> lowest, highest;
    batch_.measure(lowest.data(), highest.data());
    for (int i = 0; i < batch_.count(); ++i) {
      ranges_[owners_[i]].include({lowest[i], highest[i]});
    }
    batch_.clear();
  }

  const Blueprint& blueprint_;
  TetBatch batch_;
  // By shape and splitting, and which of them each tet of the batch belongs to.
  std::vector<DihedralRange> ranges_;
  std::array<std::size_t, TetBatch::kCapacity> owners_;
};

}  // namespace

Fit fit(const Blueprint& blueprint, const std::array<Vec3, 4>& corners) {
  return Fitting(blueprint, corners).best();
}

TemplateLibrary::Entry& TemplateLibrary::entry(const TemplateKey& key) {
  const auto found = entries_.find(key.packed());
  if (found != entries_.end()) return found->second;
  Entry& entry = entries_[key.packed()];
  entry.blueprint = make_blueprint(key, splittings_);
  return entry;
}

const Blueprint& TemplateLibrary::blueprint(const TemplateKey& key) { return entry(key).blueprint; }

const TemplateLibrary::WholeTemplate& TemplateLibrary::whole(const TemplateKey& key) {
  WholeTemplate& whole = entry(key).whole;
  if (whole.filled == nullptr) {
    const Fit best = fit(blueprint(key), kWholeCorners);
    whole = {&filled(key, best.choices), best.range};
  }
  return whole;
}

const Template& TemplateLibrary::filled(const TemplateKey& key, const Choices& choices) {
  Entry& here = entry(key);
  const auto found = here.templates.find(choices);
  if (found != here.templates.end()) return found->second;
  return here.templates.emplace(choices, fill(here.blueprint, choices)).first->second;
}

}  // namespace tissue
