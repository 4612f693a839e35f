#pragma once

#include "tissue/simulate/lanes.h"

namespace tissue {

/// F = U diag(σ) Vᵀ with rotations U and V; one σ is negative where F turns inside out.
struct Stretches {
  LaneMatrix<Lanes> u, v;
  Lanes sigma[3];
};
Stretches stretches_of(const LaneMatrix<Lanes>& f);

/// R of F = R S, a rotation also where F is singular or turned inside out.
LaneMatrix<Lanes> rotation_of(const LaneMatrix<Lanes>& f);

/// A symmetric matrix is made diagonal; the columns of the result are its axes, right-handed.
LaneMatrix<Lanes> diagonalise(LaneMatrix<Lanes>& symmetric);

}  // namespace tissue
