#pragma once

#include "jaw.h"
#include "surface_springs.h"

namespace tissue {

/// Tools that move the surface through soft pads, stiffest in the middle and fading out towards the
/// rim.
class Pads {
 public:
  /// References must outlive this; tool i is holder `first_holder` + i.
  Pads(const std::vector<ToolDescription>& tools, std::size_t first_holder,
       SurfaceSprings& springs);

  /// Tools take hold of the surface as it is, or let go. True if that changed anything.
  bool update(const ToolPoses& tools, const Eigen::VectorXd& positions);
  void release();

  /// How far the ends of all springs are from where the tools take them, three after three; what no
  /// tool with a pose holds stays.
  Eigen::VectorXd motion_to(const ToolPoses& tools) const;

 private:
  struct Pad {
    Jaw jaw;
    // Of the springs' ends, from the tool's centre in its frame [m].
    std::vector<Vec3> offsets;
  };
  const std::vector<ToolDescription>& tools_;
  std::size_t first_holder_;
  SurfaceSprings& springs_;
  std::vector<Pad> pads_;
};

}  // namespace tissue
