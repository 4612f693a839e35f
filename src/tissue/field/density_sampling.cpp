#include "tissue/field/density_sampling.h"

#include "tissue/base/parallel.h"

#include <cmath>
#include <numeric>

namespace tissue {
namespace {

// Where to sample a tet: weights of its corners at each place, so many places that none stands for
// more voxels than a tet with long edges of 4 voxels holds (about five; a trilinear sample blends
// eight). One is the centroid; four are the rule that integrates quadratics exactly; from there on
// it is the centroids of the n³ parts of equal volume into which the tet falls when its edges are
// cut into n.
struct TetSampling {
  int parts = 1;
  std::array<std::vector<float>, 4> weights;

  TetSampling(double edge, const Vec3& voxel) {
    constexpr double kEdge = 4.0;
    const double edges = edge / std::cbrt(voxel.prod()) / kEdge;
    if (edges > 1.0 && edges <= std::cbrt(4.0)) {
      place_four();
    } else {
      place_in_parts(std::clamp(static_cast<int>(std::ceil(edges)), 1, 8));
    }
    parts = static_cast<int>(weights[0].size());
  }

 private:
  void place_four() {
    constexpr float kNear = 0.58541020f, kFar = 0.13819660f;
    for (int corner = 0; corner < 4; ++corner) {
      weights[corner].assign(4, kFar);
      weights[corner][corner] = kNear;
    }
  }

  void place_in_parts(int n) {
    // In coordinates 1 >= x >= y >= z >= 0 the tet is one of the six in a cube, and its parts are
    // those of the n³ smaller cubes that lie in it. A part goes from the low corner of its cube to
    // the high one along the axes in some order.
    constexpr int kOrders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                   {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (int cube = 0; cube < n * n * n; ++cube) {
      for (const auto& order : kOrders) {
        Vec3 centroid(cube % n, cube / n % n, cube / n / n);
        for (int step = 0; step < 3; ++step) centroid[order[step]] += 0.25 * (3 - step);
        centroid /= n;
        if (!(centroid[0] > centroid[1] && centroid[1] > centroid[2])) continue;
        weights[0].push_back(static_cast<float>(1.0 - centroid[0]));
        weights[1].push_back(static_cast<float>(centroid[0] - centroid[1]));
        weights[2].push_back(static_cast<float>(centroid[1] - centroid[2]));
        weights[3].push_back(static_cast<float>(centroid[2]));
      }
    }
  }
};

// A vertex in one register; the last number is not looked at.
struct Place {
  float at __attribute__((vector_size(16)));
};

// One coordinate of `count` places in a tet, from that of its corners.
inline void blend(const float* w0, const float* w1, const float* w2, const float* w3, float a,
                  float b, float c, float d, int count, float* __restrict__ result) {
  for (int i = 0; i < count; ++i) result[i] = w0[i] * a + w1[i] * b + w2[i] * c + w3[i] * d;
}

// Samples tets. They wait, apart by level, until their places fill a batch; a batch waits for its
// voxels while the one before is worked on.
template <class Sampler>
class TetSampler {
 public:
  // Densities are added to what is there.
  TetSampler(const Sampler& sampler, const DensityWindow& window,
             const std::vector<TetSampling>& samplings, const std::vector<Place>& vertices,
             const std::vector<Tet>& tets, std::vector<float>& densities)
      : sampler_(sampler),
        window_(window),
        vertices_(vertices),
        tets_(tets),
        densities_(densities) {
    for (const TetSampling& sampling : samplings) queues_.emplace_back(sampling);
  }

  // Tets in a row, all of one level.
  void add(std::size_t begin, std::size_t end, std::uint8_t level) {
    Queue& queue = queues_[level];
    while (begin < end) {
      const int count =
          static_cast<int>(std::min<std::size_t>(end - begin, queue.capacity - queue.count));
      std::iota(&queue.tets[queue.count], &queue.tets[queue.count] + count,
                static_cast<std::uint32_t>(begin));
      queue.count += count;
      begin += count;
      if (queue.count == queue.capacity) sample(queue);
    }
  }

  void flush() {
    for (Queue& queue : queues_) sample(queue);
    finish(waiting_);
  }

 private:
  static constexpr int kCapacity = PlaceBatch::kCapacity;
  struct Queue {
    explicit Queue(const TetSampling& places)
        : sampling(&places), capacity(std::max(1, kCapacity / places.parts)) {}
    const TetSampling* sampling;
    int capacity, count = 0;
    std::array<std::uint32_t, kCapacity> tets;
  };
  // A batch on its way: so many places for each of these tets.
  struct Batch {
    int tet_count = 0, parts = 0;
    float weight = 0.0f;
    std::array<std::uint32_t, kCapacity> tets;
    typename Sampler::Cells cells;
  };

  // The number of places is known to the compiler where it is small and common.
  void sample(Queue& queue) {
    switch (queue.sampling->parts) {
      case 1: start<1>(queue, 1); break;
      case 4: start<4>(queue, 4); break;
      default: start<0>(queue, queue.sampling->parts);
    }
    queue.count = 0;
  }

  template <int kParts>
  void start(const Queue& queue, int all_parts) {
    for (int first = 0; first < all_parts; first += kCapacity) {
      Batch& batch = batches_[next_];
      batch.parts = kParts > 0 ? kParts : std::min(kCapacity, all_parts - first);
      batch.weight = 1.0f / static_cast<float>(all_parts);
      batch.tet_count = queue.count;
      std::copy_n(queue.tets.begin(), queue.count, batch.tets.begin());
      for (int i = 0; i < queue.count; ++i) {
        place<kParts>(tets_[queue.tets[i]], *queue.sampling, first, batch.parts, i * batch.parts);
      }
      places_.count = queue.count * batch.parts;
      sampler_.locate(places_, batch.cells);
      finish(waiting_);
      waiting_ = &batch;
      next_ = 1 - next_;
    }
  }

  void finish(Batch* batch) {
    if (batch == nullptr) return;
    std::array<float, kCapacity> values;
    sampler_.interpolate(batch->cells, values.data());
    window_.apply(values.data(), kCapacity);
    for (int i = 0; i < batch->tet_count; ++i) {
      float sum = 0.0f;
      for (int part = 0; part < batch->parts; ++part) sum += values[i * batch->parts + part];
      densities_[batch->tets[i]] += batch->weight * sum;
    }
    waiting_ = nullptr;
  }

  // `count` places of a tet, from number `first` on, to where `at` says.
  template <int kParts>
  void place(const Tet& tet, const TetSampling& sampling, int first, int count, int at) {
    const Place &a = vertices_[tet[0]], &b = vertices_[tet[1]], &c = vertices_[tet[2]],
                &d = vertices_[tet[3]];
    float* const rows[3] = {places_.x + at, places_.y + at, places_.z + at};
    if (kParts == 1) {
      const auto mean = 0.25f * ((a.at + b.at) + (c.at + d.at));
      for (int axis = 0; axis < 3; ++axis) *rows[axis] = mean[axis];
      return;
    }
    for (int axis = 0; axis < 3; ++axis) {
      blend(&sampling.weights[0][first], &sampling.weights[1][first], &sampling.weights[2][first],
            &sampling.weights[3][first], a.at[axis], b.at[axis], c.at[axis], d.at[axis],
            kParts > 0 ? kParts : count, rows[axis]);
    }
  }

  const Sampler& sampler_;
  const DensityWindow& window_;
  const std::vector<Place>& vertices_;
  const std::vector<Tet>& tets_;
  std::vector<float>& densities_;
  std::vector<Queue> queues_;
  PlaceBatch places_;
  std::array<Batch, 2> batches_;
  Batch* waiting_ = nullptr;
  int next_ = 0;
};

}  // namespace

std::vector<float> sample_densities(const Volume& volume, const DensityWindow& window,
                                    const std::vector<Vec3f>& places, std::size_t begin,
                                    std::vector<float> densities, const Run& run) {
  densities.resize(places.size(), 0.0f);
  with_sampler(volume, [&](const auto& sampler) {
    parallel_ranges(places.size() - begin, 1024, run, [&](std::size_t from, std::size_t to) {
      PlaceBatch batch;
      float values[PlaceBatch::kCapacity];
      typename std::decay_t<decltype(sampler)>::Cells cells;
      for (std::size_t i = begin + from; i < begin + to; i += batch.count) {
        batch.count =
            static_cast<int>(std::min<std::size_t>(PlaceBatch::kCapacity, begin + to - i));
        for (int k = 0; k < batch.count; ++k) {
          const Vec3f& place = places[i + k];
          batch.x[k] = place.x();
          batch.y[k] = place.y();
          batch.z[k] = place.z();
        }
        sampler.locate(batch, cells);
        sampler.interpolate(cells, values);
        window.apply(values, PlaceBatch::kCapacity);
        std::copy(values, values + batch.count, &densities[i]);
      }
    });
  });
  return densities;
}

std::vector<float> sample_tet_densities(const Volume& volume, const DensityWindow& window,
                                        const std::vector<Vec3f>& vertices,
                                        const std::vector<Tet>& tets,
                                        const std::vector<std::uint8_t>& levels, double spacing,
                                        const Run& run) {
  std::vector<TetSampling> samplings;
  const int finest = levels.empty() ? 0 : *std::max_element(levels.begin(), levels.end());
  for (int level = 0; level <= finest; ++level) {
    samplings.emplace_back(std::ldexp(spacing, -level), volume.grid.spacing);
  }
  std::vector<Place> padded;
  padded.reserve(vertices.size());
  for (const Vec3f& v : vertices) padded.push_back(Place{{v[0], v[1], v[2], 0.0f}});
  std::vector<float> densities(tets.size(), 0.0f);
  with_sampler(volume, [&](const auto& sampler) {
    parallel_ranges(tets.size(), 8192, run, [&](std::size_t begin, std::size_t end) {
      TetSampler tet_sampler(sampler, window, samplings, padded, tets, densities);
      for (std::size_t t = begin, next = begin; t < end; t = next) {
        while (next < end && levels[next] == levels[t]) ++next;
        tet_sampler.add(t, next, levels[t]);
      }
      tet_sampler.flush();
    });
  });
  return densities;
}

}  // namespace tissue
