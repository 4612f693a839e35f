#include "ros/device_adapter_node.h"

#include "ros/guarded.h"

#include <geometry_msgs/PoseStamped.h>
#include <ros/console.h>
#include <sensor_msgs/Joy.h>
#include <tf2_geometry_msgs/tf2_geometry_msgs.h>

#include <cmath>

namespace tissue_ros {

DeviceAdapterNode::DeviceAdapterNode(ros::NodeHandle handle, const ros::NodeHandle&,
                                     const DeviceAdapterNodeParameters& parameters)
    : parameters_(parameters) {
  const std::string &device = parameters.device, &name = parameters.name;
  if (device == "omni") {
    send_forces<OmniFeedback>(handle, name + "/force_feedback",
                              [](const geometry_msgs::Vector3& force) {
                                OmniFeedback feedback;
                                feedback.force = force;
                                return feedback;
                              });
  } else if (device == "geomagic") {
    send_forces<GeomagicFeedback>(handle, name + "/force_feedback",
                                  [](const geometry_msgs::Vector3& force) {
                                    GeomagicFeedback feedback;
                                    feedback.force = force;
                                    return feedback;
                                  });
  } else if (device == "crtk") {
    send_forces<geometry_msgs::WrenchStamped>(handle, name + "/servo_cf",
                                              [this](const geometry_msgs::Vector3& force) {
                                                geometry_msgs::WrenchStamped wrench;
                                                wrench.header.stamp = ros::Time::now();
                                                wrench.header.frame_id = parameters_.frame_id;
                                                wrench.wrench.force = force;
                                                return wrench;
                                              });
  } else if (device != "openigtlink") {
    throw tissue::InputError(
        tissue::ErrorCode::kParam,
        "~device: '" + device + "' is not omni, geomagic, crtk or openigtlink");
  }
  listen(handle);
}

DeviceAdapterNode::~DeviceAdapterNode() {
  if (send_force_) send_force_(geometry_msgs::Vector3());
}

template <class Message>
void DeviceAdapterNode::send_forces(
    ros::NodeHandle& handle, const std::string& topic,
    const std::function<Message(const geometry_msgs::Vector3&)>& message) {
  force_publisher_ = handle.advertise<Message>(topic, 1);
  send_force_ = [this, message](const geometry_msgs::Vector3& force) {
    force_publisher_.publish(message(force));
  };
}

void DeviceAdapterNode::listen(ros::NodeHandle& handle) {
  const ros::TransportHints at_once = ros::TransportHints().tcpNoDelay();
  const std::string &tool = parameters_.tool, &name = parameters_.name;
  if (parameters_.device == "omni") {
    button_publisher_ = handle.advertise<sensor_msgs::Joy>(tool + "/button", 1);
    subscribers_.push_back(
        handle.subscribe(name + "/state", 1, &DeviceAdapterNode::take_state, this, at_once));
    subscribers_.push_back(
        handle.subscribe(name + "/button", 10, &DeviceAdapterNode::take_buttons, this, at_once));
  }
  if (parameters_.device == "openigtlink") {
    // Transforms of other names share the topic.
    subscribers_.push_back(handle.subscribe("IGTL_TRANSFORM_IN", 10,
                                            &DeviceAdapterNode::take_transform, this, at_once));
  }
  if (!subscribers_.empty()) {
    pose_publisher_ = handle.advertise<geometry_msgs::PoseStamped>(tool + "/measured_cp", 1);
  }
  if (!send_force_) return;
  subscribers_.push_back(
      handle.subscribe(tool + "/servo_cf", 1, &DeviceAdapterNode::take_force, this, at_once));
  timer_ = handle.createWallTimer(ros::WallDuration(0.2 * parameters_.force_timeout),
                                  [this](const ros::WallTimerEvent&) { watch(); });
}

void DeviceAdapterNode::take_state(const OmniState& state) {
  publish_pose(state.header.stamp, state.pose);
}

void DeviceAdapterNode::take_transform(const IgtlTransform& transform) {
  if (!parameters_.name.empty() && transform.name != parameters_.name) return;
  geometry_msgs::Pose pose;
  pose.position.x = transform.transform.translation.x;
  pose.position.y = transform.transform.translation.y;
  pose.position.z = transform.transform.translation.z;
  pose.orientation = transform.transform.rotation;
  publish_pose(ros::Time(), pose);
}

void DeviceAdapterNode::publish_pose(const ros::Time& stamp, const geometry_msgs::Pose& pose) {
  geometry_msgs::PoseStamped stamped;
  stamped.header.stamp = stamp.isZero() ? ros::Time::now() : stamp;
  stamped.header.frame_id = parameters_.frame_id;
  stamped.pose = pose;
  stamped.pose.position.x *= parameters_.scale;
  stamped.pose.position.y *= parameters_.scale;
  stamped.pose.position.z *= parameters_.scale;
  pose_publisher_.publish(stamped);
}

void DeviceAdapterNode::take_buttons(const OmniButtonEvent& event) {
  sensor_msgs::Joy joy;
  joy.header.stamp = ros::Time::now();
  joy.buttons = {event.grey_button, event.white_button};
  button_publisher_.publish(joy);
}

void DeviceAdapterNode::take_force(const geometry_msgs::WrenchStamped& wrench) {
  geometry_msgs::Vector3 force = wrench.wrench.force;
  const Outcome outcome = guarded([&] {
    if (!std::isfinite(force.x) || !std::isfinite(force.y) || !std::isfinite(force.z)) {
      throw tissue::InputError(tissue::ErrorCode::kNonfinite, "force is not finite");
    }
    const std::string& frame = wrench.header.frame_id;
    if (frame == parameters_.frame_id) return;
    tf2::doTransform(force, force,
                     transforms_.lookupTransform(parameters_.frame_id, frame, ros::Time(0)));
  });
  if (!outcome.ok()) {
    ROS_WARN_THROTTLE(1.0, "device_adapter_node: no force: %s/servo_cf: %s",
                      parameters_.tool.c_str(), outcome.sentence.c_str());
    force = geometry_msgs::Vector3();
  }
  pushes_ = true;
  last_force_ = ros::WallTime::now();
  send_force_(force);
}

void DeviceAdapterNode::watch() {
  if (!pushes_ || (ros::WallTime::now() - last_force_).toSec() < parameters_.force_timeout) return;
  pushes_ = false;
  send_force_(geometry_msgs::Vector3());
}

}  // namespace tissue_ros
