#pragma once

// Messages of drivers whose packages are rarely installed, as those define them: the bytes and the
// checksums are the drivers' own.

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/Vector3.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <std_msgs/Header.h>

#include <cstdint>
#include <string>
#include <vector>

namespace tissue_ros {

/// omni_msgs/OmniState. The pose is in millimetres.
struct OmniState {
  std_msgs::Header header;
  std::uint8_t locked = 0, close_gripper = 0;
  geometry_msgs::Pose pose;
  geometry_msgs::Vector3 current, velocity;

  template <class Stream, class Self>
  static void each(Stream& stream, Self& m) {
    stream.next(m.header);
    stream.next(m.locked);
    stream.next(m.close_gripper);
    stream.next(m.pose);
    stream.next(m.current);
    stream.next(m.velocity);
  }
  static constexpr const char* kType = "omni_msgs/OmniState";
  static constexpr const char* kMd5 = "89c2a741de66e9e904f59a02b171dd6e";
  static constexpr const char* kDefinition =
      "std_msgs/Header header\nbool locked\nbool close_gripper\ngeometry_msgs/Pose pose\n"
      "geometry_msgs/Vector3 current\ngeometry_msgs/Vector3 velocity\n";
};

/// omni_msgs/OmniButtonEvent
struct OmniButtonEvent {
  std::int32_t grey_button = 0, white_button = 0;

  template <class Stream, class Self>
  static void each(Stream& stream, Self& m) {
    stream.next(m.grey_button);
    stream.next(m.white_button);
  }
  static constexpr const char* kType = "omni_msgs/OmniButtonEvent";
  static constexpr const char* kMd5 = "fb77877e6b639935c3360838062f05f0";
  static constexpr const char* kDefinition = "int32 grey_button\nint32 white_button\n";
};

/// omni_msgs/OmniFeedback. The driver holds the last one for ever.
struct OmniFeedback {
  geometry_msgs::Vector3 force, position;

  template <class Stream, class Self>
  static void each(Stream& stream, Self& m) {
    stream.next(m.force);
    stream.next(m.position);
  }
  static constexpr const char* kType = "omni_msgs/OmniFeedback";
  static constexpr const char* kMd5 = "e9083ac4fd95494e94fbb0c0f90b6c00";
  static constexpr const char* kDefinition =
      "geometry_msgs/Vector3 force\ngeometry_msgs/Vector3 position\n"
      "================================================================================\n"
      "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n";
};

/// geomagic_control/DeviceFeedback of ros_geomagic. The driver reads three locks.
struct GeomagicFeedback {
  geometry_msgs::Vector3 force, position;
  std::vector<std::uint8_t> lock = {0, 0, 0};

  template <class Stream, class Self>
  static void each(Stream& stream, Self& m) {
    stream.next(m.force);
    stream.next(m.position);
    stream.next(m.lock);
  }
  static constexpr const char* kType = "geomagic_control/DeviceFeedback";
  static constexpr const char* kMd5 = "94755b031db27fe99c2c235c0da9b072";
  static constexpr const char* kDefinition =
      "geometry_msgs/Vector3 force\ngeometry_msgs/Vector3 position\nbool[] lock\n"
      "================================================================================\n"
      "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n";
};

/// ros_igtl_bridge/igtltransform: no stamp, no frame, and millimetres, as OpenIGTLink has it.
struct IgtlTransform {
  std::string name;
  geometry_msgs::Transform transform;

  template <class Stream, class Self>
  static void each(Stream& stream, Self& m) {
    stream.next(m.name);
    stream.next(m.transform);
  }
  static constexpr const char* kType = "ros_igtl_bridge/igtltransform";
  static constexpr const char* kMd5 = "5b37f5c9159d09ed0eb53ad625b51f59";
  static constexpr const char* kDefinition = "string name\ngeometry_msgs/Transform transform\n";
};

}  // namespace tissue_ros

// What roscpp asks of a message.
#define TISSUE_FOREIGN_MESSAGE(Message)                          \
  namespace ros::message_traits {                                \
  template <>                                                    \
  struct IsMessage<Message> : TrueType {};                       \
  template <>                                                    \
  struct MD5Sum<Message> {                                       \
    static const char* value() { return Message::kMd5; }         \
    static const char* value(const Message&) { return value(); } \
  };                                                             \
  template <>                                                    \
  struct DataType<Message> {                                     \
    static const char* value() { return Message::kType; }        \
    static const char* value(const Message&) { return value(); } \
  };                                                             \
  template <>                                                    \
  struct Definition<Message> {                                   \
    static const char* value() { return Message::kDefinition; }  \
    static const char* value(const Message&) { return value(); } \
  };                                                             \
  }                                                              \
  namespace ros::serialization {                                 \
  template <>                                                    \
  struct Serializer<Message> {                                   \
    template <typename Stream, typename Self>                    \
    inline static void allInOne(Stream& stream, Self m) {        \
      Message::each(stream, m);                                  \
    }                                                            \
    ROS_DECLARE_ALLINONE_SERIALIZER                              \
  };                                                             \
  }

TISSUE_FOREIGN_MESSAGE(tissue_ros::OmniState)
TISSUE_FOREIGN_MESSAGE(tissue_ros::OmniButtonEvent)
TISSUE_FOREIGN_MESSAGE(tissue_ros::OmniFeedback)
TISSUE_FOREIGN_MESSAGE(tissue_ros::GeomagicFeedback)
TISSUE_FOREIGN_MESSAGE(tissue_ros::IgtlTransform)

#undef TISSUE_FOREIGN_MESSAGE
