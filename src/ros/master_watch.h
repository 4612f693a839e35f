#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace tissue_ros {

/// Looks every second whether the master is still the one that it was. A node that lives on after a
/// restart of roscore is known to nobody.
class MasterWatch {
 public:
  /// `lost` is called once, in a thread of its own.
  explicit MasterWatch(std::function<void()> lost);
  ~MasterWatch();
  MasterWatch(const MasterWatch&) = delete;
  MasterWatch& operator=(const MasterWatch&) = delete;

 private:
  void watch();

  std::function<void()> lost_;
  std::mutex mutex_;
  std::condition_variable ends_;
  bool is_over_ = false;
  std::thread thread_;
};

}  // namespace tissue_ros
