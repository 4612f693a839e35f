#pragma once

#include "tissue/simulate/playback.h"

#include <tf2_ros/buffer.h>
#include <topic_tools/shape_shifter.h>

#include <optional>
#include <string>

namespace tissue_ros {

/// A message of a type that is found out when it is there, from a topic or a bag.
using AnyMessage = topic_tools::ShapeShifter;

/// Reads what the device of a tool says, in the messages that drivers use.
class DeviceReader {
 public:
  /// For the tool of this number in its scene. Poses are given in `frame`; `transforms`, which may
  /// be null, says where other frames are and must outlive this.
  DeviceReader(tissue::ToolDescription tool, std::size_t number, std::string frame,
               const tf2_ros::Buffer* transforms);

  /// Of a geometry_msgs/PoseStamped or TransformStamped. Throws tissue::InputError, whose sentence
  /// names topic, field and value: E_PARAM for another type, a stamp of 0 (which CRTK means as
  /// "pose invalid") or a quaternion whose norm is not within 0.9 to 1.1, E_NONFINITE, and E_FRAME
  /// for a frame that is not known now. Never waits.
  tissue::ToolSample pose(const AnyMessage& message) const;
  /// Of a sensor_msgs/JointState (the first joint's angle) or Joy (the first button); nothing where
  /// that says neither open nor closed. Throws as pose().
  std::optional<tissue::ToolSample> grip(const AnyMessage& message) const;
  /// Of a crtk_msgs/operating_state: whether the device is enabled. Throws as pose().
  bool is_enabled(const AnyMessage& message) const;

 private:
  tissue::ToolDescription tool_;
  std::size_t number_;
  std::string frame_;
  const tf2_ros::Buffer* transforms_;
};

}  // namespace tissue_ros
