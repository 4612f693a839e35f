#pragma once

#include "tissue/simulate/scene.h"

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <utility>

namespace tissue {

/// What was heard of a tool: where it was at an instant, or that its jaw opened or closed.
struct ToolSample {
  /// Its number in the scene.
  std::size_t tool = 0;
  /// [ns]
  std::int64_t stamp = 0;
  std::optional<ToolPose> pose;
  std::optional<bool> closed = {};
};

struct PlaybackOptions {
  /// A tool without a pose for longer is lost [s].
  double tool_timeout = 0.1;
  /// Clouds per second of stamps.
  double cloud_rate = 30.0;
  /// Where stamps fall back the tissue starts again from rest; without it, it goes on as it is.
  bool reset_on_time_jump = true;
};

/// Moves a scene through recorded poses, and nothing but the poses and their stamps decides what
/// happens: neither when they arrive, nor in which order those of different tools do, nor how long
/// a step takes.
///
/// Every pose is used once, in the order of stamps; what has one stamp is one step. A pose waits
/// until every other tool has one that is not earlier, and every jaw that the scene knows has been
/// heard of, or they have been silent for a second of stamps.
/// A gap longer than `tool_timeout` is a tool that was lost; where none is left, tissue relaxes in
/// fixed steps. A cloud is due at the first step at least 1 / `cloud_rate` after the last.
class Playback {
 public:
  /// What is called when a cloud is due, with its stamp [ns].
  using OnCloud = std::function<void(std::int64_t)>;
  /// What is called after each step, with the seconds that it took.
  using OnStep = std::function<void(const StepReport&, double)>;

  /// `scene` must outlive this. Throws InputError E_PARAM unless time-out and rate are positive.
  Playback(Scene& scene, const PlaybackOptions& options, OnCloud on_cloud, OnStep on_step = {});

  /// Takes the next sample of a tool and uses what can be used. Throws InputError E_PARAM for a
  /// tool that the scene has not, else as Scene::step does: that step's poses are then passed over.
  void add(const ToolSample& sample);
  /// Uses all that waits, as if nothing came any more.
  void finish();

  const ToolPoses& tools() const { return tools_; }
  /// How many steps there were, and how often stamps fell back.
  std::size_t steps() const { return steps_; }
  std::size_t time_jumps() const { return time_jumps_; }

 private:
  // How often stamps had fallen back, and the stamp.
  using Time = std::pair<std::size_t, std::int64_t>;
  struct Waiting {
    Time time;
    std::optional<ToolPose> pose;
    std::optional<bool> closed;
  };
  // What comes in order: poses of each tool, then jaws of each.
  struct Stream {
    std::deque<Waiting> waiting;
    Time newest;
    bool is_there;
  };

  std::optional<Time> next_time() const;
  bool may_come(const Stream& stream, const Time& time) const;
  void use(const Time& time);
  void start_again(std::int64_t stamp);
  void pass_silence(std::int64_t until);
  void step(std::int64_t stamp, double dt);

  Scene& scene_;
  PlaybackOptions options_;
  OnCloud on_cloud_;
  OnStep on_step_;
  // [ns]; the second is the step in which tissue relaxes, too.
  std::int64_t timeout_, cloud_gap_;
  std::vector<Stream> streams_;
  Time newest_of_all_;
  // Of each tool: the stamp that was used last, and whether its jaw is closed.
  std::vector<std::int64_t> used_;
  std::vector<std::optional<bool>> closed_;
  std::size_t epoch_ = 0;
  bool is_started_ = false;
  std::int64_t now_ = 0, next_cloud_ = 0;
  ToolPoses tools_;
  std::size_t steps_ = 0, time_jumps_ = 0;
};

}  // namespace tissue
