#include "vertex_hessian.h"

#include "pair_blocks.h"
#include "tissue/base/parallel.h"
#include "tissue/simulate/mass_matrix.h"

#include <cmath>

namespace tissue {
namespace {

using Four = float __attribute__((vector_size(16)));

// The numbers at these places of the eight in `a` and `b`.
template <int i, int j, int k, int l>
Four picked(Four a, Four b) {
#ifdef __clang__
  return __builtin_shufflevector(a, b, i, j, k, l);
#else
  using Places = int __attribute__((vector_size(16)));
  return __builtin_shuffle(a, b, Places{i, j, k, l});
#endif
}

constexpr std::size_t kPairs = 6;
// Numbers of an element's blocks, made up to whole registers.
constexpr std::size_t kStride = 56;

// Four numbers of each of four elements, from lanes to elements.
inline void turn(const Lanes* const (&from)[4], float* to) {
  Four in[4];
  for (int i = 0; i < 4; ++i) in[i] = __builtin_convertvector(*from[i], Four);
  const Four low_01 = picked<0, 4, 1, 5>(in[0], in[1]);
  const Four high_01 = picked<2, 6, 3, 7>(in[0], in[1]);
  const Four low_23 = picked<0, 4, 1, 5>(in[2], in[3]);
  const Four high_23 = picked<2, 6, 3, 7>(in[2], in[3]);
  const Four out[4] = {picked<0, 1, 4, 5>(low_01, low_23), picked<2, 3, 6, 7>(low_01, low_23),
                       picked<0, 1, 4, 5>(high_01, high_23), picked<2, 3, 6, 7>(high_01, high_23)};
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    std::memcpy(to + lane * kStride, &out[lane], sizeof(Four));
  }
}

// The blocks of a pack's elements, element after element, block after block, column by column.
void store(const PairBlocks<1>& blocks, float* to) {
  const Lanes nothing = {};
  const auto entry = [&](std::size_t k) -> const Lanes* {
    return k < 9 * kPairs ? &blocks.of[k / 9][static_cast<int>(k % 3)][k % 9 / 3] : &nothing;
  };
  for (std::size_t k = 0; k < kStride; k += 4) {
    turn({entry(k), entry(k + 1), entry(k + 2), entry(k + 3)}, to + k);
  }
}

}  // namespace

VertexHessian::VertexHessian(const FiniteElements& elements,
                             const std::vector<std::uint32_t>& place_of, Run run)
    : elements_(elements),
      place_of_(place_of),
      run_(std::move(run)),
      own_(elements.vertex_count(), Mat3::Zero()) {
  std::vector<std::vector<std::uint32_t>> columns(elements.vertex_count());
  const auto for_pairs = [&](const auto& body) {
    for (std::size_t e = 0; e < elements.element_count(); ++e) {
      const std::uint32_t* nodes = elements.nodes(e);
      std::size_t pair = 0;
      for (int a = 0; a < 4; ++a) {
        for (int b = 0; b < a; ++b) body(e, pair++, place_of[nodes[a]], place_of[nodes[b]]);
      }
    }
  };
  for_pairs([&](std::size_t, std::size_t, std::uint32_t a, std::uint32_t b) {
    columns[a].push_back(b);
    columns[b].push_back(a);
  });
  rows_ = BlockRows(elements.vertex_count(), std::move(columns));
  pairs_.resize(elements.element_count());
  for_pairs([&](std::size_t e, std::size_t pair, std::uint32_t a, std::uint32_t b) {
    pairs_[e][pair] = rows_.find(a, b);
  });
  for (std::uint32_t row = 0; row < rows_.row_count(); ++row) {
    for (std::uint32_t k = rows_.diagonal(row) + 1; k < rows_.end(row); ++k) {
      across_.push_back(rows_.find(rows_.column(k), row));
    }
  }
}

void VertexHessian::set_zero() {
  rows_.set_zero();
  std::fill(own_.begin(), own_.end(), Mat3::Zero());
  is_finished_ = false;
}

void VertexHessian::add(std::uint32_t a, std::uint32_t b, const Mat3& block) {
  if (a == b) {
    own_[a] += block;
    return;
  }
  own_[a] += block;
  own_[b] += block.transpose();
  Eigen::Map<Eigen::Matrix3f>(rows_.block(rows_.find(place_of_[a], place_of_[b]))) +=
      block.cast<float>();
}

void VertexHessian::add_mass(const MassMatrix& mass, double factor) {
  for (std::size_t v = 0; v < own_.size(); ++v) {
    own_[v].diagonal().array() += factor * mass.at_vertex(v);
  }
}

void VertexHessian::add_elements(std::size_t first_pack,
                                 const std::vector<MaterialTensor>& tensors) {
  const std::size_t points = elements_.quadrature().size(), count = tensors.size() / points;
  // Corners' gradients are the same everywhere in an element.
  const QuadraturePoint centroid = {{0.25, 0.25, 0.25, 0.25}, 1.0};
  buffer_.resize(count * kLanes * kStride);
  parallel_ranges(count, 32, run_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      PairBlocks<1> blocks;
      for (std::size_t q = 0; q < points; ++q) {
        blocks.add(centroid, elements_.pack(first_pack + i).gradients, tensors[i * points + q]);
      }
      store(blocks, &buffer_[i * kLanes * kStride]);
    }
  });
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t lane = 0; lane < elements_.lanes_in_use(first_pack + i); ++lane) {
      const float* from = &buffer_[(i * kLanes + lane) * kStride];
      for (const std::uint32_t pair : pairs_[(first_pack + i) * kLanes + lane]) {
        add_block(1.0f, from, rows_.block(pair));
        from += 9;
      }
    }
  }
}

void VertexHessian::finish() {
  if (is_finished_) return;
  is_finished_ = true;
  std::vector<Mat3> rest(own_.size(), Mat3::Zero());
  std::size_t next = 0;
  for (std::uint32_t row = 0; row < rows_.row_count(); ++row) {
    Mat3 sum = Mat3::Zero();
    for (std::uint32_t k = rows_.diagonal(row) + 1; k < rows_.end(row); ++k) {
      Eigen::Map<Eigen::Matrix3f> here(rows_.block(k)), there(rows_.block(across_[next++]));
      here += there.transpose();
      there = here.transpose();
      sum += here.cast<double>();
      rest[rows_.column(k)] += here.transpose().cast<double>();
    }
    rest[row] += sum;
  }
  for (std::size_t v = 0; v < own_.size(); ++v) {
    const std::uint32_t place = place_of_[v];
    Eigen::Map<Eigen::Matrix3f>(rows_.block(rows_.diagonal(place))) =
        (own_[v] - rest[place]).cast<float>();
  }
}

double VertexHessian::largest_diagonal() const {
  double largest = 0.0, sum = 0.0;
  for (std::size_t row = 0; row < rows_.row_count(); ++row) {
    const float* block = rows_.block(rows_.diagonal(row));
    for (int i = 0; i < 9; i += 4) {
      largest = std::max(largest, static_cast<double>(block[i]));
      sum += block[i];
    }
  }
  return std::isfinite(sum) ? largest : sum;
}

}  // namespace tissue
