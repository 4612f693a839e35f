#include "ros/master_watch.h"

#include <ros/console.h>
#include <ros/master.h>
#include <ros/this_node.h>

#include <optional>
#include <utility>

namespace tissue_ros {
namespace {

// Its process, which a new master does not share.
std::optional<int> master_process() {
  XmlRpc::XmlRpcValue request, response, payload;
  request[0] = ros::this_node::getName();
  if (!ros::master::execute("getPid", request, response, payload, false)) return std::nullopt;
  return payload.getType() == XmlRpc::XmlRpcValue::TypeInt ? static_cast<int>(payload) : 0;
}

}  // namespace

MasterWatch::MasterWatch(std::function<void()> lost)
    : lost_(std::move(lost)), thread_([this] { watch(); }) {}

MasterWatch::~MasterWatch() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_over_ = true;
  }
  ends_.notify_one();
  thread_.join();
}

void MasterWatch::watch() {
  // One that is busy may leave a question or two unanswered.
  constexpr int kPatience = 3;
  std::optional<int> master;
  int unanswered = 0;
  std::unique_lock<std::mutex> lock(mutex_);
  while (!ends_.wait_for(lock, std::chrono::seconds(1), [this] { return is_over_; })) {
    const std::optional<int> now = master_process();
    unanswered = now ? 0 : unanswered + 1;
    if (unanswered < kPatience && (!now || !master || *now == *master)) {
      if (now) master = now;
      continue;
    }
    ROS_FATAL("%s: the master at %s is gone or is another one", ros::this_node::getName().c_str(),
              ros::master::getURI().c_str());
    lost_();
    return;
  }
}

}  // namespace tissue_ros
