#pragma once

#include "tissue/base/tet_mesh.h"
#include "tissue/simulate/constitutive.h"

#include <array>
#include <optional>

namespace tissue_test {

/// A solid, or without a constitution springs on the edges.
using Tissue = std::optional<tissue::Constitution>;

/// Mean sag [m] of the free end of a clamped beam of 0.2 × 0.1 × 0.1 m of E = 50 kPa, ν = 0.45 and
/// 1000 kg/m³, `cells` cubes along each axis of six Kuhn tets each. Throws std::runtime_error where
/// there is no equilibrium.
double beam_sag(const std::array<int, 3>& cells, int order, const Tissue& tissue);

/// Small displacements of a ball of outer radius b, whose surface moves out by U, with a tumour of
/// radius a in its middle (e r inside, A r + B/r² outside).
class TumourSphere {
 public:
  TumourSphere(double radius, double outer_radius, double moved, const tissue::Lame& tissue,
               const tissue::Lame& tumour);
  tissue::Vec3 displacement(const tissue::Vec3& place) const;

 private:
  double radius_, inner_, a_, b_;
};

/// How far the displacements are, in relative L2 norm over the nodes, from the exact ones of a
/// tumour 20 times as stiff as the tissue around it: a ball of 10 mm in the middle of a ball,
/// `mesh`, whose surface moves out by 0.1 mm. Throws as beam_sag().
double tumour_sphere_error(const tissue::TetMesh& mesh, int order, const Tissue& tissue);

}  // namespace tissue_test
