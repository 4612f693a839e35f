#include "stencils.h"

#include "tissue/lattice/bcc_lattice.h"

#include <cassert>
#include <vector>

namespace tissue {
namespace {

using Corners = std::array<std::array<int, 3>, 4>;

StencilPoint cut(int a, int b) { return 4 + tet_edge(a, b); }

bool is_long(int a, int b) { return (a ^ b) == 2; }

// The quad (p, q, cut(q,o), cut(p,o)) of a face with p, q inside and o outside is split at p, or
// else at q. A property of the face alone, so that both of its tets agree.
bool diagonal_touches_first(int p, int q, int o, const Corners& corners) {
  if (!is_long(p, q)) return is_long(q, o);  // The diagonal starts at the cut on the long edge.
  int exceeded = 0;
  for (int axis = 0; axis < 3; ++axis) exceeded += corners[o][axis] > corners[p][axis];
  return exceeded % 2 == 0;
}

// Three tets that fill the prism with columns (bottom[i], top[i]). The quad between columns i and
// i + 1 has the diagonal bottom[i]–top[i+1] if up[i], else top[i]–bottom[i+1].
void fill_prism(const std::array<StencilPoint, 3>& bottom, const std::array<StencilPoint, 3>& top,
                const std::array<bool, 3>& up, Stencil& stencil) {
  int k = 0;
  while (k < 3 && !(up[k] && !up[(k + 2) % 3])) ++k;
  assert(k < 3 && "three cyclic diagonals leave no tet at any corner of the prism");
  const int k1 = (k + 1) % 3, k2 = (k + 2) % 3;
  stencil.count = 3;
  stencil.tets[0] = {bottom[k], top[0], top[1], top[2]};
  if (up[k1]) {
    stencil.tets[1] = {bottom[k], bottom[k1], top[k1], top[k2]};
    stencil.tets[2] = {bottom[k], bottom[k1], bottom[k2], top[k2]};
  } else {
    stencil.tets[1] = {bottom[k], bottom[k2], top[k1], top[k2]};
    stencil.tets[2] = {bottom[k], bottom[k1], bottom[k2], top[k1]};
  }
}

}  // namespace

Stencil fill_tet(const std::array<int, 4>& signs, const Corners& corners) {
  std::array<int, 4> in{}, out{};
  int n_in = 0, n_out = 0, on = -1;
  for (int i = 0; i < 4; ++i) {
    if (signs[i] < 0) in[n_in++] = i;
    if (signs[i] > 0) out[n_out++] = i;
    if (signs[i] == 0) on = i;
  }
  Stencil stencil;
  if (n_in == 0) return stencil;
  if (n_out == 0) {
    stencil.count = 1;
    stencil.tets[0] = {0, 1, 2, 3};
  } else if (n_in == 1) {
    stencil.count = 1;
    for (int i = 0; i < 4; ++i) stencil.tets[0][i] = signs[i] > 0 ? cut(in[0], i) : i;
  } else if (n_in == 2 && n_out == 1) {
    const int p = in[0], q = in[1], o = out[0];
    const bool at_p = diagonal_touches_first(p, q, o, corners);
    const int touched = at_p ? p : q, other = at_p ? q : p;
    stencil.count = 2;
    stencil.tets[0] = {p, q, cut(other, o), on};
    stencil.tets[1] = {touched, cut(other, o), cut(touched, o), on};
  } else if (n_in == 3) {
    const int o = out[0];
    std::array<bool, 3> up{};
    for (int i = 0; i < 3; ++i) {
      up[i] = diagonal_touches_first(in[i], in[(i + 1) % 3], o, corners);
    }
    fill_prism({in[0], in[1], in[2]}, {cut(in[0], o), cut(in[1], o), cut(in[2], o)}, up, stencil);
  } else {
    const int p = in[0], q = in[1], o = out[0], r = out[1];
    const bool first = diagonal_touches_first(p, q, o, corners);
    const bool last = !diagonal_touches_first(p, q, r, corners);
    // The quad between the two cut columns lies on the boundary, so its diagonal is free; the other
    // two always run the same way around, which leaves one choice.
    fill_prism({p, cut(p, o), cut(p, r)}, {q, cut(q, o), cut(q, r)}, {first, !first, last},
               stencil);
  }
  return stencil;
}

const Stencil& stencil_for(int k, const std::array<int, 4>& signs) {
  constexpr int kSigns = 81;  // 3⁴
  static const std::vector<Stencil> table = [] {
    std::vector<Stencil> stencils;
    for (const BccTet& tet : bcc_tets()) {
      for (int code = 0; code < kSigns; ++code) {
        stencils.push_back(fill_tet(
            {code % 3 - 1, code / 3 % 3 - 1, code / 9 % 3 - 1, code / 27 - 1}, tet.corners));
      }
    }
    return stencils;
  }();
  const int code = signs[0] + 1 + 3 * (signs[1] + 1) + 9 * (signs[2] + 1) + 27 * (signs[3] + 1);
  return table[static_cast<std::size_t>(k * kSigns + code)];
}

}  // namespace tissue
