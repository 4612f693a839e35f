#pragma once

#include "tissue/simulate/scene.h"

namespace tissue {

/// A node that a tool holds.
struct Hold {
  std::uint32_t node = 0;
  /// From the tool's centre, in the tool's frame, when it took hold [m].
  Vec3 offset = Vec3::Zero();
  /// Where the node was then [m].
  Vec3 start = Vec3::Zero();
  /// How far the node goes of the way on which the tool would carry it: 1, or less towards the rim
  /// of a patch.
  double share = 1.0;

  /// Where a tool at `pose`, turned by `turn`, takes the node.
  Vec3 place(const ToolPose& pose, const Mat3& turn) const {
    const Vec3 carried = pose.position + turn * offset;
    return share == 1.0 ? carried : Vec3(start + share * (carried - start));
  }
};

/// What a tool holds: what was within its shape when its jaw closed (or when a tool without a jaw
/// first touched any), as if it were part of the tool.
class Grip {
 public:
  /// Takes hold of vertices, keeps them or lets go. True if that changed what is held. Vertices that
  /// have a holder already stay with it; a patch takes only vertices that are `on_surface`.
  bool update(const std::optional<ToolPose>& pose, const ToolDescription& tool,
              const std::vector<Vec3>& vertices_now, const std::vector<int>& holders,
              const std::vector<std::uint8_t>& on_surface);
  /// Takes one more node, of which it may hold none yet.
  void take(std::uint32_t node, const Vec3& place, const ToolPose& pose,
            const ToolDescription& tool);

  const std::vector<Hold>& holds() const { return holds_; }
  bool empty() const { return holds_.empty(); }

 private:
  std::vector<Hold> holds_;
  bool was_closed_ = false;
};

}  // namespace tissue
