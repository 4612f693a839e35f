#pragma once

#include "node_surface.h"
#include "tissue/simulate/energy.h"

#include <functional>

namespace tissue {

/// Springs from the surface to holders, as stiff for each unit of area as somebody says: tools by
/// soft pads, anchors by soft beds. Stiffness is integrated over the surface, so that what it does
/// to a body hardly depends on the mesh.
class SurfaceSprings : public Energy {
 public:
  struct Spring {
    std::size_t holder = 0;
    std::uint32_t node = 0;
    // [N/m]
    double stiffness = 0.0;
    // The holder's end [m].
    Vec3 target = Vec3::Zero();
  };

  /// `elements` must outlive this.
  SurfaceSprings(const FiniteElements& elements, const Body& body);

  /// Attaches the surface, where the nodes are now, to a holder by springs without tension;
  /// `stiffness_at` says how stiff at each place [Pa/m].
  void attach(std::size_t holder, const Eigen::VectorXd& positions,
              const std::function<double(const Vec3&)>& stiffness_at);
  void detach(std::size_t holder);
  bool is_attached(std::size_t holder) const;

  /// Those of one holder keep their order.
  const std::vector<Spring>& springs() const { return springs_; }
  /// Moves the holders' ends, three coordinates for each spring.
  void move(const Eigen::VectorXd& motion);

  double evaluate(const Eigen::VectorXd& positions, Eigen::VectorXd* gradient,
                  Hessian* hessian) const override;
  /// Of the tissue on a holder [N]: minus the derivative of the energy by the holder's place.
  Vec3 force(std::size_t holder, const Eigen::VectorXd& positions) const;

 private:
  NodeSurface surface_;
  std::vector<Spring> springs_;
};

}  // namespace tissue
