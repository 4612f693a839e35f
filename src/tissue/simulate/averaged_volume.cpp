#include "averaged_volume.h"

#include "element_lanes.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace tissue {

AveragedVolumeEnergy::AveragedVolumeEnergy(const FiniteElements& elements,
                                           const std::vector<double>& lambda,
                                           Constitution constitution)
    : elements_(elements),
      lambda_(lambda),
      is_small_strain_(constitution == Constitution::kLinear) {
  find_averages();
  find_squares();
}

void AveragedVolumeEnergy::find_averages() {
  std::map<std::pair<std::uint32_t, int>, std::uint32_t> numbers;
  averages_.resize(elements_.element_count());
  for (std::size_t e = 0; e < averages_.size(); ++e) {
    const int magnitude =
        lambda_[e] > 0.0 ? static_cast<int>(std::lround(std::log2(lambda_[e]))) : 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto next = static_cast<std::uint32_t>(weights_.size());
      const auto [found, is_new] = numbers.try_emplace({elements_.nodes(e)[i], magnitude}, next);
      if (is_new) weights_.push_back(0.0);
      averages_[e][i] = found->second;
      weights_[found->second] += 0.25 * lambda_[e] * elements_.volume(e);
    }
  }
}

void AveragedVolumeEnergy::find_squares() {
  const auto count = static_cast<std::size_t>(elements_.nodes_per_element());
  std::vector<std::vector<std::uint32_t>> columns(weights_.size());
  for (std::size_t e = 0; e < averages_.size(); ++e) {
    for (const std::uint32_t average : averages_[e]) {
      columns[average].insert(columns[average].end(), elements_.nodes(e),
                              elements_.nodes(e) + count);
    }
  }
  squares_.begin.push_back(0);
  for (std::vector<std::uint32_t>& row : columns) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    squares_.nodes.insert(squares_.nodes.end(), row.begin(), row.end());
    squares_.begin.push_back(static_cast<std::uint32_t>(squares_.nodes.size()));
    row = {};
  }
  for (std::size_t e = 0; e < averages_.size(); ++e) {
    for (const std::uint32_t average : averages_[e]) {
      const auto from = squares_.nodes.begin() + squares_.begin[average],
                 to = squares_.nodes.begin() + squares_.begin[average + 1];
      for (std::size_t a = 0; a < count; ++a) {
        const auto place = std::lower_bound(from, to, elements_.nodes(e)[a]);
        places_.push_back(static_cast<std::uint32_t>(place - squares_.nodes.begin()));
      }
    }
  }
}

double AveragedVolumeEnergy::evaluate(const Eigen::VectorXd& positions, Eigen::VectorXd* gradient,
                                      Hessian* hessian) const {
  return elements_.order() == 1 ? evaluate_order<1>(positions, gradient, hessian)
                                : evaluate_order<2>(positions, gradient, hessian);
}

template <int order>
double AveragedVolumeEnergy::evaluate_order(const Eigen::VectorXd& positions,
                                            Eigen::VectorXd* gradient, Hessian* hessian) const {
  const std::vector<QuadraturePoint>& points = elements_.quadrature();
  // Calls body(pack, how many of its lanes are elements, point, θ, dθ/dF, what each lane weighs).
  const auto for_each_point = [&](const auto& body) {
    Lanes nodes[kNodes<order>][3];
    for (std::size_t p = 0; p < elements_.pack_count(); ++p) {
      const std::size_t used = elements_.lanes_in_use(p);
      if (used == 0) continue;
      gather<order>(elements_, p, positions, nodes);
      for (const QuadraturePoint& point : points) {
        const LaneMatrix<Lanes> f = gradient_at<order>(point, elements_.pack(p).gradients, nodes);
        const LaneMatrix<Lanes> slope = is_small_strain_ ? identity() : cofactor(f);
        const Lanes theta =
            (is_small_strain_ ? Lanes(f[0][0] + f[1][1] + f[2][2] - 2.0) : determinant(f, slope)) -
            1.0;
        Lanes weight = {};
        for (std::size_t lane = 0; lane < used; ++lane) {
          weight[lane] =
              point.weight * lambda_[kLanes * p + lane] * elements_.volume(kLanes * p + lane);
        }
        body(p, used, point, theta, slope, weight);
      }
    }
  };
  std::vector<double> means(weights_.size(), 0.0);
  for_each_point([&](std::size_t p, std::size_t used, const QuadraturePoint& point,
                     const Lanes& theta, const LaneMatrix<Lanes>&, const Lanes& weight) {
    for (std::size_t lane = 0; lane < used; ++lane) {
      for (std::size_t i = 0; i < 4; ++i) {
        means[averages_[kLanes * p + lane][i]] += point.place[i] * weight[lane] * theta[lane];
      }
    }
  });
  double sum = 0.0;
  for (std::size_t a = 0; a < means.size(); ++a) {
    if (weights_[a] == 0.0) continue;
    sum += 0.5 * means[a] * means[a] / weights_[a];
    means[a] /= weights_[a];
  }
  if (gradient == nullptr && hessian == nullptr) return sum;
  if (hessian != nullptr) squares_.values.assign(squares_.nodes.size(), Vec3::Zero());
  for_each_point([&](std::size_t p, std::size_t used, const QuadraturePoint& point, const Lanes&,
                     const LaneMatrix<Lanes>& slope, const Lanes& weight) {
    Lanes pressure = {};
    for (std::size_t lane = 0; lane < used; ++lane) {
      for (std::size_t i = 0; i < 4; ++i) {
        pressure[lane] += point.place[i] * means[averages_[kLanes * p + lane][i]];
      }
    }
    // dθ/dx of the nodes, by its weight.
    Lanes changes[kNodes<order>][3] = {};
    LaneMatrix<Lanes> weighted;
    for_entries([&](int r, int c) { weighted[r][c] = weight * slope[r][c]; });
    add_forces<order>(point, elements_.pack(p).gradients, weighted, changes);
    constexpr std::size_t n = kNodes<order>;
    for (std::size_t lane = 0; hessian != nullptr && lane < used; ++lane) {
      const std::size_t e = kLanes * p + lane;
      for (std::size_t i = 0; i < 4; ++i) {
        const std::uint32_t average = averages_[e][i];
        if (weights_[average] == 0.0) continue;
        const double share = point.place[i] / std::sqrt(weights_[average]);
        for (std::size_t a = 0; a < n; ++a) {
          Vec3& to = squares_.values[places_[(4 * e + i) * n + a]];
          for (int r = 0; r < 3; ++r) to[r] += share * changes[a][r][lane];
        }
      }
    }
    if (gradient == nullptr) return;
    for (auto& node : changes) {
      for (Lanes& coordinate : node) coordinate *= pressure;
    }
    scatter<order>(elements_, p, changes, *gradient);
  });
  if (hessian != nullptr) hessian->add_squares(squares_);
  return sum;
}

std::size_t AveragedVolumeEnergy::bytes() const {
  return lambda_.size() * sizeof(double) + averages_.size() * sizeof(averages_[0]) +
         weights_.size() * sizeof(double) + places_.size() * sizeof(places_[0]) +
         2 * squares_.bytes();
}

}  // namespace tissue
