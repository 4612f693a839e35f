#pragma once

#include "ros/display_mesh.h"

#include <visualization_msgs/MarkerArray.h>

#include <functional>

namespace tissue_ros {

/// Where a vertex is drawn.
using PlaceOf = std::function<tissue::Vec3(std::uint32_t)>;

/// One TRIANGLE_LIST per level, in namespace `level_<n>`: 0 red, 1 green, 2 blue as in the paper,
/// further levels lighter; and the edges of the laid-open tets in namespace `edges`.
visualization_msgs::MarkerArray level_markers(const DisplayMesh& display, const PlaceOf& place,
                                              const std::string& frame_id);

/// The same faces in namespace `density`, dark where soft and light where dense.
visualization_msgs::MarkerArray density_markers(const DisplayMesh& display,
                                                const tissue::TetMesh& mesh);

/// The same markers after an order to delete all that were there before.
visualization_msgs::MarkerArray replacing_all(visualization_msgs::MarkerArray array);

/// A yellow ball in a namespace of its own, seen through where `opacity` is below 1.
visualization_msgs::Marker ball_marker(const std::string& name, const tissue::Vec3& position,
                                       double radius, float opacity, const std::string& frame_id);

}  // namespace tissue_ros
