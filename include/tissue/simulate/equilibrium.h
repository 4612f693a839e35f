#pragma once

#include "tissue/simulate/energy.h"
#include "tissue/simulate/linear_solver.h"

#include <memory>
#include <vector>

namespace tissue {

struct EquilibriumOptions {
  /// Of the residual: the norm of the forces on free nodes, by that of the forces that hold fixed
  /// ones or, if it is larger, of those that were out of balance at the start.
  double tolerance = 1e-3;
  int max_iterations = 200;
};

struct EquilibriumReport {
  bool converged = false;
  int iterations = 0;
  double residual = 0.0;
  /// At the end [J].
  double energy = 0.0;
};

/// Finds where a body comes to rest: the nearest minimum of its energy over the free nodes, by
/// Newton's method with a line search.
class Equilibrium {
 public:
  /// `energies` must outlive this; `pattern` has a block wherever one of them adds one. Where all
  /// of them are quadratic the Hessian is made, and the solver prepared, once for the same fixed
  /// nodes.
  Equilibrium(std::vector<const Energy*> energies, BlockMatrix pattern,
              std::unique_ptr<LinearSolver> solver, bool quadratic = false);

  /// Which nodes do not move by themselves, a flag for each. Throws InputError E_PARAM if all are.
  void hold(const std::vector<std::uint8_t>& fixed_nodes);
  /// The same by coordinates, three flags for each node: a node may slide along an axis.
  void hold_coordinates(const std::vector<std::uint8_t>& fixed);

  /// From `positions`, in which fixed nodes are where they are to be, to the equilibrium. Where it
  /// is not found `positions` holds the best finite state that was.
  EquilibriumReport solve(Eigen::VectorXd& positions, const EquilibriumOptions& options);

  /// One step of Newton's method without a line search, in which what is held moves by `motion`:
  /// with inertia among the energies a linearised step of implicit Euler. The residual is the
  /// linear system's, ‖b − A x‖ / ‖b‖; not converged where that could not be solved.
  EquilibriumReport linearised_step(Eigen::VectorXd& positions, const Eigen::VectorXd& motion);
  /// To be called when the Hessian of a quadratic energy, which is kept, has changed.
  void forget_hessian() { is_prepared_ = false; }

  /// How the free nodes move when the fixed ones do, to first order: a start nearer to the
  /// equilibrium than leaving them behind. `motion` holds the motion of fixed nodes.
  void follow(Eigen::VectorXd& positions, const Eigen::VectorXd& motion);

  /// That motion of all nodes; `motion` alone where the Hessian cannot be factorised.
  Eigen::VectorXd response(const Eigen::VectorXd& positions, const Eigen::VectorXd& motion);

  /// The method by which linear systems were solved last.
  const char* solver_name() const { return solver_->name(); }

  double energy(const Eigen::VectorXd& positions) const;
  /// dE/dx of all nodes; at fixed ones it is the force that holds them [N].
  Eigen::VectorXd gradient(const Eigen::VectorXd& positions) const;

 private:
  bool prepare(const Eigen::VectorXd& positions);
  bool step_for(const Eigen::VectorXd& gradient, Eigen::VectorXd& step) const;
  double norm_of(const Eigen::VectorXd& gradient, bool of_fixed) const;
  bool line_search(const Eigen::VectorXd& step, const Eigen::VectorXd& gradient,
                   Eigen::VectorXd& positions, double& energy) const;

  std::vector<const Energy*> energies_;
  BlockMatrix hessian_;
  // A flag for each coordinate.
  std::vector<std::uint8_t> fixed_;
  double largest_stiffness_ = 0.0;
  std::unique_ptr<LinearSolver> solver_;
  bool quadratic_;
  bool is_prepared_ = false;
};

}  // namespace tissue
