#pragma once

#include "tissue/simulate/scene.h"

namespace tissue {

/// What a tool holds: the vertices that were within its sphere when its jaw closed (or when a tool
/// without a jaw first touched any), as if they were part of it.
class Grip {
 public:
  /// Takes hold, keeps it or lets go. True if that changed what is held. Vertices
  /// that have a holder already stay with it.
  bool update(const std::optional<ToolPose>& pose, const ToolDescription& tool,
              const std::vector<Vec3>& vertices_now, const std::vector<int>& holders);

  const std::vector<std::uint32_t>& vertices() const { return vertices_; }
  /// Where the tool at `pose` takes the k-th of them.
  Vec3 place(std::size_t k, const ToolPose& pose) const {
    return pose.position + pose.orientation.normalized() * offsets_[k];
  }

 private:
  std::vector<std::uint32_t> vertices_;
  // From the tool's centre, in the tool's frame.
  std::vector<Vec3> offsets_;
  bool was_closed_ = false;
};

}  // namespace tissue
