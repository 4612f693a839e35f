#pragma once

#include "tissue/simulate/energy.h"
#include "tissue/simulate/equilibrium_options.h"
#include "tissue/simulate/linear_system.h"

#include <memory>
#include <vector>

namespace tissue {

class RigidMotions;

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
  /// `energies` must outlive this. What `system` cannot solve is left to one that `fallback` makes,
  /// if there is any. Where all energies are quadratic the Hessian is made, and the system
  /// prepared, once for the same fixed nodes. Where not all motions are free, `motions` says which
  /// are, and systems know of it.
  Equilibrium(std::vector<const Energy*> energies, std::unique_ptr<LinearSystem> system,
              LinearSystemMaker fallback = {}, bool quadratic = false,
              RigidMotions* motions = nullptr);

  /// Which nodes do not move by themselves, a flag for each. Throws InputError E_PARAM if all are.
  void hold(const std::vector<std::uint8_t>& fixed_nodes);
  /// The same by coordinates, three flags for each node: a node may slide along an axis.
  void hold_coordinates(const std::vector<std::uint8_t>& fixed);

  /// From `positions`, in which fixed nodes are where they are to be, to the equilibrium. Where it
  /// is not found `positions` holds the best finite state that was.
  EquilibriumReport solve(Eigen::VectorXd& positions, const EquilibriumOptions& options);

  /// One step of Newton's method without a line search, in which what is held moves by `motion`:
  /// with inertia among the energies a linearised step of implicit Euler. The residual is the
  /// linear system's, ‖b − A x‖ / ‖b‖. Not converged where that could not be solved or the energy
  /// is more at the end than it was after the motion alone.
  EquilibriumReport linearised_step(Eigen::VectorXd& positions, const Eigen::VectorXd& motion);
  /// To be called when the Hessian of a quadratic energy, which is kept, has changed.
  void forget_hessian() { is_prepared_ = false; }

  /// How the free nodes move when the fixed ones do, to first order: a start nearer to the
  /// equilibrium than leaving them behind. `motion` holds the motion of fixed nodes.
  void follow(Eigen::VectorXd& positions, const Eigen::VectorXd& motion);

  /// That motion of all nodes; `motion` alone where the Hessian cannot be factorised.
  Eigen::VectorXd response(const Eigen::VectorXd& positions, const Eigen::VectorXd& motion);

  /// The same for several motions at once, where dE/dx changes by `pulls` besides; `forces` become
  /// the changes of dE/dx that the answers then leave to what is held. By differences of the
  /// gradient, and so without what the Hessian leaves out. Empty where that is not positive
  /// definite.
  std::vector<Eigen::VectorXd> responses(const Eigen::VectorXd& positions,
                                         const std::vector<Eigen::VectorXd>& motions,
                                         const std::vector<Eigen::VectorXd>& pulls,
                                         std::vector<Eigen::VectorXd>& forces);

  /// How many numbers are to be found.
  std::size_t unknowns() const;
  /// The method by which linear systems were solved last.
  const char* solver_name() const { return active_->name(); }

  double energy(const Eigen::VectorXd& positions) const {
    return evaluate(positions, nullptr, nullptr);
  }
  /// dE/dx of all nodes; at fixed ones it is the force that holds them [N].
  Eigen::VectorXd gradient(const Eigen::VectorXd& positions) const;

 private:
  double evaluate(const Eigen::VectorXd& positions, Eigen::VectorXd* gradient,
                  Hessian* hessian) const;
  Eigen::VectorXd gradient_change(const Eigen::VectorXd& positions,
                                  const Eigen::VectorXd& gradient_there,
                                  const Eigen::VectorXd& motion) const;
  static double extent(const Eigen::VectorXd& positions);
  bool is_rounding(double force, const Eigen::VectorXd& positions) const;
  double prepare(const Eigen::VectorXd& positions, Eigen::VectorXd* gradient);
  bool use_fallback(const Eigen::VectorXd& positions);
  bool prepare_active();
  bool solve_for(const Eigen::VectorXd& positions, const Eigen::VectorXd& pull,
                 Eigen::VectorXd& step);
  Eigen::VectorXd penalties(const Eigen::VectorXd& positions) const;
  Eigen::VectorXd moved(const Eigen::VectorXd& positions, const Eigen::VectorXd& motion) const;
  void restrict(Eigen::VectorXd& forces) const;
  double norm_of(const Eigen::VectorXd& gradient, bool of_fixed) const;
  bool line_search(const Eigen::VectorXd& step, Eigen::VectorXd& gradient,
                   Eigen::VectorXd& positions, double& energy) const;

  std::vector<const Energy*> energies_;
  // A flag for each coordinate; none where nothing is held.
  std::vector<std::uint8_t> fixed_;
  double largest_stiffness_ = 0.0;
  std::unique_ptr<LinearSystem> system_, fallback_;
  LinearSystemMaker make_fallback_;
  // Which of them has the Hessian.
  LinearSystem* active_;
  bool quadratic_;
  RigidMotions* motions_;
  bool is_prepared_ = false;
};

}  // namespace tissue
