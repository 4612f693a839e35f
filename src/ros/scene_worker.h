#pragma once

#include "ros/meter.h"
#include "tissue/simulate/force_loop.h"
#include "tissue/simulate/playback.h"

#include <chrono>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>

namespace tissue_ros {

struct SceneWorkerOptions {
  /// Each sample is used, by tissue::Playback; else the newest of each tool.
  bool deterministic = false;
  tissue::PlaybackOptions playback;
};

/// A scene that steps in a thread of its own, so that nobody waits for it: what tools say is put
/// in, and what the last step left is read, at any time and from any thread.
class SceneWorker {
 public:
  /// Hears of every cloud that is due in a replay, in the worker's thread.
  using OnCloud = std::function<void(std::int64_t stamp, const tissue::Scene&)>;
  /// Hears of what went wrong, in the worker's thread.
  using OnError = std::function<void(const std::string&)>;

  /// Where everything is.
  struct View {
    tissue::State state;
    std::map<std::string, std::optional<tissue::Vec3>> probes;
    /// Of the newest pose that was used [ns]; 0 before the first.
    std::int64_t stamp = 0;
  };

  /// What the last step left but for where everything is.
  struct Progress {
    tissue::StepReport report;
    double step_seconds = 0.0;
    /// Of the newest pose that was used [ns]; 0 before the first.
    std::int64_t stamp = 0;
    tissue::ToolPoses tools;
    std::vector<tissue::EffectCost> costs;
    /// What each tool feels; nothing without force_feedback.
    std::vector<std::optional<tissue::LocalTissue>> tissue;
    std::size_t steps = 0, time_jumps = 0, not_converged = 0;
  };

  SceneWorker(tissue::Scene scene, const SceneWorkerOptions& options, OnCloud on_cloud,
              OnError on_error);
  /// Waits for the step that runs.
  ~SceneWorker();
  SceneWorker(const SceneWorker&) = delete;
  SceneWorker& operator=(const SceneWorker&) = delete;

  /// Neither changes.
  const tissue::Body& body() const { return scene_.body(); }
  const tissue::SceneDescription& description() const { return scene_.description(); }
  /// False where a replay has fallen so far behind that a sample is lost.
  bool put(const tissue::ToolSample& sample);
  /// The tool has fallen silent.
  void lose(std::size_t tool);
  /// Tissue at rest without tools. Returns when it is, after the step that runs.
  void reset();
  /// While paused nothing moves. Live, the newest of each tool is what goes on afterwards; of a
  /// replay, all that waits.
  void pause(bool paused);
  bool is_paused() const;
  /// Now, or while a step runs as it was before it.
  std::shared_ptr<const View> view();
  /// What the next step leaves, if it comes within so long; else view().
  std::shared_ptr<const View> next_view(std::chrono::microseconds patience);
  std::shared_ptr<const Progress> progress() const;
  /// Of steps [s].
  Meter& step_meter() { return step_meter_; }

 private:
  struct Inbox {
    std::deque<tissue::ToolSample> samples;
    std::vector<std::uint8_t> lost;
    bool has_lost = false, is_over = false, has_reset = false;
  };

  void run();
  Inbox next_inbox();
  void feel_nothing();
  void start_playback();
  void start_again();
  void replay(const Inbox& inbox);
  void follow(const Inbox& inbox);
  void start_again_if_behind(std::int64_t stamp);
  void step(const tissue::ToolPoses& tools, double dt);
  void tell(const tissue::StepReport& report, double seconds, const tissue::ToolPoses& tools);
  std::shared_ptr<const View> view_of_scene() const;

  SceneWorkerOptions options_;
  OnCloud on_cloud_;
  OnError on_error_;

  // While a step runs.
  std::mutex scene_mutex_;
  tissue::Scene scene_;
  std::optional<tissue::Playback> playback_;
  tissue::ToolPoses tools_;
  std::vector<std::optional<bool>> closed_;
  std::int64_t stamp_ = 0;
  std::size_t steps_ = 0, time_jumps_ = 0, not_converged_ = 0;
  Meter step_meter_;

  mutable std::mutex view_mutex_;
  std::condition_variable view_came_;
  std::shared_ptr<const Progress> progress_;
  std::shared_ptr<const View> view_;
  std::size_t steps_of_view_ = 0;
  bool view_is_wanted_ = false;

  mutable std::mutex inbox_mutex_;
  std::condition_variable arrived_, was_reset_;
  Inbox inbox_;
  bool is_paused_ = false;
  std::size_t resets_ = 0;
  std::thread thread_;
};

}  // namespace tissue_ros
