#pragma once

#include "ros/foreign_messages.h"
#include "ros/parameters.h"

#include <geometry_msgs/WrenchStamped.h>
#include <ros/node_handle.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <functional>
#include <string>

namespace tissue_ros {

/// Stands between deformer_node and a driver that does not speak as CRTK does: makes
/// `<tool>/measured_cp` (metres, stamped) and `<tool>/button` of what the driver says, and what it
/// takes for a force of `<tool>/servo_cf`, in the device's frame. The force is zero at the end, and
/// when none comes for `force_timeout`, since drivers hold the last one for ever.
///
/// - omni: from `<name>/state` and `<name>/button`, to `<name>/force_feedback`, all of omni_msgs
/// - geomagic: to `<name>/force_feedback` of geomagic_control; PoseStamped and Joy need no adapter
/// - crtk: to `<name>/servo_cf`, a WrenchStamped
/// - openigtlink: from `IGTL_TRANSFORM_IN` of ros_igtl_bridge
class DeviceAdapterNode {
 public:
  /// Throws tissue::InputError E_PARAM for an unknown device.
  DeviceAdapterNode(ros::NodeHandle handle, const ros::NodeHandle& private_handle,
                    const DeviceAdapterNodeParameters& parameters);
  /// No force any more.
  ~DeviceAdapterNode();
  DeviceAdapterNode(const DeviceAdapterNode&) = delete;
  DeviceAdapterNode& operator=(const DeviceAdapterNode&) = delete;

 private:
  void take_state(const OmniState& state);
  void take_transform(const IgtlTransform& transform);
  void take_buttons(const OmniButtonEvent& event);
  void take_force(const geometry_msgs::WrenchStamped& wrench);
  void publish_pose(const ros::Time& stamp, const geometry_msgs::Pose& pose);
  void watch();
  template <class Message>
  void send_forces(ros::NodeHandle& handle, const std::string& topic,
                   const std::function<Message(const geometry_msgs::Vector3&)>& message);
  void listen(ros::NodeHandle& handle);

  DeviceAdapterNodeParameters parameters_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener transform_listener_{transforms_};
  ros::Publisher pose_publisher_, button_publisher_, force_publisher_;
  std::function<void(const geometry_msgs::Vector3&)> send_force_;
  bool pushes_ = false;
  ros::WallTime last_force_;
  std::vector<ros::Subscriber> subscribers_;
  ros::WallTimer timer_;
};

}  // namespace tissue_ros
