#pragma once

#include "tissue/refine/build_mesh.h"
#include "tissue/simulate/pose_path.h"

namespace tissue {

/// What strains a body: a scene and what its tools do.
struct SceneMotion {
  SceneDescription scene;
  std::vector<Instant> instants;
};

/// How hard each tet of a body is to get right: by Zienkiewicz and Zhu's estimate (1987) of the
/// error of its strain, the square of what the error in energy density would be [J/m³] if the tet
/// were a metre long. Displacement gradients, averaged at the vertices by volume, stand for the
/// exact ones. `young` is one modulus [Pa] per tet.
std::vector<double> strain_difficulty(const Body& body, const std::vector<Vec3>& positions,
                                      const std::vector<double>& young);

/// A mesh that is fine where the scene strains the tissue in a way that linear tets cannot follow.
/// A pilot mesh goes through the scene; its estimates of the error, summed over the instants, say
/// where `target_tetrahedra` tets do most good, and the lattice is given those levels, of which
/// there are `levels.sections`. Densities decide nothing. Stages of the statistics: that of the
/// pilot is `pilot`, that of fitting the total `search`.
///
/// Throws InputError as build_mesh() and Scene; E_PARAM without `target_tetrahedra`, E_SCENE where
/// the scene moves nothing.
BuiltMesh build_strain_mesh(const std::shared_ptr<const Volume>& volume,
                            const ImplicitSurface& surface, const MeshOptions& options,
                            const SceneMotion& motion, const Run& run = {});

}  // namespace tissue
