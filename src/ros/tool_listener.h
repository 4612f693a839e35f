#pragma once

#include "ros/device_messages.h"
#include "ros/scene_worker.h"

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <atomic>

namespace tissue_ros {

struct ToolListenerOptions {
  bool deterministic = false;
  /// A tool that is silent for longer is lost [s].
  double tool_timeout = 0.1;
  tissue::ForceLoopOptions force;
};

/// Hears what a scene's tools say, in a thread of its own: hands it to the worker, and answers each
/// pose at once with the force that the tissue has there as far as the last step knows
/// (`<tool>/servo_cf`, where the scene names force_feedback). A tool that falls silent is lost and
/// feels nothing. Where two drivers move one tool, the first has it until it falls silent.
class ToolListener {
 public:
  /// `transforms` must outlive this.
  ToolListener(const ros::NodeHandle& handle, const tissue::SceneDescription& scene,
               const ToolListenerOptions& options, const tf2_ros::Buffer& transforms);
  /// Tools feel nothing any more.
  ~ToolListener();
  ToolListener(const ToolListener&) = delete;
  ToolListener& operator=(const ToolListener&) = delete;

  /// Poses go there from now on, in the frame of its mesh.
  void set_worker(std::shared_ptr<SceneWorker> worker, const std::string& frame);

  std::uint64_t dropped() const { return dropped_; }
  /// Of a tool's poses, from when they were received until their force is sent [s].
  Meter& meter(std::size_t tool) { return meters_[tool]; }

 private:
  // What belongs to one mesh.
  struct Target {
    std::shared_ptr<SceneWorker> worker;
    std::vector<DeviceReader> readers;
    std::string frame;
  };
  // What is known of one tool, in the listener's thread.
  struct Heard {
    // Who moves it; others are refused until it falls silent.
    std::string owner;
    bool is_there = false, is_enabled = true;
    ros::WallTime when;
    std::int64_t stamp = 0;
    std::shared_ptr<const SceneWorker::Progress> felt;
    ros::Publisher force;
  };

  using Event = ros::MessageEvent<AnyMessage const>;

  void listen_to_all();
  void listen(const std::string& topic, std::size_t tool,
              void (ToolListener::*take)(const Target&, std::size_t, const Event&));
  void take_pose(const Target& target, std::size_t tool, const Event& event);
  void take_grip(const Target& target, std::size_t tool, const Event& event);
  void take_state(const Target& target, std::size_t tool, const Event& event);
  void answer(const Target& target, const tissue::ToolSample& sample);
  void publish_force(std::size_t tool, const std::string& frame, std::int64_t stamp,
                     const tissue::Vec3& force) const;
  void put(const Target& target, const tissue::ToolSample& sample);
  void watch();
  void lose(std::size_t tool);
  void drop(const std::string& why);
  std::shared_ptr<const Target> target() const;

  tissue::SceneDescription scene_;
  ToolListenerOptions options_;
  const tf2_ros::Buffer& transforms_;
  bool feels_;

  mutable std::mutex target_mutex_;
  std::shared_ptr<const Target> target_;
  std::atomic<std::uint64_t> dropped_{0};

  // Before all that unsubscribes from it.
  ros::CallbackQueue queue_;
  std::vector<Meter> meters_;
  std::vector<Heard> heard_;
  std::vector<tissue::ForceLoop> loops_;
  ros::NodeHandle handle_;
  std::vector<ros::Subscriber> subscribers_;
  ros::WallTimer timer_;
  ros::AsyncSpinner spinner_;
};

}  // namespace tissue_ros
