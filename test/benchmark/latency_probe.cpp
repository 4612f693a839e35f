// How late forces and clouds are: moves a tool at the rate of a haptic device and hears what comes
// back. As a nodelet in the deformer's manager it hears pointers, standing alone it hears TCP.
//
// Beside it an idle twin does nothing but sleep for as long as the tool does between poses; where
// it wakes too late the machine itself stood still.
#include "tissue/simulate/pose_path.h"

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <sensor_msgs/PointCloud2.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <mutex>
#include <thread>

namespace tissue_benchmark {

using Clock = std::chrono::steady_clock;

/// [s], in the order in which they came.
class Delays {
 public:
  void add(double delay) {
    const std::lock_guard<std::mutex> lock(mutex_);
    delays_.push_back(delay);
    at_.push_back(Clock::now());
  }
  std::size_t count() const { return delays_.size(); }
  double part(double share) const {
    if (delays_.empty()) return 0.0;
    std::vector<double> sorted = delays_;
    std::sort(sorted.begin(), sorted.end());
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
  }
  /// When those came that were longer.
  std::vector<Clock::time_point> longer_than(double delay) const {
    std::vector<Clock::time_point> times;
    for (std::size_t i = 0; i < delays_.size(); ++i) {
      if (delays_[i] > delay) times.push_back(at_[i]);
    }
    return times;
  }

 private:
  std::mutex mutex_;
  std::vector<double> delays_;
  std::vector<Clock::time_point> at_;
};

class LatencyProbe : public nodelet::Nodelet {
 public:
  ~LatencyProbe() override {
    is_over_ = true;
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  void onInit() override {
    ros::NodeHandle handle = getNodeHandle(), own = getPrivateNodeHandle();
    handle.setCallbackQueue(&queue_);
    own.param("rate", rate_, 1000.0);
    own.param("seconds", seconds_, 60.0);
    own.param<std::string>("name", name_, "latency");
    own.param<std::string>("csv", csv_, "");
    std::string tool, path;
    own.param<std::string>("tool", tool, "stylus");
    own.param<std::string>("path", path, "");
    path_ = tissue::read_poses(path);
    poses_ = handle.advertise<geometry_msgs::PoseStamped>(tool + "/measured_cp", 1);
    const ros::TransportHints at_once = ros::TransportHints().tcpNoDelay();
    forces_ = handle.subscribe<geometry_msgs::WrenchStamped>(
        tool + "/servo_cf", 10,
        [this](const geometry_msgs::WrenchStamped::ConstPtr& force) {
          if (is_counting_) force_delays_.add((ros::Time::now() - force->header.stamp).toSec());
          pushes_ = pushes_ || force->wrench.force.z != 0.0;
        },
        {}, at_once);
    cloud_handle_ = getNodeHandle();
    cloud_handle_.setCallbackQueue(&cloud_queue_);
    clouds_ = cloud_handle_.subscribe<sensor_msgs::PointCloud2>(
        "deformed_cloud", 2, [this](const sensor_msgs::PointCloud2::ConstPtr& cloud) {
          const double delay = (ros::Time::now() - cloud->header.stamp).toSec();
          has_cloud_ = true;
          keeps_pace_ = pushes_ && delay < kPace;
          vertices_ = cloud->width;
          if (is_counting_) cloud_delays_.add(delay);
        });
    spinner_.start();
    cloud_spinner_.start();
    threads_.emplace_back([this] { run(); });
  }

  /// `work` at this rate, told how late it is [s], until it says that it is enough.
  template <class Work>
  void every(const Work& work) {
    const auto period =
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / rate_));
    for (Clock::time_point next = Clock::now() + period;; next += period) {
      std::this_thread::sleep_until(next);
      const Clock::time_point now = Clock::now();
      if (is_over_ || !ros::ok() || !work(std::chrono::duration<double>(now - next).count()))
        return;
      // What was slept through is not made up for.
      next = std::max(next, now - period);
    }
  }

  void run() {
    const double duration = path_.back().time - path_.front().time;
    std::size_t poses = 0;
    const auto begin = Clock::now();
    const auto move = [&] {
      const double gone = std::chrono::duration<double>(Clock::now() - begin).count();
      const tissue::ToolPose pose =
          tissue::pose_at(path_, path_.front().time + std::fmod(gone, duration));
      auto message = boost::make_shared<geometry_msgs::PoseStamped>();
      message->header.frame_id = "patient";
      message->pose.position.x = pose.position.x();
      message->pose.position.y = pose.position.y();
      message->pose.position.z = pose.position.z();
      message->pose.orientation.w = 1.0;
      message->header.stamp = ros::Time::now();
      poses_.publish(message);
      ++poses;
    };
    // Until tissue has been touched, which factorises it, and steps have made up for that or never
    // will.
    constexpr double kPatience = 60.0;
    every([&](double) {
      if (has_cloud_) move();
      return !keeps_pace_ &&
             !(pushes_ && std::chrono::duration<double>(Clock::now() - begin).count() > kPatience);
    });
    threads_.emplace_back([this] {
      every([this](double late) {
        if (is_counting_) twin_delays_.add(late);
        return !is_done_;
      });
    });
    poses = 0;
    is_counting_ = true;
    const auto start = Clock::now();
    every([&](double) {
      move();
      return std::chrono::duration<double>(Clock::now() - start).count() < seconds_;
    });
    is_counting_ = false;
    is_done_ = true;
    report(poses);
    getPrivateNodeHandle().setParam("done", true);
  }

  // Replies that are late, while the twin was too: the machine itself stood still.
  std::size_t late_with_twin(double limit) const {
    const auto stalls = twin_delays_.longer_than(0.5 * limit);
    std::size_t count = 0;
    for (const Clock::time_point& late : force_delays_.longer_than(limit)) {
      count += std::any_of(stalls.begin(), stalls.end(), [&](const Clock::time_point& stall) {
        return std::abs(std::chrono::duration<double>(late - stall).count()) < 0.02;
      });
    }
    return count;
  }

  void report(std::size_t poses) const {
    constexpr double kLate = 0.005;
    const auto print = [](const char* what, const Delays& delays) {
      std::printf("  %-34s %8zu  %8.3f  %8.3f  %8.3f  %8.3f\n", what, delays.count(),
                  1e3 * delays.part(0.5), 1e3 * delays.part(0.95), 1e3 * delays.part(0.99),
                  1e3 * delays.part(1.0));
    };
    std::printf("%s: %zu poses in %.0f s, clouds of %u vertices; [ms]\n", name_.c_str(), poses,
                seconds_, vertices_.load());
    std::printf("  %-34s %8s  %8s  %8s  %8s  %8s\n", "", "count", "p50", "p95", "p99", "longest");
    print("pose to force", force_delays_);
    print("pose to the cloud that shows it", cloud_delays_);
    print("idle twin wakes too late by", twin_delays_);
    std::printf("  %zu replies older than %.0f ms, %zu of them while the idle twin stalled\n",
                force_delays_.longer_than(kLate).size(), 1e3 * kLate, late_with_twin(kLate));
    std::fflush(stdout);
    if (csv_.empty()) return;
    std::ofstream csv(csv_, std::ios::app);
    const auto row = [&](const char* what, const Delays& delays) {
      csv << name_ << ',' << what << ',' << vertices_ << ',' << delays.count();
      for (const double share : {0.5, 0.95, 0.99, 1.0}) csv << ',' << 1e3 * delays.part(share);
      csv << '\n';
    };
    row("pose_to_force", force_delays_);
    row("pose_to_cloud", cloud_delays_);
    row("idle_twin", twin_delays_);
  }

  // Clouds that are not older [s] keep pace with poses.
  static constexpr double kPace = 0.05;

  double rate_ = 0.0, seconds_ = 0.0;
  std::string name_, csv_;
  std::vector<tissue::StampedPose> path_;
  std::atomic<bool> is_over_{false}, is_done_{false}, is_counting_{false}, has_cloud_{false},
      pushes_{false}, keeps_pace_{false};
  std::atomic<std::uint32_t> vertices_{0};
  Delays force_delays_, cloud_delays_, twin_delays_;
  ros::CallbackQueue queue_, cloud_queue_;
  ros::NodeHandle cloud_handle_;
  ros::Publisher poses_;
  ros::Subscriber forces_, clouds_;
  ros::AsyncSpinner spinner_{1, &queue_}, cloud_spinner_{1, &cloud_queue_};
  std::vector<std::thread> threads_;
};

}  // namespace tissue_benchmark

PLUGINLIB_EXPORT_CLASS(tissue_benchmark::LatencyProbe, nodelet::Nodelet)
