#include "quadratic_operator.h"

#include "element_lanes.h"

#include "tensor_forms.h"

namespace tissue {
namespace {

using FourFloats = float __attribute__((vector_size(16)));
using FourDoubles = double __attribute__((vector_size(32)));

// Numbers at eight places, in single precision, less what is at eight other ones.
inline FloatLanes gather(const float* x, const std::uint32_t* at, const float* from) {
  return FloatLanes{x[at[0]], x[at[1]], x[at[2]], x[at[3]],
                    x[at[4]], x[at[5]], x[at[6]], x[at[7]]} -
         FloatLanes{from[0], from[1], from[2], from[3], from[4], from[5], from[6], from[7]};
}
inline FloatLanes gather(const double* x, const std::uint32_t* at, const double* from) {
  FourFloats halves[2];
  for (int half = 0; half < 2; ++half, at += 4, from += 4) {
    FourDoubles base;
    std::memcpy(&base, from, sizeof base);
    halves[half] = __builtin_convertvector(
        FourDoubles{x[at[0]], x[at[1]], x[at[2]], x[at[3]]} - base, FourFloats);
  }
  FloatLanes result;
  std::memcpy(&result, halves, sizeof result);
  return result;
}

template <class Form>
class QuadraticElements : public QuadraticOperator {
 public:
  explicit QuadraticElements(const FiniteElements& elements);

  using QuadraticOperator::add_mass;
  void add_elements(std::size_t first_pack, const std::vector<MaterialTensor>& tensors) override;
  void add_stiffness(const float* x, float* result) const override { multiply_any(x, result); }
  void multiply_add(const double* x, double* result) const override { multiply_any(x, result); }
  void set_zero() override {
    QuadraticOperator::set_zero();
    used_ = 0;
  }

 private:
  static constexpr int kPoints = 4;
  struct Pack {
    LaneMatrix<FloatLanes> gradients;
    FloatLanes volumes;
  };
  template <class Scalar>
  void multiply_any(const Scalar* x, Scalar* result) const;
  void stiffness(std::size_t p, const FloatLanes (&nodes)[10][3],
                 FloatLanes (&forces)[10][3]) const;
  void add_mass(const Pack& pack, const FloatLanes (&nodes)[10][3], const FloatLanes (&first)[3],
                FloatLanes (&forces)[10][3]) const;
  std::size_t lanes_in_use(std::size_t pack) const {
    const std::size_t first = pack * kFloatLanes;
    return std::min(kFloatLanes, elements_.element_count() - first);
  }

  const FiniteElements& elements_;
  std::vector<Pack> packs_;
  // For each time that all elements were added, pack by pack and point by point; so many are in
  // use.
  std::vector<std::vector<Form>> forms_;
  std::size_t used_ = 0;
};

template <class Form>
QuadraticElements<Form>::QuadraticElements(const FiniteElements& elements)
    : elements_(elements), packs_((elements.element_count() + kFloatLanes - 1) / kFloatLanes) {
  for (std::size_t e = 0; e < elements.element_count(); ++e) {
    Pack& pack = packs_[e / kFloatLanes];
    const FiniteElements::Pack& from = elements.pack(e / kLanes);
    for_entries([&](int i, int j) {
      pack.gradients[i][j][e % kFloatLanes] = static_cast<float>(from.gradients[i][j][e % kLanes]);
    });
    pack.volumes[e % kFloatLanes] = static_cast<float>(elements.volume(e));
  }
}

template <class Form>
void QuadraticElements<Form>::add_elements(std::size_t first_pack,
                                           const std::vector<MaterialTensor>& tensors) {
  if (first_pack == 0 && ++used_ > forms_.size()) {
    forms_.emplace_back(packs_.size() * kPoints);
  }
  std::vector<Form>& forms = forms_[used_ - 1];
  for (std::size_t i = 0; i < tensors.size(); ++i) {
    const std::size_t first = (first_pack + i / kPoints) * kLanes;
    forms[first / kFloatLanes * kPoints + i % kPoints].store(tensors[i], first % kFloatLanes);
  }
}

// Keast's points lie alike about the corners, so that what nodes have in common at all of them is
// summed up once: point q differs from the others by what corner q and the midpoints next to it
// add.
template <class Form>
void QuadraticElements<Form>::stiffness(std::size_t p, const FloatLanes (&nodes)[10][3],
                                        FloatLanes (&forces)[10][3]) const {
  const Pack& pack = packs_[p];
  const auto near = static_cast<float>(elements_.quadrature()[0].place[0]);
  const auto far = static_cast<float>(elements_.quadrature()[0].place[1]);
  const float corner = 4.0f * far - 1.0f, middle = 4.0f * far, extra = 4.0f * (near - far);
  // The node between corners i and q; the corner itself for i = q.
  constexpr int kBetween[4][4] = {{0, 4, 5, 6}, {4, 1, 7, 8}, {5, 7, 2, 9}, {6, 8, 9, 3}};
  FloatLanes common[4][3], sums[4][3] = {};
  for (int i = 0; i < 4; ++i) {
    for (int r = 0; r < 3; ++r) {
      FloatLanes middles = {};
      for (int j = 0; j < 4; ++j) {
        if (j != i) middles += nodes[kBetween[i][j]][r];
      }
      common[i][r] = corner * nodes[i][r] + middle * middles;
    }
  }
  for (int a = 0; a < 10; ++a) {
    for (int r = 0; r < 3; ++r) forces[a][r] = FloatLanes{};
  }
  for (int q = 0; q < kPoints; ++q) {
    LaneMatrix<FloatLanes> differences;
    for (int r = 0; r < 3; ++r) {
      const FloatLanes at_0 = common[0][r] + extra * nodes[kBetween[0][q]][r];
      for (int k = 0; k < 3; ++k) {
        differences[r][k] = common[k + 1][r] + extra * nodes[kBetween[k + 1][q]][r] - at_0;
      }
    }
    const LaneMatrix<FloatLanes> change = product(differences, pack.gradients);
    const std::size_t point = p * kPoints + static_cast<std::size_t>(q);
    LaneMatrix<FloatLanes> stress = forms_[0][point].stress(change);
    for (std::size_t k = 1; k < used_; ++k) {
      const LaneMatrix<FloatLanes> more = forms_[k][point].stress(change);
      for_entries([&](int r, int c) { stress[r][c] += more[r][c]; });
    }
    const LaneMatrix<FloatLanes> pull = product_transpose(stress, pack.gradients);
    for (int r = 0; r < 3; ++r) {
      const FloatLanes at[4] = {-(pull[r][0] + pull[r][1] + pull[r][2]), pull[r][0], pull[r][1],
                                pull[r][2]};
      for (int i = 0; i < 4; ++i) {
        sums[i][r] += at[i];
        forces[kBetween[i][q]][r] += extra * at[i];
      }
    }
  }
  for (int i = 0; i < 4; ++i) {
    for (int r = 0; r < 3; ++r) {
      forces[i][r] += corner * sums[i][r];
      for (int j = 0; j < 4; ++j) {
        if (j != i) forces[kBetween[i][j]][r] += middle * sums[i][r];
      }
    }
  }
}

template <class Form>
void QuadraticElements<Form>::add_mass(const Pack& pack, const FloatLanes (&nodes)[10][3],
                                       const FloatLanes (&first)[3],
                                       FloatLanes (&forces)[10][3]) const {
  const FloatLanes density = static_cast<float>(mass_) * pack.volumes;
  add_quadratic_mass(nodes, density * (1.0f / 420.0f), forces);
  // What the whole element moves by.
  for (int a = 0; a < 10; ++a) {
    const auto share = static_cast<float>(elements_.node_weight(a));
    for (int r = 0; r < 3; ++r) forces[a][r] += share * density * first[r];
  }
}

template <class Form>
template <class Scalar>
void QuadraticElements<Form>::multiply_any(const Scalar* x, Scalar* result) const {
  static_assert(kFloatLanes == 8);
  const Scalar zeros[kFloatLanes] = {};
  for (std::size_t p = 0; p < packs_.size(); ++p) {
    std::uint32_t places[10][kFloatLanes];
    for (std::size_t lane = 0; lane < kFloatLanes; ++lane) {
      const std::uint32_t* of_lane = elements_.nodes(p * kFloatLanes + lane);
      for (int a = 0; a < 10; ++a) places[a][lane] = 3 * of_lane[a];
    }
    // From the first node on.
    FloatLanes nodes[10][3], first[3], forces[10][3];
    for (int i = 0; i < 3; ++i) {
      Scalar from[kFloatLanes];
      for (std::size_t lane = 0; lane < kFloatLanes; ++lane) from[lane] = x[places[0][lane] + i];
      first[i] = gather(x + i, places[0], zeros);
      nodes[0][i] = FloatLanes{};
      for (int a = 1; a < 10; ++a) nodes[a][i] = gather(x + i, places[a], from);
    }
    stiffness(p, nodes, forces);
    if (std::is_same_v<Scalar, double> && mass_ > 0.0) {
      add_mass(packs_[p], nodes, first, forces);
    }
    for (std::size_t lane = 0; lane < lanes_in_use(p); ++lane) {
      for (int a = 0; a < 10; ++a) {
        Scalar* to = result + places[a][lane];
        for (int i = 0; i < 3; ++i) to[i] += static_cast<Scalar>(forces[a][i][lane]);
      }
    }
  }
}

}  // namespace

std::unique_ptr<QuadraticOperator> quadratic_operator(const FiniteElements& elements,
                                                      Constitution constitution) {
  if (constitution == Constitution::kNeoHookean) {
    return std::make_unique<QuadraticElements<StretchForm>>(elements);
  }
  return std::make_unique<QuadraticElements<TurnedForm>>(elements);
}

}  // namespace tissue
