#include "ros/tool_path_node.h"

#include "ros/geometry.h"
#include "tissue/base/error.h"

#include <geometry_msgs/PoseStamped.h>

#include <cmath>

namespace tissue_ros {
namespace {

using tissue::ErrorCode;
using tissue::InputError;

}  // namespace

tissue::Vec3 place_from(const char* name, const std::vector<double>& numbers) {
  if (numbers.size() != 3) {
    throw InputError(ErrorCode::kParam, std::string("~") + name + ": has " +
                                            std::to_string(numbers.size()) +
                                            " numbers, not x, y, z");
  }
  for (const double number : numbers) {
    if (!std::isfinite(number)) {
      throw InputError(ErrorCode::kNonfinite, std::string("~") + name + ": is not finite");
    }
  }
  return {numbers[0], numbers[1], numbers[2]};
}

std::vector<tissue::StampedPose> path_of(const ToolPathNodeParameters& parameters) {
  if (parameters.kind == "line") {
    const tissue::Vec3 from = place_from("from", parameters.from),
                       to = place_from("to", parameters.to);
    return tissue::line_path(from, to, parameters.period);
  }
  if (parameters.kind == "circle") {
    const tissue::Vec3 centre = place_from("centre", parameters.centre),
                       axis = place_from("axis", parameters.axis);
    return tissue::circle_path(centre, axis, parameters.radius, parameters.period);
  }
  if (parameters.kind != "file") {
    throw InputError(ErrorCode::kParam,
                     "~kind: '" + parameters.kind + "' is not file, line or circle");
  }
  std::vector<tissue::StampedPose> path = tissue::read_poses(parameters.file);
  if (path.empty()) {
    throw InputError(ErrorCode::kFile, "~file: '" + parameters.file + "' has no poses");
  }
  return path;
}

ToolPathNode::ToolPathNode(ros::NodeHandle handle, const ros::NodeHandle&,
                           const ToolPathNodeParameters& parameters)
    : parameters_(parameters), path_(path_of(parameters)) {
  publisher_ = handle.advertise<geometry_msgs::PoseStamped>(parameters.tool + "/measured_cp", 1);
  timer_ = handle.createWallTimer(ros::WallDuration(1.0 / parameters.rate),
                                  [this](const ros::WallTimerEvent&) { publish(); });
}

void ToolPathNode::publish() {
  if (publisher_.getNumSubscribers() == 0) return;
  // It begins when somebody looks.
  if (start_.isZero()) start_ = ros::WallTime::now();
  const double first = path_.front().time, duration = path_.back().time - first,
               gone = (ros::WallTime::now() - start_).toSec();
  const tissue::ToolPose pose =
      pose_at(path_, first + (duration > 0.0 ? std::fmod(gone, duration) : 0.0));
  geometry_msgs::PoseStamped message;
  message.header.frame_id = parameters_.frame_id;
  message.header.stamp = ros::Time::now();
  message.pose.position = point_message(pose.position);
  message.pose.orientation = quaternion_message(pose.orientation);
  publisher_.publish(message);
}

}  // namespace tissue_ros
