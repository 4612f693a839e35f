#include "conjugate_gradients.h"
#include "tissue/simulate/equilibrium.h"

// How a body at an equilibrium answers motions of what is held.

namespace tissue {

Eigen::VectorXd Equilibrium::response(const Eigen::VectorXd& positions,
                                      const Eigen::VectorXd& motion) {
  prepare(positions, nullptr);
  if (!is_prepared_) return motion;
  // With the forces that are out of balance left as they are, so that a start at an equilibrium
  // stays near one.
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(positions.size()), step;
  active_->multiply_add(motion, pull);
  if (!solve_for(positions, pull, step)) return motion;
  return motion + step;
}

// How dE/dx changes along a motion: the Hessian that systems have leaves out what would make it
// indefinite, differences do not.
Eigen::VectorXd Equilibrium::gradient_change(const Eigen::VectorXd& positions,
                                             const Eigen::VectorXd& gradient_there,
                                             const Eigen::VectorXd& motion) const {
  constexpr double kPart = 1e-6;
  Eigen::VectorXd change = Eigen::VectorXd::Zero(positions.size());
  const double farthest = motion.cwiseAbs().maxCoeff();
  if (quadratic_) {
    active_->multiply_add(motion, change);
  } else if (farthest > 0.0) {
    const double step = kPart * extent(positions) / farthest;
    change = (gradient(positions + step * motion) - gradient_there) / step;
  }
  return change;
}

std::vector<Eigen::VectorXd> Equilibrium::responses(const Eigen::VectorXd& positions,
                                                    const std::vector<Eigen::VectorXd>& motions,
                                                    const std::vector<Eigen::VectorXd>& pulls,
                                                    std::vector<Eigen::VectorXd>& forces) {
  constexpr double kTolerance = 1e-4;
  prepare(positions, nullptr);
  if (!is_prepared_) return {};
  std::vector<Eigen::VectorXd> answers;
  forces.clear();
  const Eigen::VectorXd there = quadratic_ ? Eigen::VectorXd() : gradient(positions);
  for (std::size_t k = 0; k < motions.size(); ++k) {
    Eigen::VectorXd pull = -pulls[k] - gradient_change(positions, there, motions[k]), step;
    restrict(pull);
    const int iterations = conjugate_gradients(
        pull, kTolerance,
        [&](const Eigen::VectorXd& from, Eigen::VectorXd& product) {
          product = gradient_change(positions, there, from);
          restrict(product);
        },
        [&](const Eigen::VectorXd& residual, Eigen::VectorXd& z) {
          if (!active_->precondition(residual, z)) z.setZero(residual.size());
        },
        step);
    if (iterations < 0) return {};
    answers.push_back(motions[k] + step);
    forces.push_back(pulls[k] + gradient_change(positions, there, answers.back()));
  }
  return answers;
}

void Equilibrium::follow(Eigen::VectorXd& positions, const Eigen::VectorXd& motion) {
  positions = moved(positions, response(positions, motion));
}

}  // namespace tissue
