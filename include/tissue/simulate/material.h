#pragma once

#include "tissue/simulate/body.h"
#include "tissue/simulate/constitutive.h"

#include <array>
#include <vector>

namespace tissue {

/// What tissue is made of, by its density.
struct Material {
  /// Rows of density and Young's modulus [Pa], densities rising; linear between rows and constant
  /// beyond them.
  std::vector<std::array<double, 2>> young = {{0.0, 3e3}};
  double poisson = 0.45;
  /// [kg/m³]
  double mass_density = 1000.0;

  double young_at(double density) const;
};

/// Young's modulus [Pa] of each tet by its mean density. Throws InputError E_PARAM if the material
/// differs by density and the body does not say its tets' densities.
std::vector<double> young_of(const Material& material, const Body& body);

/// The same as Lamé's constants.
std::vector<Lame> lame_of(const Material& material, const Body& body);

}  // namespace tissue
