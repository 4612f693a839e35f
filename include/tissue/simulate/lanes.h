#pragma once

#include <cmath>
#include <cstddef>

namespace tissue {

/// What is computed for many elements is computed for a few at once, one in each lane of a wide
/// register.
constexpr std::size_t kLanes = 4;
using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));
/// Twice as many in single precision.
constexpr std::size_t kFloatLanes = 8;
using FloatLanes = float __attribute__((vector_size(kFloatLanes * sizeof(float))));

template <class L>
constexpr std::size_t lane_count() {
  return sizeof(L) / sizeof(L{}[0]);
}

/// The same number in all lanes.
template <class L = Lanes>
inline L all_lanes(double value) {
  return L{} + static_cast<decltype(L{}[0] + L{}[0])>(value);
}

template <class L>
inline L square_root(const L& x) {
  L result = x;
  for (std::size_t i = 0; i < lane_count<L>(); ++i) result[i] = std::sqrt(x[i]);
  return result;
}
template <class L>
inline L larger(const L& a, const L& b) {
  return a > b ? a : b;
}
/// Whether a comparison holds in any lane.
template <class Mask>
inline bool any(const Mask& mask) {
  bool found = false;
  for (std::size_t i = 0; i < lane_count<Mask>(); ++i) found = found || mask[i] != 0;
  return found;
}
template <class L>
inline double sum_of(const L& x) {
  double sum = 0.0;
  for (std::size_t i = 0; i < lane_count<L>(); ++i) sum += x[i];
  return sum;
}

/// A 3×3 matrix in each lane, or three rows of vectors.
template <class L>
struct LaneMatrix {
  L at[3][3];
  L* operator[](int row) { return at[row]; }
  const L* operator[](int row) const { return at[row]; }
};

/// Calls body(row, column).
template <class Body>
inline void for_entries(const Body& body) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) body(i, j);
  }
}

template <class L = Lanes>
inline LaneMatrix<L> identity() {
  LaneMatrix<L> result = {};
  for (int i = 0; i < 3; ++i) result[i][i] = all_lanes<L>(1.0);
  return result;
}

/// a b, aᵀ b and a bᵀ.
template <class L>
inline LaneMatrix<L> product(const LaneMatrix<L>& a, const LaneMatrix<L>& b) {
  LaneMatrix<L> result;
  for_entries([&](int i, int j) {
    result[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
  });
  return result;
}
template <class L>
inline LaneMatrix<L> transpose_product(const LaneMatrix<L>& a, const LaneMatrix<L>& b) {
  LaneMatrix<L> result;
  for_entries([&](int i, int j) {
    result[i][j] = a[0][i] * b[0][j] + a[1][i] * b[1][j] + a[2][i] * b[2][j];
  });
  return result;
}
template <class L>
inline LaneMatrix<L> product_transpose(const LaneMatrix<L>& a, const LaneMatrix<L>& b) {
  LaneMatrix<L> result;
  for_entries([&](int i, int j) {
    result[i][j] = a[i][0] * b[j][0] + a[i][1] * b[j][1] + a[i][2] * b[j][2];
  });
  return result;
}

template <class L>
inline LaneMatrix<L> cofactor(const LaneMatrix<L>& m) {
  LaneMatrix<L> result;
  for_entries([&](int i, int j) {
    const int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
    result[i][j] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
  });
  return result;
}
/// Sum of the products of entries.
template <class L>
inline L dot(const LaneMatrix<L>& a, const LaneMatrix<L>& b) {
  L sum = {};
  for_entries([&](int i, int j) { sum += a[i][j] * b[i][j]; });
  return sum;
}
template <class L>
inline L determinant(const LaneMatrix<L>& m, const LaneMatrix<L>& cofactors) {
  return m[0][0] * cofactors[0][0] + m[0][1] * cofactors[0][1] + m[0][2] * cofactors[0][2];
}

}  // namespace tissue
