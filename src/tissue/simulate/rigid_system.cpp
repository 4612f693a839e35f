#include "rigid_system.h"

#include "adapted_system.h"

#include <Eigen/Dense>

#include <utility>

namespace tissue {
namespace {

using Six = Eigen::Matrix<double, 6, 1>;
using SixBySix = Eigen::Matrix<double, 6, 6>;

class RigidSystem : public AdaptedSystem {
 public:
  RigidSystem(std::unique_ptr<LinearSystem> base, const RigidMotions& motions, double tolerance)
      : AdaptedSystem(std::move(base), tolerance), motions_(motions) {}

  bool precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) override {
    if (!base().precondition(r, z)) return false;
    const CostClock clock(&motions_.cost());
    for (std::size_t g = 0; g < parts_.size(); ++g) {
      const RigidMotions::Group& group = motions_.groups()[g];
      if (group.is_held) continue;
      for (const std::uint32_t i : group.nodes) z.segment<3>(3 * Eigen::Index{i}).setZero();
    }
    for (std::size_t g = 0; g < parts_.size(); ++g) {
      const RigidMotions::Group& group = motions_.groups()[g];
      if (group.is_held) continue;
      const Part& part = parts_[g];
      const Six moved =
          part.stiffness.solve(motions_.moments(group, r) + Six(part.followers.transpose() * r));
      motions_.add_motion(group, moved, z);
      z.noalias() += part.followers * moved;
    }
    return true;
  }

  void forget() override {
    AdaptedSystem::forget();
    motions_.cost().bytes -= bytes_;
    bytes_ = 0;
    parts_.clear();
  }

 protected:
  bool prepare_base(const std::vector<std::uint8_t>& fixed, double shift) override {
    std::vector<std::uint8_t> held = fixed;
    for (const RigidMotions::Group& group : motions_.groups()) {
      if (group.is_held) continue;
      for (const std::uint32_t i : group.nodes) {
        for (std::size_t k = 0; k < 3; ++k) held[3 * std::size_t{i} + k] = 1;
      }
    }
    if (!base().prepare(held, shift)) return false;
    const CostClock clock(&motions_.cost());
    const bool is_new = parts_.empty();
    parts_.resize(motions_.groups().size());
    for (std::size_t g = 0; g < parts_.size(); ++g) {
      const RigidMotions::Group& group = motions_.groups()[g];
      if (group.is_held) continue;
      if (is_new) find_followers(group, held, parts_[g]);
      if (!find_stiffness(group, parts_[g])) return false;
    }
    return true;
  }

  void restrict(Eigen::VectorXd& vector) const override {
    AdaptedSystem::restrict(vector);
    motions_.project(vector);
  }

 private:
  struct Part {
    // How free nodes go along with each of an inclusion's six motions, roughly: kept while it
    // serves. Without that the inclusion would be much stiffer alone than it is.
    Eigen::Matrix<double, Eigen::Dynamic, 6> followers;
    // Of the motions with what follows them.
    Eigen::LDLT<SixBySix> stiffness;
  };

  void find_followers(const RigidMotions::Group& group, const std::vector<std::uint8_t>& held,
                      Part& part) {
    constexpr int kRounds = 2;
    const auto size = static_cast<Eigen::Index>(held.size());
    part.followers.setZero(size, 6);
    const std::size_t bytes = 6 * held.size() * sizeof(double);
    bytes_ += bytes;
    motions_.cost().bytes += bytes;
    Eigen::VectorXd motion, forces, step;
    for (int k = 0; k < 6; ++k) {
      for (int round = 0; round < kRounds; ++round) {
        motion = part.followers.col(k);
        motions_.add_motion(group, Six::Unit(k), motion);
        forces.setZero(size);
        base().multiply_add(motion, forces);
        for (Eigen::Index i = 0; i < size; ++i) {
          if (held[static_cast<std::size_t>(i)] != 0) forces[i] = 0.0;
        }
        if (!base().precondition(forces, step)) break;
        part.followers.col(k) -= step;
      }
    }
  }

  bool find_stiffness(const RigidMotions::Group& group, Part& part) const {
    SixBySix stiffness;
    Eigen::VectorXd motion, forces;
    for (int k = 0; k < 6; ++k) {
      motion = part.followers.col(k);
      motions_.add_motion(group, Six::Unit(k), motion);
      forces.setZero(motion.size());
      base().multiply_add(motion, forces);
      stiffness.col(k) = motions_.moments(group, forces) + Six(part.followers.transpose() * forces);
    }
    part.stiffness.compute(0.5 * (stiffness + stiffness.transpose()));
    return part.stiffness.info() == Eigen::Success && part.stiffness.isPositive();
  }

  const RigidMotions& motions_;
  std::vector<Part> parts_;
  // Of all followers.
  std::size_t bytes_ = 0;
};

}  // namespace

std::unique_ptr<LinearSystem> rigid_system(std::unique_ptr<LinearSystem> base,
                                           const RigidMotions& motions, double tolerance) {
  return std::make_unique<RigidSystem>(std::move(base), motions, tolerance);
}

}  // namespace tissue
