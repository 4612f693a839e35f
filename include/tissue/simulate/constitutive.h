#pragma once

#include "tissue/base/types.h"
#include "tissue/simulate/lanes.h"

namespace tissue {

using Mat9 = Eigen::Matrix<double, 9, 9>;

/// Lamé's constants [Pa].
struct Lame {
  double mu = 0.0, lambda = 0.0;
};

/// Of a pack of elements.
struct LameLanes {
  Lanes mu = {}, lambda = {};
};

/// From Young's modulus [Pa] and Poisson's ratio below 1/2.
Lame lame_of(double young, double poisson);

/// How tissue answers a deformation gradient F: small strain, co-rotated small strain, or stable
/// neo-Hookean.
enum class Constitution { kLinear, kCorotational, kNeoHookean };

/// Energy per rest volume [J/m³] and what follows from it.
///
/// kLinear: μ ε:ε + λ/2 tr²ε with ε = sym(F) − I.
/// kCorotational: μ ‖F − R‖² + λ/2 tr²(RᵀF − I) with the rotation R nearest to F (det R = +1 also
/// for F that turns a tet inside out).
/// kNeoHookean: μ'/2 (I_C − 3) + λ'/2 (J − α)² − μ'/2 log(I_C + 1), less its value at rest; Smith,
/// de Goes, Kim, Stable Neo-Hookean Flesh Simulation, ACM TOG 37(2), 2018, Eq. 14, with μ' = 4μ/3
/// and λ' = λ + 5μ/6 so that small strains cost the same as in the other two (section 3.4 there).
/// Finite for every F.
double energy_density(Constitution constitution, const Lame& lame, const Mat3& f);

/// dψ/dF, the first Piola–Kirchhoff stress [Pa].
Mat3 stress(Constitution constitution, const Lame& lame, const Mat3& f);

/// d²ψ/dF², F taken column by column [Pa].
Mat9 stiffness(Constitution constitution, const Lame& lame, const Mat3& f);

/// The same with its negative eigenvalues set to zero, so that Newton's steps go downhill.
Mat9 convex_stiffness(Constitution constitution, const Lame& lame, const Mat3& f);

/// R of F = R S, a rotation also where F is singular or turned inside out.
Mat3 nearest_rotation(const Mat3& f);

}  // namespace tissue
