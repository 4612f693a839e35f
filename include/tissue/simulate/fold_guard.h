#pragma once

#include "tissue/simulate/push_field.h"

namespace tissue {

/// How far a push field can be driven before a tet folds. All vertices move along one direction n,
/// so a tet's deformation gradient is I + A n ⊗ ∇w with det F = 1 + A n·∇w: linear in the amplitude
/// A, and the limit is exact.
class FoldGuard {
 public:
  FoldGuard(const Body& body, const PushField<float>& field);

  /// A* [m]: the amplitude along the unit vector `n` at which the first tet becomes flat; infinite
  /// if none ever does.
  double limit(const Vec3& n) const;
  std::size_t bytes() const { return gradients_.capacity() * sizeof(Vec3); }

 private:
  // ∇w in every tet in which the weights differ [1/m].
  std::vector<Vec3> gradients_;
};

}  // namespace tissue
