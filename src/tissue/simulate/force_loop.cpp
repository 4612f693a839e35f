#include "tissue/simulate/force_loop.h"

#include "tissue/base/error.h"

#include <Eigen/Eigenvalues>

#include <cmath>

namespace tissue {
namespace {

void require_positive(const char* name, double value) {
  if (value > 0.0 && std::isfinite(value)) return;
  throw InputError(ErrorCode::kParam,
                   std::string(name) + ": " + to_text(value) + " is not a positive number");
}

// The inverse, of directions in which tissue gives way at all and as a spring does.
Mat3 stiffness_of(const Mat3& compliance, double stiffest) {
  if (!compliance.allFinite()) return Mat3::Zero();
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(0.5 * (compliance + compliance.transpose()));
  Vec3 values = solver.eigenvalues();
  for (double& value : values) value = value > 0.0 ? std::min(1.0 / value, stiffest) : 0.0;
  return solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace

ForceLoop::ForceLoop(const ForceLoopOptions& options) : options_(options) {
  require_positive("max_force", options.max_force);
  require_positive("max_rise", options.max_rise);
  require_positive("max_damping", options.max_damping);
  require_positive("max_stiffness", options.max_stiffness);
  forces_.fill(Vec3::Zero());
}

void ForceLoop::set_tissue(const std::optional<LocalTissue>& tissue) {
  tissue_ = tissue;
  stiffness_ =
      tissue ? stiffness_of(tissue->compliance, options_.max_stiffness) : Mat3(Mat3::Zero());
}

void ForceLoop::stop() {
  set_tissue(std::nullopt);
  position_.reset();
  last_motion_.setZero();
  forces_.fill(Vec3::Zero());
  energies_.fill(0.0);
}

Vec3 ForceLoop::spring_force(const Vec3& position) const {
  if (!tissue_) return Vec3::Zero();
  const Vec3 force = tissue_->force - stiffness_ * (position - tissue_->position);
  // What has turned round would be tissue that pulls.
  const bool pulls = force.dot(tissue_->force) <= 0.0;
  return force.allFinite() && (tissue_->pulls || !pulls) ? force : Vec3(Vec3::Zero());
}

Vec3 ForceLoop::force_at(const Vec3& position, double dt) {
  const Vec3 motion = position_ ? Vec3(position - *position_) : Vec3(Vec3::Zero());
  position_ = position;
  for (std::size_t late = 0; late < forces_.size(); ++late) {
    energies_[late] -= forces_[late].dot(motion);
  }
  Vec3 force = spring_force(position);
  const double highest = forces_[0].norm() + options_.max_rise * std::max(dt, 0.0);
  if (force.norm() > highest) force *= highest / force.norm();
  const bool touches = !force.isZero(0.0);
  if (dt > 0.0 && motion.norm() > 0.0) {
    // What the device would be given until it feels an answer to what it does now, if it went on
    // like this; no more of that than there is.
    constexpr double kSamples = kLongestDelay + 1;
    const Vec3 ahead =
        kSamples * motion + 0.5 * kSamples * (kSamples + 1.0) * (motion - last_motion_);
    const double given = force.dot(ahead), there = std::max(energy(), 0.0);
    if (given > there) {
      force -= (1.0 - there / given) * force.dot(ahead) / ahead.squaredNorm() * ahead;
    }
    // What was given too much is taken back by the next one.
    const double owed = std::max(-energy(), 0.0),
                 damping = std::min(owed * dt / motion.squaredNorm(), options_.max_damping);
    force -= damping / dt * motion;
  }
  last_motion_ = motion;
  // What does not touch holds no energy back.
  if (!touches) {
    for (double& energy : energies_) energy = std::min(energy, 0.0);
  }
  if (force.norm() > options_.max_force) force *= options_.max_force / force.norm();
  std::rotate(forces_.begin(), forces_.end() - 1, forces_.end());
  forces_[0] = force;
  return force;
}

}  // namespace tissue
