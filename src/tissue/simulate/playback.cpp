#include "tissue/simulate/playback.h"

#include "tissue/base/error.h"

#include <algorithm>
#include <chrono>
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

double within(const char* name, double value) {
  if (value > 0.0 && value <= 1e6) return value;
  throw InputError(ErrorCode::kParam,
                   std::string(name) + ": " + to_text(value) + " is not between 0 and 1e6");
}

std::int64_t nanoseconds(double seconds) {
  return std::max<std::int64_t>(std::llround(seconds * kNanoseconds), 1);
}

double seconds(std::int64_t nanoseconds) { return static_cast<double>(nanoseconds) / kNanoseconds; }

}  // namespace

Playback::Playback(Scene& scene, const PlaybackOptions& options, OnCloud on_cloud, OnStep on_step)
    : scene_(scene),
      options_(options),
      on_cloud_(std::move(on_cloud)),
      on_step_(std::move(on_step)),
      timeout_(nanoseconds(within("tool_timeout", options.tool_timeout))),
      cloud_gap_(nanoseconds(1.0 / within("cloud_rate", options.cloud_rate))),
      newest_of_all_(0, kNever),
      used_(scene.description().tools.size(), kNever),
      closed_(used_.size()),
      tools_(used_.size()) {
  const std::vector<ToolDescription>& tools = scene.description().tools;
  streams_.assign(tools.size(), {{}, {0, kNever}, true});
  for (const ToolDescription& tool : tools) {
    streams_.push_back({{}, {0, kNever}, tool.input.has_grip()});
  }
}

void Playback::add(const ToolSample& sample) {
  if (sample.tool >= tools_.size()) {
    throw InputError(ErrorCode::kParam, "tool " + std::to_string(sample.tool) + " is none of the " +
                                            std::to_string(tools_.size()) + " of the scene");
  }
  Stream& stream = streams_[sample.pose ? sample.tool : tools_.size() + sample.tool];
  if (sample.stamp < stream.newest.second) ++stream.newest.first;
  stream.newest.second = sample.stamp;
  newest_of_all_ = std::max(newest_of_all_, stream.newest);
  stream.waiting.push_back({stream.newest, sample.pose, sample.closed});
  while (const std::optional<Time> next = next_time()) {
    for (const Stream& other : streams_) {
      if (may_come(other, *next)) return;
    }
    use(*next);
  }
}

void Playback::finish() {
  while (const std::optional<Time> next = next_time()) use(*next);
}

std::optional<Playback::Time> Playback::next_time() const {
  std::optional<Time> first;
  for (const Stream& stream : streams_) {
    if (stream.waiting.empty()) continue;
    const Time& time = stream.waiting.front().time;
    if (!first || time < *first) first = time;
  }
  return first;
}

// Whether something of that time, or earlier, is to be waited for.
bool Playback::may_come(const Stream& stream, const Time& time) const {
  if (!stream.is_there || !stream.waiting.empty() || stream.newest >= time) return false;
  return newest_of_all_.first == time.first && newest_of_all_.second - time.second < kPatience;
}

void Playback::use(const Time& time) {
  const auto [epoch, stamp] = time;
  if (!is_started_) {
    is_started_ = true;
    now_ = next_cloud_ = stamp;
  } else if (epoch != epoch_) {
    start_again(stamp);
  }
  epoch_ = epoch;
  ToolPoses poses(tools_.size());
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    std::deque<Waiting>& waiting = streams_[i].waiting;
    if (waiting.empty() || waiting.front().time != time) continue;
    const std::size_t tool = i % tools_.size();
    if (waiting.front().pose) poses[tool] = waiting.front().pose;
    if (waiting.front().closed) closed_[tool] = waiting.front().closed;
    waiting.pop_front();
  }
  if (!any_is_there(poses)) return;
  pass_silence(stamp);
  // What is nowhere has no way behind it.
  const std::int64_t gap = stamp - now_;
  const double dt = seconds(any_is_there(tools_) ? gap : std::min(gap, cloud_gap_));
  const ToolPoses before = tools_;
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    if (!poses[tool]) continue;
    tools_[tool] = poses[tool];
    if (closed_[tool]) tools_[tool]->closed = closed_[tool];
    used_[tool] = stamp;
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
  closed_.assign(closed_.size(), std::nullopt);
  scene_.reset();
  scene_.step(tools_, 0.0);
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
  if (any_is_there(tools_)) return;
  const std::int64_t end = std::min(until, now_ + kLongestRelaxation);
  while (scene_.recovering() && now_ + cloud_gap_ < end) {
    step(now_ + cloud_gap_, seconds(cloud_gap_));
  }
}

void Playback::step(std::int64_t stamp, double dt) {
  const auto start = std::chrono::steady_clock::now();
  const StepReport report = scene_.step(tools_, dt);
  if (on_step_) {
    on_step_(report,
             std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  ++steps_;
  now_ = stamp;
  if (stamp < next_cloud_) return;
  next_cloud_ = stamp + cloud_gap_;
  if (on_cloud_) on_cloud_(stamp);
}

}  // namespace tissue
