#include "material_tensor.h"

namespace tissue {
namespace {

using Matrix = LaneMatrix<Lanes>;

// Parameters of the stable energy that give small strains the stiffness of Lamé's.
struct StableParameters {
  Lanes mu, lambda, alpha;
  explicit StableParameters(const LameLanes& lame)
      : mu(4.0 / 3.0 * lame.mu),
        lambda(lame.lambda + 5.0 / 6.0 * lame.mu),
        alpha(1.0 + 0.75 * mu / lambda) {}
};

// In the plane of each pair of axes the energy has one eigenvalue for the flip and one for the
// twist.
void set_flip_and_twist(int k, Lanes flip, Lanes twist, bool convex, MaterialTensor& tensor) {
  if (convex) {
    flip = larger(flip, Lanes{});
    twist = larger(twist, Lanes{});
  }
  tensor.own[k] = 0.5 * (flip + twist);
  tensor.crossed[k] = 0.5 * (flip - twist);
}

// The nearest positive semidefinite matrix.
void make_convex(Matrix& symmetric) {
  const Matrix axes = diagonalise(symmetric);
  Matrix scaled;
  for_entries([&](int i, int j) { scaled[i][j] = axes[i][j] * larger(symmetric[j][j], Lanes{}); });
  symmetric = product_transpose(scaled, axes);
}

// What small strain is stiff by, and other energies in the frame of their stretches.
void set_linear(const LameLanes& lame, MaterialTensor& tensor) {
  for (int i = 0; i < 3; ++i) tensor.own[i] = tensor.crossed[i] = lame.mu;
  for_entries([&](int i, int j) {
    tensor.scaling[i][j] = i == j ? lame.lambda + 2.0 * lame.mu : lame.lambda;
  });
}

Lanes linear(const LameLanes& lame, const Matrix& f, Matrix* stress, MaterialTensor* stiffness,
             bool) {
  Matrix strain;
  for_entries(
      [&](int i, int j) { strain[i][j] = 0.5 * (f[i][j] + f[j][i]) - (i == j ? 1.0 : 0.0); });
  const Lanes longer = strain[0][0] + strain[1][1] + strain[2][2];
  if (stress != nullptr) {
    for_entries([&](int i, int j) {
      (*stress)[i][j] = 2.0 * lame.mu * strain[i][j];
      if (i == j) (*stress)[i][j] += lame.lambda * longer;
    });
  }
  if (stiffness != nullptr) {
    stiffness->u = stiffness->v = identity();
    set_linear(lame, *stiffness);
  }
  return lame.mu * dot(strain, strain) + 0.5 * lame.lambda * longer * longer;
}

Lanes corotational(const LameLanes& lame, const Matrix& f, Matrix* stress,
                   MaterialTensor* stiffness, bool convex) {
  Stretches stretches;
  Matrix rotation;
  if (stiffness != nullptr) {
    stretches = stretches_of(f);
    rotation = product_transpose(stretches.u, stretches.v);
  } else {
    rotation = rotation_of(f);
  }
  const Lanes longer = dot(rotation, f) - 3.0, pressure = lame.lambda * longer;
  Lanes squares = {};
  for_entries([&](int i, int j) {
    const Lanes off = f[i][j] - rotation[i][j];
    squares += off * off;
    if (stress != nullptr) (*stress)[i][j] = 2.0 * lame.mu * off + pressure * rotation[i][j];
  });
  if (stiffness != nullptr) {
    stiffness->u = stretches.u;
    stiffness->v = stretches.v;
    set_linear(lame, *stiffness);
    const Lanes* const sigma = stretches.sigma;
    const Lanes flip = 2.0 * lame.mu, sum = sigma[0] + sigma[1] + sigma[2];
    Lanes least = all_lanes(1.0);
    for (int i = 0; i < 3; ++i) least = larger(least, larger(sigma[i], -sigma[i]));
    least *= 1e-9;
    for (int k = 0; k < 3; ++k) {
      // The rotation is not defined where two stretches cancel; there any steep value will do.
      Lanes both = sum - sigma[k];
      both = both < 0.0 ? (both > -least ? -least : both) : larger(both, least);
      set_flip_and_twist(k, flip, flip + 2.0 * (pressure - flip) / both, convex, *stiffness);
    }
  }
  return lame.mu * squares + 0.5 * pressure * longer;
}

Lanes neo_hookean(const LameLanes& lame, const Matrix& f, Matrix* stress, MaterialTensor* stiffness,
                  bool convex) {
  const StableParameters p(lame);
  const Matrix cofactors = cofactor(f);
  const Lanes squares = dot(f, f), volume = determinant(f, cofactors);
  const Lanes rest = squares + 1.0, pressure = p.lambda * (volume - p.alpha);
  const Lanes shear = p.mu * (1.0 - 1.0 / rest);
  if (stress != nullptr) {
    for_entries(
        [&](int i, int j) { (*stress)[i][j] = shear * f[i][j] + pressure * cofactors[i][j]; });
  }
  if (stiffness != nullptr) {
    const Stretches stretches = stretches_of(f);
    const Lanes* const sigma = stretches.sigma;
    stiffness->u = stretches.u;
    stiffness->v = stretches.v;
    const Lanes minors[] = {sigma[1] * sigma[2], sigma[2] * sigma[0], sigma[0] * sigma[1]};
    for_entries([&](int i, int j) {
      stiffness->scaling[i][j] = 2.0 * p.mu / (rest * rest) * sigma[i] * sigma[j] +
                                 p.lambda * minors[i] * minors[j] +
                                 (i == j ? shear : Lanes(pressure * sigma[(6 - i - j) % 3]));
    });
    for (int k = 0; k < 3; ++k) {
      const Lanes turn = pressure * sigma[k];
      set_flip_and_twist(k, shear - turn, shear + turn, convex, *stiffness);
    }
    if (convex) make_convex(stiffness->scaling);
  }
  const auto at = [&](const Lanes& squared, const Lanes& j) -> Lanes {
    Lanes logarithm = squared;
    for (std::size_t i = 0; i < kLanes; ++i) logarithm[i] = std::log(squared[i] + 1.0);
    return 0.5 * p.mu * (squared - 3.0 - logarithm) +
           0.5 * p.lambda * (j - p.alpha) * (j - p.alpha);
  };
  return at(squares, volume) - at(all_lanes(3.0), all_lanes(1.0));
}

}  // namespace

Respond law_of(Constitution constitution) {
  switch (constitution) {
    case Constitution::kLinear: return linear;
    case Constitution::kCorotational: return corotational;
    case Constitution::kNeoHookean: break;
  }
  return neo_hookean;
}

}  // namespace tissue
