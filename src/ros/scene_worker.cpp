#include "ros/scene_worker.h"

#include "ros/guarded.h"

#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace tissue_ros {
namespace {

// More than any bag has in the time that a step may take.
constexpr std::size_t kMostWaiting = 100000;
// When a bag is over nothing comes that would push out what waits [s].
constexpr double kSilence = 1.0;
// Giving memory back takes nothing beside a step that takes so long [s].
constexpr double kLongStep = 0.5;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

SceneWorker::SceneWorker(tissue::Scene scene, const SceneWorkerOptions& options, OnCloud on_cloud,
                         OnError on_error)
    : options_(options),
      on_cloud_(std::move(on_cloud)),
      on_error_(std::move(on_error)),
      scene_(std::move(scene)),
      tools_(description().tools.size()),
      closed_(tools_.size()) {
  inbox_.lost.resize(tools_.size());
  if (options.deterministic) start_playback();
  // Tissue takes its weight before any tool comes.
  step(tools_, 0.0);
  view_ = view_of_scene();
  steps_of_view_ = steps_;
  thread_ = std::thread([this] { run(); });
}

SceneWorker::~SceneWorker() {
  {
    const std::lock_guard<std::mutex> lock(inbox_mutex_);
    inbox_.is_over = true;
  }
  arrived_.notify_one();
  thread_.join();
}

bool SceneWorker::put(const tissue::ToolSample& sample) {
  {
    const std::lock_guard<std::mutex> lock(inbox_mutex_);
    std::deque<tissue::ToolSample>& samples = inbox_.samples;
    if (!options_.deterministic) {
      // The newest of each kind wins.
      const auto old = std::find_if(samples.begin(), samples.end(), [&](const auto& one) {
        return one.tool == sample.tool && bool(one.pose) == bool(sample.pose);
      });
      if (old != samples.end()) samples.erase(old);
    }
    if (samples.size() >= kMostWaiting) return false;
    samples.push_back(sample);
  }
  arrived_.notify_one();
  return true;
}

void SceneWorker::lose(std::size_t tool) {
  {
    const std::lock_guard<std::mutex> lock(inbox_mutex_);
    // Where it was before is of no use any more.
    std::deque<tissue::ToolSample>& samples = inbox_.samples;
    samples.erase(std::remove_if(samples.begin(), samples.end(),
                                 [&](const auto& one) { return one.tool == tool && one.pose; }),
                  samples.end());
    inbox_.lost[tool] = 1;
    inbox_.has_lost = true;
  }
  arrived_.notify_one();
}

void SceneWorker::reset() {
  std::unique_lock<std::mutex> lock(inbox_mutex_);
  inbox_.has_reset = true;
  const std::size_t before = resets_;
  arrived_.notify_one();
  was_reset_.wait(lock, [&] { return resets_ != before; });
}

void SceneWorker::pause(bool paused) {
  {
    const std::lock_guard<std::mutex> lock(inbox_mutex_);
    is_paused_ = paused;
  }
  arrived_.notify_one();
}

bool SceneWorker::is_paused() const {
  const std::lock_guard<std::mutex> lock(inbox_mutex_);
  return is_paused_;
}

std::shared_ptr<const SceneWorker::View> SceneWorker::view() {
  const std::unique_lock<std::mutex> scene_lock(scene_mutex_, std::try_to_lock);
  const std::lock_guard<std::mutex> lock(view_mutex_);
  if (!scene_lock.owns_lock()) {
    // The step that runs leaves it.
    view_is_wanted_ = true;
  } else if (steps_of_view_ != steps_) {
    view_ = view_of_scene();
    steps_of_view_ = steps_;
  }
  return view_;
}

std::shared_ptr<const SceneWorker::View> SceneWorker::next_view(
    std::chrono::microseconds patience) {
  {
    std::unique_lock<std::mutex> lock(view_mutex_);
    view_is_wanted_ = true;
    if (view_came_.wait_for(lock, patience, [this] { return !view_is_wanted_; })) return view_;
  }
  return view();
}

std::shared_ptr<const SceneWorker::View> SceneWorker::view_of_scene() const {
  return std::make_shared<View>(View{scene_.state(), scene_.probes(), stamp_});
}

std::shared_ptr<const SceneWorker::Progress> SceneWorker::progress() const {
  const std::lock_guard<std::mutex> lock(view_mutex_);
  return progress_;
}

SceneWorker::Inbox SceneWorker::next_inbox() {
  std::unique_lock<std::mutex> lock(inbox_mutex_);
  const double patience = options_.deterministic ? kSilence : 1.0 / options_.playback.cloud_rate;
  const auto is_due = [this] {
    return inbox_.is_over || inbox_.has_reset ||
           (!is_paused_ && (inbox_.has_lost || !inbox_.samples.empty()));
  };
  do {
    arrived_.wait_for(lock, std::chrono::duration<double>(patience), is_due);
  } while (is_paused_ && !is_due());
  Inbox empty;
  empty.lost.resize(tools_.size());
  return std::exchange(inbox_, std::move(empty));
}

void SceneWorker::run() {
  for (;;) {
    const Inbox inbox = next_inbox();
    if (inbox.is_over) return;
    const Outcome outcome = guarded([&] {
      const std::lock_guard<std::mutex> lock(scene_mutex_);
      if (inbox.has_reset) {
        start_again();
      } else if (options_.deterministic) {
        replay(inbox);
      } else {
        follow(inbox);
      }
    });
    if (!outcome.ok()) {
      feel_nothing();
      if (on_error_) on_error_(outcome.sentence);
    }
    if (!inbox.has_reset) continue;
    const std::lock_guard<std::mutex> inbox_lock(inbox_mutex_);
    ++resets_;
    was_reset_.notify_all();
  }
}

// What steps found before one failed is no guide for a hand.
void SceneWorker::feel_nothing() {
  const std::lock_guard<std::mutex> lock(view_mutex_);
  auto progress = std::make_shared<Progress>(*progress_);
  progress->tissue.assign(progress->tissue.size(), std::nullopt);
  progress_ = std::move(progress);
}

void SceneWorker::start_playback() {
  playback_.emplace(
      scene_, options_.playback,
      [this](std::int64_t stamp) {
        stamp_ = stamp;
        if (on_cloud_) on_cloud_(stamp, scene_);
      },
      [this](const tissue::StepReport& report, double seconds) {
        tell(report, seconds, playback_->tools());
      });
}

void SceneWorker::start_again() {
  scene_.reset();
  tools_.assign(tools_.size(), std::nullopt);
  if (options_.deterministic) start_playback();
  step(tools_, 0.0);
}

void SceneWorker::replay(const Inbox& inbox) {
  for (const tissue::ToolSample& sample : inbox.samples) {
    const Outcome outcome = guarded([&] { playback_->add(sample); });
    if (!outcome.ok() && on_error_) on_error_(outcome.sentence);
  }
  if (inbox.samples.empty()) playback_->finish();
}

// One step to the newest pose of each tool; without any, tissue that was let go relaxes.
void SceneWorker::follow(const Inbox& inbox) {
  std::int64_t stamp = 0;
  for (const tissue::ToolSample& sample : inbox.samples) {
    if (sample.closed) closed_[sample.tool] = sample.closed;
    if (sample.pose) stamp = std::max(stamp, sample.stamp);
  }
  if (stamp != 0) start_again_if_behind(stamp);
  tissue::ToolPoses tools = tools_;
  bool loses = false;
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    if (inbox.lost[tool] == 0 || !tools[tool]) continue;
    tools[tool].reset();
    loses = true;
  }
  // The first step without a tool lets go, also where it has come back by now; the others relax.
  const bool relaxes = stamp == 0 && !any_is_there(tools) && scene_.recovering();
  if (loses || relaxes) step(tools, 1.0 / options_.playback.cloud_rate);
  if (stamp == 0) return;
  for (const tissue::ToolSample& sample : inbox.samples) {
    if (!sample.pose) continue;
    tools[sample.tool] = sample.pose;
    tools[sample.tool]->closed = closed_[sample.tool];
  }
  const double dt = any_is_there(tools_)
                        ? 1e-9 * static_cast<double>(std::max<std::int64_t>(stamp - stamp_, 0))
                        : 0.0;
  stamp_ = std::max(stamp_, stamp);
  step(tools, dt);
}

// A bag that starts again, or a clock that was set back: the tissue starts again too. Tools of
// their own clocks may be a little behind each other.
void SceneWorker::start_again_if_behind(std::int64_t stamp) {
  const double behind = 1e-9 * static_cast<double>(stamp_ - stamp);
  if (behind <= (tools_.size() > 1 ? options_.playback.tool_timeout : 0.0)) return;
  ++time_jumps_;
  stamp_ = stamp;
  if (options_.playback.reset_on_time_jump) start_again();
}

void SceneWorker::step(const tissue::ToolPoses& tools, double dt) {
  const auto start = std::chrono::steady_clock::now();
  const tissue::StepReport report = scene_.step(tools, dt);
  tools_ = tools;
  const double seconds = seconds_since(start);
  tell(report, seconds, tools);
  // A long step, such as one that factorises anew, leaves what only it needed in pieces that the
  // allocator keeps.
  if (seconds > kLongStep) malloc_trim(0);
}

void SceneWorker::tell(const tissue::StepReport& report, double seconds,
                       const tissue::ToolPoses& tools) {
  auto progress = std::make_shared<Progress>();
  progress->report = report;
  progress->step_seconds = seconds;
  progress->stamp = stamp_;
  progress->tools = tools;
  progress->costs = scene_.effect_costs();
  progress->steps = ++steps_;
  progress->not_converged = not_converged_ += report.not_converged ? 1 : 0;
  step_meter_.add(seconds);
  progress->time_jumps = playback_ ? playback_->time_jumps() : time_jumps_;
  const auto felt = scene_.tool_feedback();
  progress->tissue.resize(tools.size());
  for (std::size_t i = 0; i < felt.size(); ++i) {
    if (!felt[i] || !tools[i] || report.not_converged) continue;
    progress->tissue[i] = tissue::LocalTissue{tools[i]->position, felt[i]->wrench.force,
                                              felt[i]->compliance, description().tools[i].grasps};
  }
  const std::lock_guard<std::mutex> lock(view_mutex_);
  progress_ = std::move(progress);
  if (!view_is_wanted_) return;
  view_ = view_of_scene();
  steps_of_view_ = steps_;
  view_is_wanted_ = false;
  view_came_.notify_all();
}

}  // namespace tissue_ros
