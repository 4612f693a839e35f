#pragma once

#include "tissue/simulate/body.h"
#include "tissue/simulate/material.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace tissue_test {

/// What hard cases of simulation are tried on: a body with a tumour in its middle, whose lowest
/// part is held. Tets of the tumour have density 2, others 1.
struct Subject {
  const char* name;
  std::shared_ptr<const tissue::Body> body;
  /// Its extent along x [m], and where it ends along z.
  double size, top;
  /// Vertices below this z are held [m].
  double held_below;
};

/// A uniform block of 40 mm, and a density-refined ball of 30 mm radius in tets of three levels.
const std::vector<Subject>& subjects();

/// In the middle of what is on top.
tissue::Vec3 top_of(const Subject& subject);

/// The block, with one tet so flat that its smallest dihedral angle is 0.1°.
Subject block_with_a_sliver();

/// Soft tissue of 10 kPa, with a tumour that is `contrast` times as stiff.
struct Tissue {
  double contrast, poisson;

  tissue::Material material() const;
  /// The same for a scene: its lines `material` and `anchors`.
  std::string scene(const Subject& subject) const;
};

inline constexpr double kContrasts[] = {1.0, 1e2, 1e4, 1e6};

/// Calls check(subject, tissue) for both subjects, all contrasts and the given Poisson's ratios.
template <class Check>
void for_each_tissue(std::initializer_list<double> poissons, const Check& check) {
  for (const Subject& subject : subjects()) {
    for (const double contrast : kContrasts) {
      for (const double poisson : poissons) {
        SCOPED_TRACE(std::string(subject.name) + ", contrast " + std::to_string(contrast) +
                     ", Poisson's ratio " + std::to_string(poisson));
        check(subject, Tissue{contrast, poisson});
      }
    }
  }
}

}  // namespace tissue_test
