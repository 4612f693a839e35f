#pragma once

#include "blueprint.h"
#include "tissue/base/quality.h"

#include <unordered_map>
#include <vector>

namespace tissue {

/// Which of its splittings each shape of a blueprint takes.
using Choices = std::vector<std::uint8_t>;

/// A filled lattice tet. Its points are numbered locally: the four corners, the points inside each
/// edge (from its lower corner), inside each face (by face_index), inside the tet.
struct Template {
  /// Parts into which each edge and face is divided.
  std::array<std::uint32_t, 6> edge_parts;
  std::array<std::uint32_t, 4> face_parts;
  std::uint32_t tet_parts;
  std::uint32_t point_count;
  std::vector<std::array<std::uint32_t, 4>> tets;
  /// The triangles on each face of the lattice tet, outward.
  std::array<std::vector<std::array<std::uint32_t, 3>>, 4> face_triangles;
  /// Barycentric weights and parents of the points inside the tet.
  std::vector<std::array<double, 4>> interior_weights;
  std::vector<std::array<std::uint32_t, 2>> interior_parents;
};

/// The best splittings for a lattice tet with these corners, and the angles they give.
struct Fit {
  Choices choices;
  DihedralRange range;
};
Fit fit(const Blueprint& blueprint, const std::array<Vec3, 4>& corners);

/// Makes every blueprint and template once.
class TemplateLibrary {
 public:
  const Blueprint& blueprint(const TemplateKey& key);
  const Template& filled(const TemplateKey& key, const Choices& choices);
  /// The best filling of a tet with the lattice's own shape.
  struct WholeTemplate {
    const Template* filled = nullptr;
    DihedralRange range;
  };
  const WholeTemplate& whole(const TemplateKey& key);

 private:
  // FNV-1a.
  struct HashOfBytes {
    std::size_t operator()(const Choices& bytes) const {
      std::uint64_t hash = 14695981039346656037u;
      for (const std::uint8_t byte : bytes) hash = (hash ^ byte) * 1099511628211u;
      return hash;
    }
  };
  struct Entry {
    Blueprint blueprint;
    WholeTemplate whole;
    std::unordered_map<Choices, Template, HashOfBytes> templates;
  };
  Entry& entry(const TemplateKey& key);
  Splittings splittings_;
  std::unordered_map<std::uint32_t, Entry> entries_;
};

}  // namespace tissue
