#include "lattice_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tissue {
namespace {

constexpr int kRounds = 14;

// The k-th number of van der Corput's sequence in a base: even cover by few numbers.
double van_der_corput(int k, int base) {
  double value = 0.0, digit = 1.0 / base;
  for (; k > 0; k /= base, digit /= base) value += digit * (k % base);
  return value;
}

}  // namespace

StuffingOptions search_lattice(StuffingOptions start, double wished, double tolerance,
                               const std::function<double(const StuffingOptions&)>& count) {
  StuffingOptions nearest = start, next = start;
  double smallest_gap = std::numeric_limits<double>::infinity(), nearest_ratio = 1.0;
  for (int round = 0; round < kRounds && smallest_gap > tolerance; ++round) {
    const double ratio = std::max(count(next), 1.0) / wished;
    if (std::abs(ratio - 1.0) < smallest_gap) {
      smallest_gap = std::abs(ratio - 1.0);
      nearest_ratio = ratio;
      nearest = next;
    }
    // A first guess may be far off; from a good one only a small step is right.
    next = nearest;
    next.spacing *= std::cbrt(std::clamp(nearest_ratio, 1.0 / 64.0, 64.0));
    if (smallest_gap < 0.1) {
      next.offset = {van_der_corput(round, 2), van_der_corput(round, 3), van_der_corput(round, 5)};
    }
  }
  return nearest;
}

}  // namespace tissue
