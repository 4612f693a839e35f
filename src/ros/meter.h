#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <mutex>
#include <vector>

namespace tissue_ros {

/// How often something happens and how long it takes. Values may come from any thread.
class Meter {
 public:
  /// Since the reading before.
  struct Reading {
    /// [Hz]
    double rate = 0.0;
    /// Of the newest values; 0 without any.
    double median = 0.0, p99 = 0.0, largest = 0.0;
  };

  void add(double value) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (values_.size() < kMost) values_.resize(values_.size() + 1);
    values_[count_++ % kMost] = value;
  }

  Reading read() {
    std::vector<double> values;
    Reading reading;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      const Clock::time_point now = Clock::now();
      reading.rate =
          static_cast<double>(count_) / std::chrono::duration<double>(now - since_).count();
      since_ = now;
      count_ = 0;
      values.swap(values_);
    }
    if (values.empty()) return reading;
    std::sort(values.begin(), values.end());
    const auto part = [&](double share) {
      return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
    };
    reading.median = part(0.5);
    reading.p99 = part(0.99);
    reading.largest = values.back();
    return reading;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kMost = 8192;

  std::mutex mutex_;
  std::vector<double> values_;
  std::size_t count_ = 0;
  Clock::time_point since_ = Clock::now();
};

}  // namespace tissue_ros
