#pragma once

#include "template_library.h"
#include "tissue/refine/refine.h"

#include <vector>

namespace tissue {

/// How every lattice tet will be filled: decided completely before anything is allocated.
struct RefinementPlan {
  std::vector<std::uint8_t> levels;
  /// The highest level around each lattice edge and face.
  std::vector<std::uint8_t> edge_levels;
  std::vector<std::uint8_t> face_levels;
  std::vector<const Template*> templates;
  /// Angles of the parts of whole and of cut lattice tets.
  DihedralRange whole_dihedral, cut_dihedral;
  std::size_t tets_promoted = 0;
};

/// The templates live in `library`.
RefinementPlan plan_refinement(const RefinableLattice& lattice, std::vector<std::uint8_t> levels,
                               TemplateLibrary& library, const Run& run);

}  // namespace tissue
