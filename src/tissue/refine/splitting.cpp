#include "splitting.h"

#include <algorithm>

namespace tissue {
namespace {

using Face = std::array<SplitPoint, 3>;

SplitPoint midpoint(int a, int b) { return static_cast<SplitPoint>(4 + tet_edge(a, b)); }

bool marked(const SplitPattern& pattern, int a, int b) {
  return (pattern.marks >> tet_edge(a, b) & 1u) != 0;
}

// Twice the coordinates in the tet (0,0,0) (1,0,0) (0,1,0) (0,0,1), so that all are whole.
std::array<int, 3> coordinates(SplitPoint point) {
  std::array<int, 3> result = {0, 0, 0};
  const auto add = [&](int corner, int weight) {
    if (corner > 0) result[corner - 1] += weight;
  };
  if (point < 4) {
    add(point, 2);
  } else {
    add(kTetEdges[point - 4][0], 1);
    add(kTetEdges[point - 4][1], 1);
  }
  return result;
}

// Of the reference tet itself, in doubled coordinates.
constexpr int kWholeDeterminant = 8;

int determinant(const std::array<SplitPoint, 4>& tet) {
  const auto origin = coordinates(tet[0]);
  int m[3][3];
  for (int i = 0; i < 3; ++i) {
    const auto corner = coordinates(tet[i + 1]);
    for (int j = 0; j < 3; ++j) m[i][j] = corner[j] - origin[j];
  }
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

Face rotated(Face face) {
  std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
  return face;
}

// Closes a front: `open` holds the faces, outward, that some tet still has to have. The tet at a
// given face is unique in every splitting, so taking always the first face finds each just once.
class Search {
 public:
  explicit Search(unsigned marks) {
    for (SplitPoint p = 0; p < 4; ++p) points_.push_back(p);
    for (int e = 0; e < 6; ++e) {
      if ((marks >> e & 1u) != 0) points_.push_back(static_cast<SplitPoint>(4 + e));
    }
  }

  void close(std::vector<Face> open, int volume) {
    if (open.empty()) {
      if (volume == 0) found_.push_back(tets_);
      return;
    }
    const Face face = *std::min_element(open.begin(), open.end());
    for (const SplitPoint apex : points_) {
      const std::array<SplitPoint, 4> tet = {face[0], face[2], face[1], apex};
      const int det = determinant(tet);
      if (det <= 0 || det > volume) continue;
      std::vector<Face> next = open;
      if (!place(tet, next)) continue;
      tets_.push_back(tet);
      close(std::move(next), volume - det);
      tets_.pop_back();
    }
  }

  std::vector<Splitting> take() { return std::move(found_); }

 private:
  // Takes the tet's faces from the front, or puts their backs into it. False if that needs a face
  // twice.
  static bool place(const std::array<SplitPoint, 4>& tet, std::vector<Face>& open) {
    for (const auto& corners : kOutwardFaces) {
      const Face face = rotated({tet[corners[0]], tet[corners[1]], tet[corners[2]]});
      const auto here = std::find(open.begin(), open.end(), face);
      if (here != open.end()) {
        open.erase(here);
        continue;
      }
      const Face back = rotated({face[0], face[2], face[1]});
      if (std::find(open.begin(), open.end(), back) != open.end()) return false;
      open.push_back(back);
    }
    return true;
  }

  std::vector<SplitPoint> points_;
  Splitting tets_;
  std::vector<Splitting> found_;
};

}  // namespace

std::vector<Face> face_triangles(const SplitPattern& pattern, int face) {
  const std::array<int, 3>& c = kOutwardFaces[face];
  const auto corner = [&](int i) { return static_cast<SplitPoint>(c[i % 3]); };
  const auto middle = [&](int i) { return midpoint(c[i % 3], c[(i + 1) % 3]); };
  std::array<bool, 3> halved{};
  int count = 0;
  for (int i = 0; i < 3; ++i) {
    halved[i] = marked(pattern, c[i], c[(i + 1) % 3]);
    count += halved[i];
  }
  if (count == 0) return {{corner(0), corner(1), corner(2)}};
  if (count == 3) {
    return {{corner(0), middle(0), middle(2)},
            {corner(1), middle(1), middle(0)},
            {corner(2), middle(2), middle(1)},
            {middle(0), middle(1), middle(2)}};
  }
  if (count == 1) {
    const int i = halved[0] ? 0 : halved[1] ? 1 : 2;
    return {{corner(i), middle(i), corner(i + 2)}, {middle(i), corner(i + 1), corner(i + 2)}};
  }
  // Two halved edges meet at corner z; a and b follow it counter-clockwise.
  const int z = !halved[0] ? 2 : !halved[1] ? 0 : 1;
  const SplitPoint a = corner(z + 1), b = corner(z + 2), za = middle(z), zb = middle(z + 2);
  if (pattern.diagonal_start[face] == a) return {{corner(z), za, zb}, {za, a, zb}, {a, b, zb}};
  return {{corner(z), za, zb}, {za, a, b}, {za, b, zb}};
}

std::vector<Splitting> splittings(const SplitPattern& pattern) {
  std::vector<Face> open;
  for (int face = 0; face < 4; ++face) {
    for (const Face& triangle : face_triangles(pattern, face)) open.push_back(rotated(triangle));
  }
  Search search(pattern.marks);
  search.close(std::move(open), kWholeDeterminant);
  return search.take();
}

const std::vector<Splitting>& Splittings::of(const SplitPattern& pattern) {
  const auto [entry, is_new] = known_.try_emplace({pattern.marks, pattern.diagonal_start});
  if (is_new) entry->second = splittings(pattern);
  return entry->second;
}

}  // namespace tissue
