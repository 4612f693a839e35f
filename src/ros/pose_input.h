#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <tf2_ros/buffer.h>

#include <optional>
#include <string>

namespace tissue_ros {

/// Why a pose cannot be used; empty if it can. Positions must be finite, the quaternion's norm
/// within 0.9 to 1.1, the stamp not 0 (which CRTK means as "pose invalid").
std::string pose_problem(const geometry_msgs::PoseStamped& pose);

/// The pose in `frame`, with the transform of its stamp or else the newest; nothing, and why, if tf
/// does not know it now. Never waits.
std::optional<geometry_msgs::PoseStamped> pose_in_frame(const geometry_msgs::PoseStamped& pose,
                                                        const std::string& frame,
                                                        const tf2_ros::Buffer& buffer,
                                                        std::string& why_not);

}  // namespace tissue_ros
