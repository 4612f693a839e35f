#include "ros/pose_input.h"

#include "ros/convert.h"

#include <tf2_geometry_msgs/tf2_geometry_msgs.h>

#include <cmath>

namespace tissue_ros {

std::string pose_problem(const geometry_msgs::PoseStamped& pose) {
  const auto& p = pose.pose.position;
  const auto& q = pose.pose.orientation;
  if (pose.header.stamp.isZero()) return "header.stamp is 0, which marks an invalid pose";
  if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
    return "pose.position is not finite";
  }
  const double norm = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (!(norm >= 0.9 && norm <= 1.1)) {
    return "pose.orientation has norm " + tissue::to_text(norm) + ", not 1";
  }
  return "";
}

std::optional<geometry_msgs::PoseStamped> pose_in_frame(const geometry_msgs::PoseStamped& pose,
                                                        const std::string& frame,
                                                        const tf2_ros::Buffer& buffer,
                                                        std::string& why_not) {
  geometry_msgs::PoseStamped plain = pose;
  plain.header.frame_id = plain_frame(pose.header.frame_id);
  if (plain.header.frame_id == frame) return plain;
  if (plain.header.frame_id.empty()) {
    why_not = "header.frame_id is empty";
    return std::nullopt;
  }
  const std::string& source = plain.header.frame_id;
  const ros::Time when =
      buffer.canTransform(frame, source, plain.header.stamp) ? plain.header.stamp : ros::Time(0);
  try {
    geometry_msgs::PoseStamped result;
    tf2::doTransform(plain, result, buffer.lookupTransform(frame, source, when));
    result.header.stamp = plain.header.stamp;
    return result;
  } catch (const tf2::TransformException& exception) {
    why_not = exception.what();
    return std::nullopt;
  }
}

}  // namespace tissue_ros
