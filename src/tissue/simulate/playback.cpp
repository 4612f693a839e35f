#include "tissue/simulate/playback.h"

#include "tissue/base/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tissue {
namespace {

constexpr double kNanoseconds = 1e9;
// A tool is waited for so long [ns of stamps].
constexpr std::int64_t kPatience = 1000000000;
// Tissue that has not come to rest by then is left as it is [ns].
constexpr std::int64_t kLongestRelaxation = 10 * kPatience;
constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();

std::int64_t nanoseconds(const char* name, double seconds) {
  if (!(seconds > 0.0 && seconds <= 1e6)) {
    throw InputError(ErrorCode::kParam,
                     std::string(name) + ": " + to_text(seconds) + " s is not between 0 and 1e6");
  }
  return std::max<std::int64_t>(std::llround(seconds * kNanoseconds), 1);
}

double seconds(std::int64_t nanoseconds) { return static_cast<double>(nanoseconds) / kNanoseconds; }

}  // namespace

Playback::Playback(Scene& scene, const PlaybackOptions& options, OnCloud on_cloud)
    : scene_(scene),
      options_(options),
      on_cloud_(std::move(on_cloud)),
      timeout_(nanoseconds("tool_timeout", options.tool_timeout)),
      cloud_gap_(nanoseconds("cloud_rate", 1.0 / options.cloud_rate)),
      waiting_(scene.description().tools.size()),
      newest_(waiting_.size(), Time(0, kNever)),
      newest_of_all_(0, kNever),
      used_(waiting_.size(), kNever),
      tools_(waiting_.size()) {}

void Playback::add(const ToolSample& sample) {
  if (sample.tool >= waiting_.size()) {
    throw InputError(ErrorCode::kParam, "tool " + std::to_string(sample.tool) + " is none of the " +
                                            std::to_string(waiting_.size()) + " of the scene");
  }
  Time& newest = newest_[sample.tool];
  if (sample.stamp < newest.second) ++newest.first;
  newest.second = sample.stamp;
  newest_of_all_ = std::max(newest_of_all_, newest);
  waiting_[sample.tool].push_back({newest, sample.pose});
  while (const std::optional<Time> next = next_time()) {
    for (std::size_t tool = 0; tool < waiting_.size(); ++tool) {
      if (may_come(tool, *next)) return;
    }
    use(*next);
  }
}

void Playback::finish() {
  while (const std::optional<Time> next = next_time()) use(*next);
}

std::optional<Playback::Time> Playback::next_time() const {
  std::optional<Time> first;
  for (const std::deque<Waiting>& samples : waiting_) {
    if (!samples.empty() && (!first || samples.front().time < *first)) first = samples.front().time;
  }
  return first;
}

// Whether a pose of that time, or an earlier one, of a tool of which none waits is to be waited
// for.
bool Playback::may_come(std::size_t tool, const Time& time) const {
  if (!waiting_[tool].empty() || newest_[tool] >= time) return false;
  return newest_of_all_.first == time.first && newest_of_all_.second - time.second < kPatience;
}

void Playback::use(const Time& time) {
  const auto [epoch, stamp] = time;
  if (!is_started_) {
    is_started_ = true;
    now_ = next_cloud_ = stamp;
  } else if (epoch != epoch_) {
    start_again(stamp);
  } else {
    pass_silence(stamp);
  }
  epoch_ = epoch;
  // What is nowhere has no way behind it.
  const std::int64_t gap = stamp - now_;
  const double dt = seconds(has_a_tool() ? gap : std::min(gap, cloud_gap_));
  const ToolPoses before = tools_;
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    std::deque<Waiting>& samples = waiting_[tool];
    if (samples.empty() || samples.front().time != time) continue;
    tools_[tool] = samples.front().pose;
    used_[tool] = stamp;
    samples.pop_front();
  }
  try {
    step(stamp, dt);
  } catch (const InputError&) {
    tools_ = before;
    throw;
  }
}

void Playback::start_again(std::int64_t stamp) {
  ++time_jumps_;
  now_ = next_cloud_ = stamp;
  used_.assign(used_.size(), stamp);
  if (!options_.reset_on_time_jump) return;
  tools_.assign(tools_.size(), std::nullopt);
  scene_.reset();
  last_step_ = scene_.step(tools_, 0.0);
}

// Tools that have no pose for too long are lost when that is over, and tissue relaxes.
void Playback::pass_silence(std::int64_t until) {
  for (;;) {
    std::int64_t lost_at = until;
    for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
      if (tools_[tool]) lost_at = std::min(lost_at, used_[tool] + timeout_);
    }
    if (lost_at >= until) break;
    for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
      if (used_[tool] + timeout_ <= lost_at) tools_[tool].reset();
    }
    step(lost_at, seconds(lost_at - now_));
  }
  if (has_a_tool()) return;
  const std::int64_t end = std::min(until, now_ + kLongestRelaxation);
  while (scene_.recovering() && now_ + cloud_gap_ < end) {
    step(now_ + cloud_gap_, seconds(cloud_gap_));
  }
}

void Playback::step(std::int64_t stamp, double dt) {
  last_step_ = scene_.step(tools_, dt);
  ++steps_;
  now_ = stamp;
  if (stamp < next_cloud_) return;
  next_cloud_ = stamp + cloud_gap_;
  if (on_cloud_) on_cloud_(stamp);
}

bool Playback::has_a_tool() const {
  return std::any_of(tools_.begin(), tools_.end(), [](const auto& tool) { return bool(tool); });
}

}  // namespace tissue
