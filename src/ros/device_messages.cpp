#include "ros/device_messages.h"

#include "ros/convert.h"
#include "tissue/base/error.h"

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/Joy.h>
#include <tf2_geometry_msgs/tf2_geometry_msgs.h>

#include <cmath>

namespace tissue_ros {
namespace {

using tissue::ErrorCode;
using tissue::InputError;

template <class Message>
bool is(const AnyMessage& message) {
  return message.getMD5Sum() == ros::message_traits::md5sum<Message>() &&
         message.getDataType() == ros::message_traits::datatype<Message>();
}

[[noreturn]] void refuse(const std::string& topic, ErrorCode code, const std::string& why) {
  throw InputError(code, topic + ": " + why);
}

[[noreturn]] void refuse_type(const std::string& topic, const AnyMessage& message,
                              const char* wanted) {
  refuse(topic, ErrorCode::kParam, message.getDataType() + " is not " + wanted);
}

// As crtk_msgs defines it; the package itself is rarely installed.
struct OperatingState {
  std_msgs::Header header;
  std::string state;
  std::uint8_t is_homed = 0, is_busy = 0;
};

std::int64_t nanoseconds(const std::string& topic, const ros::Time& stamp) {
  if (stamp.isZero()) {
    refuse(topic, ErrorCode::kParam, "header.stamp is 0, which marks what is invalid");
  }
  return static_cast<std::int64_t>(stamp.toNSec());
}

geometry_msgs::PoseStamped pose_of(const AnyMessage& message, const std::string& topic) {
  if (is<geometry_msgs::PoseStamped>(message)) {
    return *message.instantiate<geometry_msgs::PoseStamped>();
  }
  if (!is<geometry_msgs::TransformStamped>(message)) {
    refuse_type(topic, message, "geometry_msgs/PoseStamped or TransformStamped");
  }
  const auto transform = message.instantiate<geometry_msgs::TransformStamped>();
  geometry_msgs::PoseStamped pose;
  pose.header = transform->header;
  pose.pose.position.x = transform->transform.translation.x;
  pose.pose.position.y = transform->transform.translation.y;
  pose.pose.position.z = transform->transform.translation.z;
  pose.pose.orientation = transform->transform.rotation;
  return pose;
}

// With the transform of its stamp, or else the newest.
geometry_msgs::PoseStamped in_frame(const geometry_msgs::PoseStamped& pose,
                                    const std::string& frame, const tf2_ros::Buffer* transforms,
                                    const std::string& topic) {
  const std::string& source = pose.header.frame_id;
  if (source == frame) return pose;
  if (source.empty()) refuse(topic, ErrorCode::kFrame, "header.frame_id is empty");
  if (source.size() > kMaxNameLength)
    refuse(topic, ErrorCode::kFrame, "header.frame_id is too long");
  if (transforms == nullptr) {
    refuse(topic, ErrorCode::kFrame, "frame '" + source + "' is not the mesh's, '" + frame + "'");
  }
  const ros::Time when =
      transforms->canTransform(frame, source, pose.header.stamp) ? pose.header.stamp : ros::Time(0);
  try {
    geometry_msgs::PoseStamped result;
    tf2::doTransform(pose, result, transforms->lookupTransform(frame, source, when));
    result.header.stamp = pose.header.stamp;
    return result;
  } catch (const tf2::TransformException& exception) {
    refuse(topic, ErrorCode::kFrame, exception.what());
  }
}

}  // namespace

DeviceReader::DeviceReader(tissue::ToolDescription tool, std::size_t number, std::string frame,
                           const tf2_ros::Buffer* transforms)
    : tool_(std::move(tool)), number_(number), frame_(std::move(frame)), transforms_(transforms) {}

tissue::ToolSample DeviceReader::pose(const AnyMessage& message) const {
  const std::string topic = tool_.pose_topic();
  geometry_msgs::PoseStamped pose = pose_of(message, topic);
  auto& p = pose.pose.position;
  const auto& q = pose.pose.orientation;
  const std::int64_t stamp = nanoseconds(topic, pose.header.stamp);
  if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
    refuse(topic, ErrorCode::kNonfinite, "position is not finite");
  }
  const double norm = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (!(norm >= 0.9 && norm <= 1.1)) {
    refuse(topic, ErrorCode::kParam, "orientation has norm " + tissue::to_text(norm) + ", not 1");
  }
  p.x *= tool_.input.scale;
  p.y *= tool_.input.scale;
  p.z *= tool_.input.scale;
  pose.header.frame_id =
      plain_frame(tool_.input.frame.empty() ? pose.header.frame_id : tool_.input.frame);
  pose = in_frame(pose, frame_, transforms_, topic);
  tissue::ToolPose place;
  place.position = tissue::Vec3(p.x, p.y, p.z);
  if (!(place.position.cwiseAbs().maxCoeff() <= tissue::kFarthestTool)) {
    refuse(topic, ErrorCode::kParam,
           "position is farther than " + tissue::to_text(tissue::kFarthestTool) + " m away");
  }
  place.orientation = Eigen::Quaterniond(q.w, q.x, q.y, q.z);
  return {number_, stamp, place};
}

std::optional<tissue::ToolSample> DeviceReader::grip(const AnyMessage& message) const {
  const std::string& topic = tool_.input.jaw.empty() ? tool_.input.button : tool_.input.jaw;
  if (!tool_.input.jaw.empty()) {
    if (!is<sensor_msgs::JointState>(message)) {
      refuse_type(topic, message, "sensor_msgs/JointState");
    }
    const auto joints = message.instantiate<sensor_msgs::JointState>();
    if (joints->position.empty()) refuse(topic, ErrorCode::kParam, "position is empty");
    const double angle = joints->position[0];
    if (!std::isfinite(angle)) refuse(topic, ErrorCode::kNonfinite, "position[0] is not finite");
    return tissue::ToolSample{number_, nanoseconds(topic, joints->header.stamp), std::nullopt,
                              angle < tool_.input.closed_below};
  }
  if (!is<sensor_msgs::Joy>(message)) refuse_type(topic, message, "sensor_msgs/Joy");
  const auto joy = message.instantiate<sensor_msgs::Joy>();
  if (joy->buttons.empty()) refuse(topic, ErrorCode::kParam, "buttons is empty");
  const std::int32_t button = joy->buttons[0];
  // CRTK: 0 released, 1 pressed, 2 a click that is over.
  if (button != 0 && button != 1) return std::nullopt;
  return tissue::ToolSample{number_, nanoseconds(topic, joy->header.stamp), std::nullopt,
                            button == 1};
}

bool DeviceReader::is_enabled(const AnyMessage& message) const {
  if (message.getDataType() != "crtk_msgs/operating_state") {
    refuse_type(tool_.input.state, message, "crtk_msgs/operating_state");
  }
  std::vector<std::uint8_t> bytes(message.size());
  ros::serialization::OStream out(bytes.data(), message.size());
  message.write(out);
  ros::serialization::IStream in(bytes.data(), message.size());
  OperatingState state;
  try {
    ros::serialization::deserialize(in, state.header);
    ros::serialization::deserialize(in, state.state);
  } catch (const ros::serialization::StreamOverrunException&) {
    refuse(tool_.input.state, ErrorCode::kSizeMismatch, "the message ends before its fields");
  }
  return state.state == "ENABLED";
}

}  // namespace tissue_ros
