#include "ros/tool_listener.h"

#include "ros/geometry.h"
#include "ros/guarded.h"

#include <geometry_msgs/WrenchStamped.h>
#include <ros/console.h>

#include <algorithm>

namespace tissue_ros {

ToolListener::ToolListener(const ros::NodeHandle& handle, const tissue::SceneDescription& scene,
                           const ToolListenerOptions& options, const tf2_ros::Buffer& transforms)
    : scene_(scene),
      options_(options),
      transforms_(transforms),
      feels_(scene.has("force_feedback") && !options.deterministic),
      meters_(scene.tools.size()),
      heard_(scene.tools.size()),
      loops_(scene.tools.size(), tissue::ForceLoop(options.force)),
      handle_(handle),
      spinner_(1, &queue_) {
  handle_.setCallbackQueue(&queue_);
  for (std::size_t i = 0; feels_ && i < heard_.size(); ++i) {
    heard_[i].force =
        handle_.advertise<geometry_msgs::WrenchStamped>(scene_.tools[i].name + "/servo_cf", 1);
  }
  if (!options.deterministic) {
    listen_to_all();
    timer_ = handle_.createWallTimer(ros::WallDuration(0.2 * options.tool_timeout),
                                     [this](const ros::WallTimerEvent&) { watch(); });
  }
  spinner_.start();
}

ToolListener::~ToolListener() {
  spinner_.stop();
  for (std::size_t i = 0; i < heard_.size(); ++i) lose(i);
}

void ToolListener::set_worker(std::shared_ptr<SceneWorker> worker, const std::string& frame) {
  auto next = std::make_shared<Target>();
  next->worker = std::move(worker);
  next->frame = frame;
  for (const tissue::ToolDescription& tool : scene_.tools) {
    next->readers.emplace_back(tool, next->readers.size(), frame, &transforms_);
  }
  {
    const std::lock_guard<std::mutex> lock(target_mutex_);
    target_ = std::move(next);
  }
  // Of a replay nothing is lost before there is a mesh.
  if (subscribers_.empty()) listen_to_all();
}

std::shared_ptr<const ToolListener::Target> ToolListener::target() const {
  const std::lock_guard<std::mutex> lock(target_mutex_);
  return target_;
}

void ToolListener::listen_to_all() {
  for (std::size_t i = 0; i < scene_.tools.size(); ++i) {
    const tissue::ToolInput& input = scene_.tools[i].input;
    listen(scene_.tools[i].pose_topic(), i, &ToolListener::take_pose);
    if (!input.jaw.empty()) listen(input.jaw, i, &ToolListener::take_grip);
    if (!input.button.empty()) listen(input.button, i, &ToolListener::take_grip);
    if (!input.state.empty()) listen(input.state, i, &ToolListener::take_state);
  }
}

void ToolListener::listen(const std::string& topic, std::size_t tool,
                          void (ToolListener::*take)(const Target&, std::size_t, const Event&)) {
  // A live tool's newest pose wins; of a replay each is used.
  constexpr std::uint32_t kAll = 100000;
  ros::SubscribeOptions options;
  options.initByFullCallbackType<const Event&>(
      topic, options_.deterministic ? kAll : 1, [this, tool, take](const Event& event) {
        const std::shared_ptr<const Target> target = this->target();
        if (!target) {
          ROS_WARN_ONCE("deformer_node: no mesh yet, poses are ignored");
          return;
        }
        const Outcome outcome = guarded([&] { (this->*take)(*target, tool, event); });
        if (!outcome.ok()) drop(outcome.sentence);
      });
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  subscribers_.push_back(handle_.subscribe(options));
}

void ToolListener::take_pose(const Target& target, std::size_t tool, const Event& event) {
  const tissue::ToolSample sample = target.readers[tool].pose(*event.getConstMessage());
  Heard& heard = heard_[tool];
  if (!options_.deterministic) {
    if (!heard.is_enabled) return;
    if (!heard.is_there) heard.owner = event.getPublisherName();
    if (event.getPublisherName() != heard.owner) {
      drop(scene_.tools[tool].pose_topic() + ": " + event.getPublisherName() +
           " is not heard while " + heard.owner + " moves the tool");
      return;
    }
  }
  // The hand first: the step that this begins competes with whoever sends the answer.
  if (feels_) answer(target, sample);
  put(target, sample);
  heard.is_there = true;
  heard.when = ros::WallTime::now();
  heard.stamp = sample.stamp;
  meters_[tool].add(ros::Time::now().toSec() - event.getReceiptTime().toSec());
}

void ToolListener::take_grip(const Target& target, std::size_t tool, const Event& event) {
  if (const auto sample = target.readers[tool].grip(*event.getConstMessage())) put(target, *sample);
}

void ToolListener::take_state(const Target& target, std::size_t tool, const Event& event) {
  heard_[tool].is_enabled = target.readers[tool].is_enabled(*event.getConstMessage());
}

void ToolListener::put(const Target& target, const tissue::ToolSample& sample) {
  if (target.worker->put(sample)) return;
  ++dropped_;
  ROS_ERROR_THROTTLE(1.0, "deformer_node: the replay is so far behind that poses are lost");
}

void ToolListener::answer(const Target& target, const tissue::ToolSample& sample) {
  constexpr double kLongest = 0.1;
  Heard& heard = heard_[sample.tool];
  tissue::ForceLoop& loop = loops_[sample.tool];
  const auto progress = target.worker->progress();
  if (progress != heard.felt) {
    loop.set_tissue(progress->tissue[sample.tool]);
    heard.felt = progress;
  }
  if (target.worker->is_paused()) loop.stop();
  const double dt = 1e-9 * static_cast<double>(sample.stamp - heard.stamp);
  const tissue::Vec3 force =
      loop.force_at(sample.pose->position, heard.is_there ? std::clamp(dt, 0.0, kLongest) : 0.0);
  publish_force(sample.tool, target.frame, sample.stamp, force);
}

void ToolListener::publish_force(std::size_t tool, const std::string& frame, std::int64_t stamp,
                                 const tissue::Vec3& force) const {
  geometry_msgs::WrenchStamped message;
  message.header.frame_id = frame;
  message.header.stamp.fromNSec(static_cast<std::uint64_t>(stamp));
  message.wrench.force = vector_message(force);
  heard_[tool].force.publish(message);
}

void ToolListener::watch() {
  for (std::size_t i = 0; i < heard_.size(); ++i) {
    if (heard_[i].is_there &&
        (ros::WallTime::now() - heard_[i].when).toSec() > options_.tool_timeout) {
      lose(i);
    }
  }
}

void ToolListener::lose(std::size_t tool) {
  const std::shared_ptr<const Target> target = this->target();
  if (!heard_[tool].is_there || !target) return;
  heard_[tool].is_there = false;
  if (!options_.deterministic) target->worker->lose(tool);
  if (!feels_) return;
  loops_[tool].stop();
  publish_force(tool, target->frame, heard_[tool].stamp, tissue::Vec3::Zero());
}

void ToolListener::drop(const std::string& why) {
  ++dropped_;
  ROS_WARN_THROTTLE(1.0, "deformer_node: pose dropped: %s", why.c_str());
}

}  // namespace tissue_ros
