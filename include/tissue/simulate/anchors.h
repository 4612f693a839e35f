#pragma once

#include "tissue/simulate/body.h"

#include <array>
#include <optional>
#include <variant>
#include <vector>

namespace tissue {

/// A coordinate [m], or a fraction of the way across the body's bounding box.
struct Coordinate {
  double value = 0.0;
  bool is_fraction = false;
  double within(double low, double high) const {
    return is_fraction ? low + value * (high - low) : value;
  }
};
using CoordinateTriple = std::array<Coordinate, 3>;

/// What is on one side of a plane across an axis.
struct PlaneAnchor {
  int axis = 2;
  std::optional<Coordinate> below, above;
  /// Of a soft bed on which only the surface rests: pressure for each metre by which it gives
  /// [Pa/m]. 0: all there is held fast.
  double stiffness = 0.0;
};
struct BoxAnchor {
  CoordinateTriple low, high;
};
/// A fraction as radius is one of the bounding box's diagonal.
struct SphereAnchor {
  CoordinateTriple centre;
  Coordinate radius;
};
/// Vertices of this density: of one label of a labelled volume.
struct LabelAnchor {
  double density = 0.0;
};
struct VertexAnchor {
  std::vector<std::uint32_t> vertices;
};
/// Part of a body that does not move, or on a bed not much.
using Anchor = std::variant<PlaneAnchor, BoxAnchor, SphereAnchor, LabelAnchor, VertexAnchor>;

/// Who holds a vertex that nobody holds.
constexpr int kNobody = -1;

/// For each vertex the number of the first anchor that holds it fast, or kNobody. Throws InputError
/// E_SCENE for an anchor that reaches no vertex.
std::vector<int> anchors_of_vertices(const Body& body, const std::vector<Anchor>& anchors);

/// Whether it is a soft bed.
bool is_bed(const Anchor& anchor);

/// A soft bed: what lies between two planes across an axis.
struct Bed {
  std::size_t anchor = 0;
  int axis = 2;
  /// [m]
  double low = 0.0, high = 0.0;
  /// [Pa/m]
  double stiffness = 0.0;
  bool reaches(const Vec3& place) const { return place[axis] > low && place[axis] < high; }
};
/// Those of the anchors that are soft beds.
std::vector<Bed> beds_of(const Body& body, const std::vector<Anchor>& anchors);

/// Throws InputError E_UNCONSTRAINED unless every connected part of the body has three held
/// vertices that do not lie on a line (of the surface, where it lies on a bed): without them it has
/// no equilibrium of its own. The sentence lists the parts.
void require_held(const Body& body, const std::vector<int>& holders,
                  const std::vector<Bed>& beds = {});

}  // namespace tissue
