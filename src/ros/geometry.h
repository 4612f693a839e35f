#pragma once

#include "tissue/base/types.h"

#include <Eigen/Geometry>
#include <geometry_msgs/Point.h>
#include <geometry_msgs/Quaternion.h>
#include <geometry_msgs/Vector3.h>

namespace tissue_ros {

/// A place [m] or a vector as geometry_msgs has it.
template <class Message>
Message xyz_message(const tissue::Vec3& from) {
  Message message;
  message.x = from.x();
  message.y = from.y();
  message.z = from.z();
  return message;
}

inline geometry_msgs::Point point_message(const tissue::Vec3& place) {
  return xyz_message<geometry_msgs::Point>(place);
}
inline geometry_msgs::Vector3 vector_message(const tissue::Vec3& vector) {
  return xyz_message<geometry_msgs::Vector3>(vector);
}
inline geometry_msgs::Quaternion quaternion_message(const Eigen::Quaterniond& from) {
  geometry_msgs::Quaternion message;
  message.x = from.x();
  message.y = from.y();
  message.z = from.z();
  message.w = from.w();
  return message;
}

}  // namespace tissue_ros
