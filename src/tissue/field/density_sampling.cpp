#include "tissue/field/density_sampling.h"

#include "tissue/base/parallel.h"

#include <cmath>

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

// Collects places, samples them batch by batch and adds each density, times its weight, to the
// value it belongs to.
template <class Sampler>
class Accumulator {
 public:
  Accumulator(const Sampler& sampler, const DensityWindow& window, std::vector<float>& sums)
      : sampler_(sampler), window_(window), sums_(sums) {}

  void add(float x, float y, float z, std::size_t owner) {
    const int i = places_.count++;
    places_.x[i] = x;
    places_.y[i] = y;
    places_.z[i] = z;
    end_share(owner, 1.0f);
  }

  void add(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d,
           const TetSampling& sampling, std::size_t owner) {
    if (sampling.parts == 1) {
      const auto mean = [&](int axis) { return 0.25f * (a[axis] + b[axis] + c[axis] + d[axis]); };
      return add(mean(0), mean(1), mean(2), owner);
    }
    const float weight = 1.0f / static_cast<float>(sampling.parts);
    // A tet begins a batch or fits into one, so that its sum does not depend on those before it.
    if (sampling.parts > PlaceBatch::kCapacity - places_.count) flush();
    for (int part = 0; part < sampling.parts;) {
      const int first = places_.count;
      const int count = std::min(PlaceBatch::kCapacity - first, sampling.parts - part);
      const float* w[4];
      for (int corner = 0; corner < 4; ++corner) w[corner] = &sampling.weights[corner][part];
      blend(w, a.x(), b.x(), c.x(), d.x(), count, places_.x + first);
      blend(w, a.y(), b.y(), c.y(), d.y(), count, places_.y + first);
      blend(w, a.z(), b.z(), c.z(), d.z(), count, places_.z + first);
      places_.count += count;
      part += count;
      end_share(owner, weight);
    }
  }

  void flush() {
    float values[PlaceBatch::kCapacity];
    sampler_(places_, values);
    window_.apply(values, PlaceBatch::kCapacity);
    int i = 0;
    for (int share = 0; share < share_count_; ++share) {
      float sum = 0.0f;
      for (; i < shares_[share].end; ++i) sum += values[i];
      sums_[shares_[share].owner] += shares_[share].weight * sum;
    }
    places_.count = share_count_ = 0;
  }

 private:
  static void blend(const float* const w[4], float a, float b, float c, float d, int count,
                    float* __restrict__ result) {
    const float *w0 = w[0], *w1 = w[1], *w2 = w[2], *w3 = w[3];
    for (int i = 0; i < count; ++i) result[i] = w0[i] * a + w1[i] * b + w2[i] * c + w3[i] * d;
  }

  // Places that follow each other and belong to one value.
  struct Share {
    int end;
    float weight;
    std::size_t owner;
  };
  void end_share(std::size_t owner, float weight) {
    shares_[share_count_++] = {places_.count, weight, owner};
    if (places_.count == PlaceBatch::kCapacity) flush();
  }

  const Sampler& sampler_;
  const DensityWindow& window_;
  std::vector<float>& sums_;
  PlaceBatch places_;
  int share_count_ = 0;
  Share shares_[PlaceBatch::kCapacity];
};

}  // namespace

std::vector<float> sample_densities(const Volume& volume, const DensityWindow& window,
                                    const std::vector<Vec3f>& places, std::size_t begin,
                                    std::vector<float> densities, const Run& run) {
  densities.resize(places.size(), 0.0f);
  with_sampler(volume, [&](const auto& sampler) {
    parallel_ranges(places.size() - begin, 1024, run, [&](std::size_t from, std::size_t to) {
      Accumulator accumulator(sampler, window, densities);
      for (std::size_t i = begin + from; i < begin + to; ++i) {
        accumulator.add(places[i].x(), places[i].y(), places[i].z(), i);
      }
      accumulator.flush();
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
  std::vector<float> densities(tets.size(), 0.0f);
  with_sampler(volume, [&](const auto& sampler) {
    parallel_ranges(tets.size(), 1024, run, [&](std::size_t begin, std::size_t end) {
      Accumulator accumulator(sampler, window, densities);
      for (std::size_t t = begin; t < end; ++t) {
        const TetSampling& sampling = samplings[levels[t]];
        const Vec3f &a = vertices[tets[t][0]], &b = vertices[tets[t][1]], &c = vertices[tets[t][2]],
                    &d = vertices[tets[t][3]];
        accumulator.add(a, b, c, d, sampling, t);
      }
      accumulator.flush();
    });
  });
  return densities;
}

}  // namespace tissue
