#include "linear_response.h"

#include <algorithm>

namespace tissue {
namespace {

// from + a·x + b·y + c·z, coordinate by coordinate.
template <class From>
void add_three(const float* __restrict__ x, const float* __restrict__ y,
               const float* __restrict__ z, float a, float b, float c, const From* from,
               std::size_t count, double* result) {
  for (std::size_t i = 0; i < count; ++i) {
    result[i] = static_cast<double>(from[i]) + static_cast<double>(a * x[i] + b * y[i] + c * z[i]);
  }
}

}  // namespace

LinearResponse::LinearResponse(Equilibrium& equilibrium, const Eigen::VectorXd& base,
                               const std::vector<Eigen::VectorXd>& motions,
                               const std::vector<std::size_t>& watched)
    : base_(base),
      float_base_(base.data(), base.data() + base.size()),
      base_energy_(equilibrium.energy(base)) {
  const Eigen::VectorXd base_gradient = equilibrium.gradient(base);
  const auto count = static_cast<Eigen::Index>(motions.size());
  Eigen::MatrixXd answers(base.size(), count), forces(base.size(), count);
  for (Eigen::Index k = 0; k < count; ++k) {
    answers.col(k) = equilibrium.response(base, motions[static_cast<std::size_t>(k)]);
    // The gradient is affine, so that its difference is the stiffness times the column.
    forces.col(k) = equilibrium.gradient(base + answers.col(k)) - base_gradient;
    const Eigen::VectorXf column = answers.col(k).cast<float>();
    columns_.emplace_back(column.data(), column.data() + column.size());
  }
  const auto rows = 3 * static_cast<Eigen::Index>(watched.size());
  watched_base_.resize(rows);
  watched_base_gradient_.resize(rows);
  watched_columns_.resize(rows, count);
  watched_forces_.resize(rows, count);
  for (std::size_t w = 0; w < watched.size(); ++w) {
    const auto to = 3 * static_cast<Eigen::Index>(w),
               from = 3 * static_cast<Eigen::Index>(watched[w]);
    watched_base_.segment<3>(to) = base.segment<3>(from);
    watched_base_gradient_.segment<3>(to) = base_gradient.segment<3>(from);
    watched_columns_.middleRows<3>(to) = answers.middleRows<3>(from);
    watched_forces_.middleRows<3>(to) = forces.middleRows<3>(from);
  }
  slopes_ = answers.transpose() * base_gradient;
  curvatures_ = answers.transpose() * forces;
}

template <class From>
void LinearResponse::superpose(const Eigen::VectorXd& amounts, const From* base, double* positions,
                               std::size_t count) const {
  bool first = true;
  for (std::size_t k = 0; k < columns_.size(); k += 3) {
    const Eigen::Vector3f three = amounts.segment<3>(static_cast<Eigen::Index>(k)).cast<float>();
    if (three.isZero(0.0f)) continue;
    const auto add_to = [&](const auto* from) {
      add_three(columns_[k].data(), columns_[k + 1].data(), columns_[k + 2].data(), three[0],
                three[1], three[2], from, count, positions);
    };
    first ? add_to(base) : add_to(positions);
    first = false;
  }
  if (first) std::copy(base_.data(), base_.data() + count, positions);
}

void LinearResponse::superpose(const Eigen::VectorXd& amounts, std::vector<Vec3>& positions) const {
  superpose(amounts, float_base_.data(), positions.front().data(), 3 * positions.size());
}

Eigen::VectorXd LinearResponse::superpose(const Eigen::VectorXd& amounts) const {
  Eigen::VectorXd positions(base_.size());
  superpose(amounts, base_.data(), positions.data(), static_cast<std::size_t>(positions.size()));
  return positions;
}

Eigen::VectorXd LinearResponse::watched_positions(const Eigen::VectorXd& amounts) const {
  return watched_base_ + watched_columns_ * amounts;
}

Eigen::VectorXd LinearResponse::watched_gradient(const Eigen::VectorXd& amounts) const {
  return watched_base_gradient_ + watched_forces_ * amounts;
}

double LinearResponse::energy(const Eigen::VectorXd& amounts) const {
  // Term by term, for a product needs memory of its own at each step.
  double curved = 0.0;
  for (Eigen::Index k = 0; k < amounts.size(); ++k) {
    if (amounts[k] != 0.0) curved += amounts[k] * curvatures_.col(k).dot(amounts);
  }
  return base_energy_ + slopes_.dot(amounts) + 0.5 * curved;
}

}  // namespace tissue
