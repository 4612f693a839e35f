#pragma once

#include "ros/parameters.h"
#include "tissue/field/volume.h"

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <optional>

namespace tissue_ros {

/// What volume_node publishes.
struct PreparedVolume {
  tissue::Volume volume;
  std::optional<tissue::Volume> mask;
};

/// Reads and edits as the parameters say: mask, its opening and smoothing, then crop, then
/// tumour. Throws tissue::InputError.
PreparedVolume prepare_volume(const VolumeNodeParameters& parameters);

/// Publishes a volume, its mask and where the tumour was put, latched. Throws tissue::InputError,
/// E_TOO_LARGE for what no message can carry.
class VolumeNode {
 public:
  VolumeNode(ros::NodeHandle handle, const ros::NodeHandle& private_handle,
             const VolumeNodeParameters& parameters);

 private:
  ros::Publisher volume_publisher_;
  ros::Publisher mask_publisher_;
  ros::Publisher tumour_publisher_;
};

}  // namespace tissue_ros
