#include "tools/bag_run.h"

#include "ros/convert.h"
#include "ros/device_messages.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>

namespace tissue_ros {
namespace {

using tissue::ErrorCode;
using tissue::InputError;

// Bags hold names as they were at recording.
std::string global(const std::string& topic) { return topic[0] == '/' ? topic : '/' + topic; }

void open(rosbag::Bag& bag, const std::string& path, rosbag::bagmode::BagMode mode,
          ErrorCode code) {
  try {
    bag.open(path, mode);
  } catch (const rosbag::BagException& exception) {
    throw InputError(code, "bag: '" + path + "': " + exception.what());
  }
}

// One of a tool's topics.
struct Topic {
  std::size_t tool;
  bool is_pose;
};

}  // namespace

tissue::RunRecord run_bag(tissue::Scene& scene, const tissue::TetMesh& mesh,
                          const BagRunOptions& options,
                          const std::function<void(double)>& after_part) {
  rosbag::Bag bag, clouds;
  open(bag, options.bag, rosbag::bagmode::Read, ErrorCode::kFile);
  if (!options.cloud_bag.empty()) {
    open(clouds, options.cloud_bag, rosbag::bagmode::Write, ErrorCode::kIo);
  }
  std::vector<DeviceReader> readers;
  std::map<std::string, Topic> topics;
  for (const tissue::ToolDescription& tool : scene.description().tools) {
    const std::size_t number = readers.size();
    topics[global(tool.pose_topic())] = {number, true};
    if (!tool.input.jaw.empty()) topics[global(tool.input.jaw)] = {number, false};
    if (!tool.input.button.empty()) topics[global(tool.input.button)] = {number, false};
    readers.emplace_back(tool, number, mesh.frame_id, nullptr);
  }
  tissue::RunRecord record;
  const std::vector<std::uint8_t> levels = vertex_levels(mesh);
  tissue::PlaybackOptions playing;
  playing.cloud_rate = options.cloud_rate;
  tissue::Playback playback(
      scene, playing,
      [&](std::int64_t stamp) {
        if (options.cloud_bag.empty()) return;
        sensor_msgs::PointCloud2 cloud = cloud_message(scene.body(), scene.state(), levels);
        cloud.header.frame_id = mesh.frame_id;
        cloud.header.stamp.fromNSec(static_cast<std::uint64_t>(stamp));
        clouds.write("/deformed_cloud", cloud.header.stamp, cloud);
      },
      [&](const tissue::StepReport& step, double seconds) { record.add(step, seconds); });
  // Tissue takes its weight before any tool comes.
  scene.step(tissue::ToolPoses(readers.size()), 0.0);
  try {
    rosbag::View view(bag);
    const double count = view.size();
    double done = 0.0;
    for (const rosbag::MessageInstance& message : view) {
      if (after_part) after_part(++done / count);
      const auto topic = topics.find(global(message.getTopic()));
      if (topic == topics.end()) continue;
      const auto any = message.instantiate<AnyMessage>();
      const DeviceReader& reader = readers[topic->second.tool];
      if (topic->second.is_pose) {
        playback.add(reader.pose(*any));
      } else if (const auto grip = reader.grip(*any)) {
        playback.add(*grip);
      }
    }
    playback.finish();
    clouds.close();
  } catch (const rosbag::BagException& exception) {
    throw InputError(ErrorCode::kFile, "bag: '" + options.bag + "': " + exception.what());
  }
  if (record.seconds.empty()) {
    std::string wanted;
    for (const auto& [name, topic] : topics) wanted += " " + name;
    throw InputError(ErrorCode::kFile,
                     "bag: '" + options.bag + "' has no pose of any tool on" + wanted);
  }
  return record;
}

}  // namespace tissue_ros
