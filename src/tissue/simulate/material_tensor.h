#pragma once

#include "stretches.h"
#include "tissue/simulate/constitutive.h"

namespace tissue {

/// d²ψ/dF² of an isotropic energy, of which negative eigenvalues may have been taken away, in terms
/// of the stretches F = U diag(σ) Vᵀ: Kim and Eberle, Dynamic Deformables, SIGGRAPH 2020 Courses,
/// section 7. What Uᵀ dF V has on the diagonal is multiplied by `scaling`; its entries (i, j) and
/// (j, i), which leave axis k out, by `own[k]` each and by `crossed[k]` the one for the other.
template <class L>
struct MaterialTensorOf {
  LaneMatrix<L> u, v, scaling;
  L own[3], crossed[3];
};
using MaterialTensor = MaterialTensorOf<Lanes>;

template <class L>
void scale(MaterialTensorOf<L>& tensor, const L& factor) {
  for_entries([&](int i, int j) { tensor.scaling[i][j] *= factor; });
  for (int k = 0; k < 3; ++k) {
    tensor.own[k] *= factor;
    tensor.crossed[k] *= factor;
  }
}

/// ψ [J/m³] and, where they are asked for, dψ/dF [Pa] and d²ψ/dF² [Pa], the latter without negative
/// eigenvalues if `convex`.
using Respond = Lanes (*)(const LameLanes& lame, const LaneMatrix<Lanes>& f,
                          LaneMatrix<Lanes>* stress, MaterialTensor* stiffness, bool convex);
Respond law_of(Constitution constitution);

/// The stress that a change of F makes.
template <class L>
__attribute__((always_inline)) inline LaneMatrix<L> product(const MaterialTensorOf<L>& tensor,
                                                            const LaneMatrix<L>& change) {
  const LaneMatrix<L> turned = product(transpose_product(tensor.u, change), tensor.v);
  LaneMatrix<L> answer;
  for (int i = 0; i < 3; ++i) {
    answer[i][i] = tensor.scaling[i][0] * turned[0][0] + tensor.scaling[i][1] * turned[1][1] +
                   tensor.scaling[i][2] * turned[2][2];
    for (int j = 0; j < 3; ++j) {
      if (i == j) continue;
      const int k = 3 - i - j;
      answer[i][j] = tensor.own[k] * turned[i][j] + tensor.crossed[k] * turned[j][i];
    }
  }
  return product_transpose(product(tensor.u, answer), tensor.v);
}

/// Vᵀ γ of a shape gradient.
template <class L>
void turn(const MaterialTensorOf<L>& tensor, const L* gradient, L* result) {
  for (int k = 0; k < 3; ++k) {
    result[k] =
        tensor.v[0][k] * gradient[0] + tensor.v[1][k] * gradient[1] + tensor.v[2][k] * gradient[2];
  }
}

/// γ_aᵀ (d²ψ/dF²) γ_b as a 3×3 matrix, for shape gradients that are turned, is added to `block`.
template <class L>
void add_coupling(const MaterialTensorOf<L>& tensor, const L* a, const L* b, LaneMatrix<L>& block) {
  LaneMatrix<L> turned;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    turned[i][i] = tensor.scaling[i][i] * (a[i] * b[i]) + tensor.own[k] * (a[j] * b[j]) +
                   tensor.own[j] * (a[k] * b[k]);
    turned[i][j] = tensor.scaling[i][j] * (a[i] * b[j]) + tensor.crossed[k] * (a[j] * b[i]);
    turned[j][i] = tensor.scaling[j][i] * (a[j] * b[i]) + tensor.crossed[k] * (a[i] * b[j]);
  }
  const LaneMatrix<L> half = product(tensor.u, turned);
  for_entries([&](int i, int j) {
    block[i][j] +=
        half[i][0] * tensor.u[j][0] + half[i][1] * tensor.u[j][1] + half[i][2] * tensor.u[j][2];
  });
}

}  // namespace tissue
