#pragma once

#include "tissue/base/run.h"
#include "tissue/base/tet_mesh.h"
#include "tissue/field/implicit_surface.h"
#include "tissue/lattice/stuffing.h"
#include "tissue/refine/levels.h"
#include "tissue/refine/project_boundary.h"

#include <functional>
#include <map>
#include <memory>
#include <optional>

namespace tissue {

/// What decides where a mesh is fine.
enum class Method {
  /// The softer the tissue, the finer (Eqs. 1 to 6).
  kDensity,
  /// One level: the lattice itself.
  kUniform,
  /// Fine at the boundary, coarse inside, blind to density (Park and Choi).
  kSurface,
  /// As fine as somebody else says, who has looked at where each tet of the lattice lies.
  kWished,
};

/// By the names that people use: density, uniform, surface, and strain for `kWished`.
std::optional<Method> method_named(const std::string& name);
/// All of them, in a sentence.
const char* method_names();

/// The level that each tet of the lattice is to have, where its vertices lie in the world [m].
using LevelWishes =
    std::function<std::vector<std::uint8_t>(const std::vector<Vec3>&, const std::vector<Tet>&)>;

/// What to make of a volume. The only place where the mesher's defaults stand.
struct MeshOptions {
  Method method = Method::kDensity;
  /// Values above this are organ, where there is no mask.
  double iso_value = 20.0;
  /// Long edge of the lattice [m]: halving it makes about eight times as many tets. 0: chosen so
  /// that the mesh has `target_tetrahedra`, or else the lattice `initial_tetrahedra`.
  double spacing = 0.0;
  /// Tets of the whole mesh, met within 2 % and mostly within 0.2 %, by choice of spacing and
  /// offset of the lattice. 0: not asked for.
  std::uint64_t target_tetrahedra = 0;
  /// Tets of the uniform stage (nTinit), met within 2 %. Used where the two above are 0.
  std::uint32_t initial_tetrahedra = 40000;
  LevelOptions levels;
  /// For `kWished`.
  LevelWishes wishes;
  /// Tets that straddle a jump of density take the level of their softest corner.
  bool keep_interfaces = false;
  /// Move boundary vertices onto the isosurface.
  bool project_boundary = true;
  ProjectionOptions projection;
  /// Values that map to density 0 and to d_max. Without them: the identity if all values lie in
  /// [0, d_max], else the range inside the organ.
  std::optional<std::array<double, 2>> window;
  /// Density of each label of a label volume; empty: labels are densities.
  std::map<std::int64_t, double> label_densities;
  /// Component to keep; a place is in the world [m].
  Component component;
  /// Stop after the uniform stage.
  bool lattice_only = false;
  /// More tets than this are refused before they are allocated; so is what would not fit into the
  /// memory that the machine has left.
  std::uint64_t max_tetrahedra = 100000000;
};

/// A mesh, and for the uniform stage what levels came from.
struct BuiltMesh {
  TetMesh mesh;
  /// With `lattice_only`: T_i of each tet (after smoothing), the level of Eq. 6, and the level
  /// after raising (the mesh's own levels are these).
  std::vector<double> lattice_densities;
  std::vector<std::uint8_t> level_wishes;
};

/// From a volume to a conforming mesh, fine where tissue is soft. The organ is what `surface`
/// bounds, whose field lies on the volume's grid.
///
/// Throws InputError: E_PARAM, E_N, E_NTINIT, E_TOO_MANY_TETS, E_NOMEM, E_TOO_SMALL, E_CANCELLED,
/// E_SIZE_MISMATCH if the surface's field lies on another grid than the volume.
BuiltMesh build_mesh(const std::shared_ptr<const Volume>& volume, const ImplicitSurface& surface,
                     const MeshOptions& options, const Run& run = {});

/// The same for the organ where `mask` is set, or without one where the volume exceeds `iso_value`.
/// Throws E_EMPTY_SURFACE too.
BuiltMesh build_mesh(const std::shared_ptr<const Volume>& volume,
                     const std::shared_ptr<const Volume>& mask, const MeshOptions& options,
                     const Run& run = {});

/// How many tets build_mesh() would make, found without making them; the densities decide what they
/// decide there. Throws as build_mesh().
std::uint64_t planned_tetrahedra(const std::shared_ptr<const Volume>& volume,
                                 const ImplicitSurface& surface, const MeshOptions& options,
                                 const Run& run = {});

}  // namespace tissue
