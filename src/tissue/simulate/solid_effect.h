#pragma once

#include "tissue/base/run.h"
#include "tissue/simulate/energy.h"
#include "tissue/simulate/equilibrium.h"
#include "tissue/simulate/finite_elements.h"
#include "tissue/simulate/scene.h"

#include <functional>

namespace tissue {

class HeldNodes;
class ToolLink;
class ToolResponse;

/// Gives the positions of all nodes, which after a superposition are found out only when asked for.
using PositionsNow = std::function<const Eigen::VectorXd&()>;

/// What an effect may look at when it is made; all of it outlives the effect.
struct SolidParts {
  const SceneDescription& scene;
  const Body& body;
  const FiniteElements& elements;
  /// Young's modulus of each tet [Pa].
  const std::vector<double>& young;
};

/// What an effect may look at after a step.
struct SolidView {
  const ToolPoses& tools;
  const PositionsNow& positions;
  Equilibrium& equilibrium;
  const HeldNodes& held;
  const std::vector<const ToolLink*>& links;
  /// Only tools have moved since the last step, of a body in which all is linear.
  bool is_superposed = false;
  /// How it was superposed; null if it was not.
  const ToolResponse* response = nullptr;
};

/// What an effect is in a solid: the one shape of all of them. Whatever one does not override is
/// not done. Time spent in here counts as the effect's.
///
/// In each step the tools first take hold or let go, then go to their places, in strides as long as
/// all effects can bear; at each place an equilibrium (or a step in time) is found, and found again
/// while an effect says so.
class SolidEffect {
 public:
  virtual ~SolidEffect() = default;
  virtual std::size_t bytes() const { return 0; }
  /// Back to rest, without tools.
  virtual void reset() {}

  /// What it adds to the energy of the body, if anything.
  virtual const Energy* energy() const { return nullptr; }
  /// Whether that is at most quadratic in the positions.
  virtual bool is_quadratic() const { return true; }
  /// Whether its Hessian reaches farther than elements.
  virtual bool adds_squares() const { return false; }
  /// Whether it moves a body that is at rest.
  virtual bool loads() const { return energy() != nullptr; }

  /// Tools take hold of the body as it is, or let go. True if forces change by that.
  virtual bool take(const ToolPoses&, const PositionsNow&) { return false; }
  /// How much of the way from `from` to `to` tools may go at once, from 0 to 1.
  virtual double stride(const ToolPoses&, const ToolPoses&, const Eigen::VectorXd&) { return 1.0; }
  /// Tools are there now. True if forces change by that.
  virtual bool follow(const ToolPoses&, const Eigen::VectorXd&) { return false; }
  /// Whether one linearised step is too rough for what is going on.
  virtual bool is_stiff() const { return false; }
  /// Called with what was found: true if it is to be found again. Throws nothing.
  virtual bool refine(const Eigen::VectorXd&) { return false; }
  /// Whether what was found in the end will do.
  virtual bool accepts(const Eigen::VectorXd&) const { return true; }
  /// How tools act through it, if they do.
  virtual const ToolLink* link() const { return nullptr; }

  virtual void after_step(const SolidView&) {}
  virtual void report(StepReport&) const {}
  /// What each tool feels; nothing at all unless that is what the effect is about.
  virtual const std::vector<std::optional<ToolFeedback>>* feedback() const { return nullptr; }
};

/// What ties tools to tissue by forces that the energy knows, not by holding nodes.
class ToolLink {
 public:
  virtual ~ToolLink() = default;
  virtual bool acts_on(std::size_t tool) const = 0;
  /// Of the tissue on a tool.
  virtual Wrench wrench(std::size_t tool, const Eigen::VectorXd& positions,
                        const Vec3& centre) const = 0;
  /// Adds how dE/dx changes for each metre by which a tool moves along `direction`.
  virtual void add_pull(std::size_t tool, const Eigen::VectorXd& positions, const Vec3& direction,
                        Eigen::VectorXd& gradient) const = 0;
  /// How the force on a tool changes where that moves by `direction` and the nodes by `response`.
  virtual Vec3 force_change(std::size_t tool, const Eigen::VectorXd& positions,
                            const Vec3& direction, const Eigen::VectorXd& response) const = 0;
};

}  // namespace tissue
