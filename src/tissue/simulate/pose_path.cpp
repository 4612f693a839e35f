#include "tissue/simulate/pose_path.h"

#include "tissue/base/error.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

namespace tissue {
namespace {

class Line {
 public:
  Line(const std::string& path, int number) : place_(path + ", line " + std::to_string(number)) {}

  [[noreturn]] void refuse(ErrorCode code, const std::string& what) const {
    throw InputError(code, "path: " + place_ + ": " + what);
  }

  std::vector<double> numbers(const std::string& text) const {
    std::vector<double> result;
    std::stringstream stream(text);
    std::string word;
    while (std::getline(stream, word, ',')) {
      char* end = nullptr;
      const double value = std::strtod(word.c_str(), &end);
      while (*end == ' ' || *end == '\r') ++end;
      if (word.empty() || *end != '\0') refuse(ErrorCode::kFile, "'" + word + "' is not a number");
      if (!std::isfinite(value)) refuse(ErrorCode::kNonfinite, "'" + word + "' is not finite");
      result.push_back(value);
    }
    if (result.size() != 8 && result.size() != 9) {
      refuse(ErrorCode::kFile, "has " + std::to_string(result.size()) +
                                   " numbers, not t,x,y,z,qx,qy,qz,qw and maybe grip");
    }
    return result;
  }

 private:
  std::string place_;
};

}  // namespace

std::vector<StampedPose> read_poses(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw InputError(ErrorCode::kFile, "path: '" + path + "' cannot be read");
  return parse_poses(file, path);
}

std::vector<StampedPose> parse_poses(std::istream& lines, const std::string& path) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  std::vector<StampedPose> poses;
  std::string text;
  for (int number = 1; std::getline(lines, text); ++number) {
    const Line line(path, number);
    if (text.empty() || text == "\r" || (number == 1 && is_letter(text[0]))) continue;
    const std::vector<double> v = line.numbers(text);
    const Eigen::Quaterniond turn(v[7], v[4], v[5], v[6]);
    if (!(turn.norm() > 0.9 && turn.norm() < 1.1)) {
      line.refuse(ErrorCode::kParam,
                  "a quaternion of norm " + to_text(turn.norm()) + " is no rotation");
    }
    if (!poses.empty() && v[0] < poses.back().time) {
      line.refuse(ErrorCode::kDt,
                  "time " + to_text(v[0]) + " lies before " + to_text(poses.back().time));
    }
    ToolPose pose;
    pose.position = {v[1], v[2], v[3]};
    pose.orientation = turn.normalized();
    if (v.size() == 9) pose.closed = v[8] > 0.5;
    poses.push_back({v[0], pose});
  }
  if (poses.empty()) throw InputError(ErrorCode::kFile, "path: '" + path + "' has no poses");
  return poses;
}

std::vector<std::vector<StampedPose>> read_paths(
    const SceneDescription& scene, const std::vector<std::string>& files,
    const std::function<std::string(const std::string&)>& locate) {
  std::vector<std::vector<StampedPose>> paths(scene.tools.size());
  for (const std::string& named : files) {
    const std::size_t equals = named.find('=');
    const std::string tool = equals == std::string::npos ? "" : named.substr(0, equals);
    const std::string file = equals == std::string::npos ? named : named.substr(equals + 1);
    std::size_t which = 0;
    while (!tool.empty() && which < scene.tools.size() && scene.tools[which].name != tool) ++which;
    if (which >= scene.tools.size()) {
      throw InputError(ErrorCode::kParam, "path: the scene has no tool '" + tool + "'");
    }
    if (!paths[which].empty()) {
      throw InputError(ErrorCode::kParam,
                       "path: tool " + scene.tools[which].name + " has two paths");
    }
    paths[which] = read_poses(locate ? locate(file) : file);
  }
  return paths;
}

ToolPose pose_at(const std::vector<StampedPose>& path, double time) {
  const auto after =
      std::upper_bound(path.begin(), path.end(), time,
                       [](double instant, const StampedPose& pose) { return instant < pose.time; });
  if (after == path.begin()) return path.front().pose;
  if (after == path.end()) return path.back().pose;
  const StampedPose& before = *std::prev(after);
  const double part = (time - before.time) / (after->time - before.time);
  ToolPose pose = before.pose;
  pose.position += part * (after->pose.position - before.pose.position);
  pose.orientation = before.pose.orientation.slerp(part, after->pose.orientation);
  return pose;
}

std::vector<StampedPose> line_path(const Vec3& from, const Vec3& to, double period) {
  return {{0.0, {from}}, {0.5 * period, {to}}, {period, {from}}};
}

std::vector<StampedPose> circle_path(const Vec3& centre, const Vec3& axis, double radius,
                                     double period) {
  constexpr int kParts = 360;
  if (!(axis.norm() > 0.0)) throw InputError(ErrorCode::kParam, "axis: has no length");
  const Vec3 across = radius * axis.unitOrthogonal(), along = axis.normalized().cross(across);
  std::vector<StampedPose> path;
  for (int i = 0; i <= kParts; ++i) {
    const double angle = 2.0 * M_PI * i / kParts;
    path.push_back(
        {period * i / kParts, {centre + std::cos(angle) * across + std::sin(angle) * along}});
  }
  return path;
}

std::vector<Instant> merged(const std::vector<std::vector<StampedPose>>& paths) {
  std::set<double> times;
  for (const auto& path : paths) {
    for (const StampedPose& pose : path) times.insert(pose.time);
  }
  std::vector<std::size_t> next(paths.size(), 0);
  std::vector<Instant> instants;
  for (const double time : times) {
    Instant instant = {time, ToolPoses(paths.size())};
    for (std::size_t i = 0; i < paths.size(); ++i) {
      while (next[i] < paths[i].size() && paths[i][next[i]].time <= time) ++next[i];
      const bool is_over = !paths[i].empty() && paths[i].back().time < time;
      if (next[i] > 0 && !is_over) instant.tools[i] = paths[i][next[i] - 1].pose;
    }
    instants.push_back(instant);
  }
  return instants;
}

std::vector<Instant> instants_of(const SceneDescription& scene,
                                 const std::vector<std::vector<StampedPose>>& paths) {
  std::vector<Instant> instants = merged(paths);
  if (!instants.empty()) return instants;
  const auto steps = scene.has<InertiaOptions>()
                         ? static_cast<std::size_t>(std::ceil(scene.duration / scene.dt - 1e-9))
                         : 0;
  for (std::size_t i = 0; i <= steps; ++i) {
    instants.push_back({static_cast<double>(i) * scene.dt, ToolPoses(scene.tools.size())});
  }
  return instants;
}

}  // namespace tissue
