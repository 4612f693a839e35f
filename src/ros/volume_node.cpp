#include "ros/volume_node.h"

#include "ros/convert.h"
#include "ros/markers.h"
#include "tissue/field/edit_volume.h"
#include "tissue/field/mask.h"
#include "tissue/field/read_volume.h"

#include <ros/console.h>

namespace tissue_ros {
namespace {

using tissue::ErrorCode;
using tissue::InputError;
using tissue::Vec3;

void require_numbers(const char* name, const std::vector<double>& values, std::size_t count) {
  if (values.size() == count) return;
  throw InputError(ErrorCode::kParam, std::string("~") + name + ": has " +
                                          std::to_string(values.size()) + " numbers, not " +
                                          std::to_string(count));
}

std::optional<tissue::Volume> prepare_mask(const VolumeNodeParameters& parameters,
                                           const tissue::Volume& volume) {
  std::optional<tissue::Volume> mask;
  if (!parameters.mask_file.empty()) {
    mask = tissue::threshold_mask(tissue::read_volume(parameters.mask_file), 0.0);
    if (!tissue::same_grid(mask->grid, volume.grid)) {
      throw InputError(ErrorCode::kSizeMismatch, "~mask_file: '" + parameters.mask_file +
                                                     "' does not lie on the volume's grid");
    }
  } else if (parameters.mask_by_threshold) {
    mask = tissue::threshold_mask(volume, parameters.mask_above);
  }
  if (!mask) return mask;
  if (parameters.mask_opening != 0) mask = tissue::open_mask(*mask, parameters.mask_opening);
  if (parameters.mask_smoothing != 0.0) {
    mask = tissue::smooth_mask(*mask, parameters.mask_smoothing);
  }
  mask->frame_id = parameters.frame_id;
  return mask;
}

soft_tissue_sim::Volume checked_message(const tissue::Volume& volume) {
  soft_tissue_sim::Volume message = to_message(volume);
  if (message.data.size() > kMaxMessageBytes) {
    throw InputError(ErrorCode::kTooLarge, "volume: " + std::to_string(message.data.size()) +
                                               " bytes do not fit into one message; crop it, or "
                                               "mesh the file with mesh_volume");
  }
  message.header.stamp = ros::Time::now();
  return message;
}

}  // namespace

PreparedVolume prepare_volume(const VolumeNodeParameters& parameters) {
  if (parameters.file.empty()) throw InputError(ErrorCode::kFile, "~file: no volume is named");
  PreparedVolume prepared;
  tissue::Volume& volume = prepared.volume;
  volume = tissue::read_volume(parameters.file);
  volume.frame_id = parameters.frame_id;
  if (parameters.quantity == "hounsfield") {
    volume.quantity = tissue::Quantity::kHounsfield;
  } else if (parameters.quantity == "label") {
    volume.quantity = tissue::Quantity::kLabel;
  } else if (parameters.quantity != "density") {
    throw InputError(ErrorCode::kParam, "~quantity: '" + parameters.quantity +
                                            "' is not one of density hounsfield label");
  }
  tissue::check_volume(volume);
  // The mask is the organ's, whatever is put into it, and lies on the file's grid before both are
  // cropped.
  prepared.mask = prepare_mask(parameters, volume);
  if (!parameters.crop.empty()) {
    require_numbers("crop", parameters.crop, 6);
    const double* c = parameters.crop.data();
    const tissue::Box box = {Vec3(c[0], c[1], c[2]), Vec3(c[3], c[4], c[5])};
    volume = crop_volume(volume, box);
    if (prepared.mask) prepared.mask = crop_volume(*prepared.mask, box);
  }
  if (!parameters.tumour.empty()) {
    require_numbers("tumour", parameters.tumour, 5);
    const double* t = parameters.tumour.data();
    insert_tumour(volume, {Vec3(t[0], t[1], t[2]), t[3], t[4]});
  }
  return prepared;
}

VolumeNode::VolumeNode(ros::NodeHandle handle, const ros::NodeHandle&,
                       const VolumeNodeParameters& parameters) {
  const PreparedVolume prepared = prepare_volume(parameters);
  // The mask goes first: who builds when the volume arrives has it then.
  if (prepared.mask) {
    mask_publisher_ = handle.advertise<soft_tissue_sim::Volume>("mask", 1, true);
    mask_publisher_.publish(checked_message(*prepared.mask));
  }
  if (!parameters.tumour.empty()) {
    const double* t = parameters.tumour.data();
    tumour_publisher_ = handle.advertise<visualization_msgs::Marker>("tumour_marker", 1, true);
    tumour_publisher_.publish(
        ball_marker("tumour", Vec3(t[0], t[1], t[2]), t[3], 0.4f, parameters.frame_id));
  }
  volume_publisher_ = handle.advertise<soft_tissue_sim::Volume>("volume", 1, true);
  volume_publisher_.publish(checked_message(prepared.volume));
  const auto& size = prepared.volume.grid.size;
  ROS_INFO("volume_node: %u x %u x %u voxels from %s", size[0], size[1], size[2],
           parameters.file.c_str());
}

}  // namespace tissue_ros
