#pragma once

#include "tissue/base/stage_clock.h"
#include "tissue/field/density_window.h"
#include "tissue/refine/build_mesh.h"
#include "vertex_blocks.h"

namespace tissue {

/// What meshes are made from.
struct Organ {
  const Volume& volume;
  const ImplicitSurface& surface;
  DensityWindow window;
};

/// Everything about a mesh that is decided before it is allocated.
struct MeshDesign {
  RefinableLattice lattice;
  /// At the lattice's vertices.
  std::vector<float> densities;
  /// T_i of each lattice tet, after smoothing.
  std::vector<double> tet_means;
  std::vector<std::uint32_t> thresholds;
  /// The level that each lattice tet asks for, and after raising (for `lattice_only`).
  std::vector<std::uint8_t> wishes, levels;
  /// Empty where no tet is refined.
  RefinementPlan plan;
  VertexBlocks blocks;
  bool refined = false;
  /// Tets that will come out.
  std::uint64_t tetrahedra = 0;
};

/// Stuffs the organ, assigns levels and plans the refinement. The templates live in `library`.
/// Throws InputError as build_mesh().
MeshDesign design_mesh(const Organ& organ, const StuffingOptions& stuffing,
                       const MeshOptions& options, TemplateLibrary& library, StageClock& clock,
                       const Run& run);

}  // namespace tissue
