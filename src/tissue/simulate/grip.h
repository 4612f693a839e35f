#pragma once

#include "jaw.h"

namespace tissue {

/// What a tool holds: the vertices that were within its sphere when its jaw closed (or when a tool
/// without a jaw first touched any), as if they were part of it.
class Grip {
 public:
  /// Takes hold, keeps it or lets go. True if that changed what is held. Vertices
  /// that have a holder already stay with it; of an inclusion, if there are any, all are taken.
  bool update(const std::optional<ToolPose>& pose, const ToolDescription& tool,
              const std::vector<Vec3>& vertices_now, const std::vector<int>& holders,
              const std::vector<int>& inclusions);

  const std::vector<std::uint32_t>& vertices() const { return vertices_; }
  /// Calls body(vertex, place) for each of them with where the tool at `pose` takes it.
  template <class Body>
  void for_each_place(const ToolPose& pose, const Body& body) const {
    const Mat3 turn = pose.orientation.normalized().toRotationMatrix();
    for (std::size_t k = 0; k < vertices_.size(); ++k) {
      body(vertices_[k], Vec3(pose.position + turn * offsets_[k]));
    }
  }

 private:
  std::vector<std::uint32_t> vertices_;
  // From the tool's centre, in the tool's frame.
  std::vector<Vec3> offsets_;
  Jaw jaw_;
};

}  // namespace tissue
