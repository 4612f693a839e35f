#pragma once

#include "tissue/simulate/scene.h"

#include <functional>
#include <istream>
#include <string>
#include <vector>

namespace tissue {

/// A tool's pose at a time [s].
struct StampedPose {
  double time = 0.0;
  ToolPose pose;
};

/// Reads lines `t,x,y,z,qx,qy,qz,qw` with an optional ninth number, the grip (1: closed); a head
/// line and empty lines are passed over. Throws InputError E_FILE or E_PARAM that names
/// file, line and value: numbers must be finite, the quaternion's norm within 0.9 to 1.1, times
/// must not fall.
std::vector<StampedPose> read_poses(const std::string& path);
/// The same of any lines, which errors name `path`.
std::vector<StampedPose> parse_poses(std::istream& lines, const std::string& path);

/// Where a path is at a time, between its poses along a straight line and the shortest turn; before
/// its first and after its last pose there. Its grip is that of the pose before. `path` must not be
/// empty.
ToolPose pose_at(const std::vector<StampedPose>& path, double time);

/// There and back along a straight line, evenly, in `period` seconds; from the start.
std::vector<StampedPose> line_path(const Vec3& from, const Vec3& to, double period);
/// Once around a circle about `axis`, in `period` seconds. Throws InputError E_PARAM for an axis of
/// no length.
std::vector<StampedPose> circle_path(const Vec3& centre, const Vec3& axis, double radius,
                                     double period);

/// One path for each tool of the scene, from files named `FILE` (for the first tool) or
/// `TOOL=FILE`; empty for a tool without one. `locate` turns the name of a file into its path.
/// Throws as read_poses(), and E_PARAM for a tool that the scene has not or that has two paths.
std::vector<std::vector<StampedPose>> read_paths(
    const SceneDescription& scene, const std::vector<std::string>& files,
    const std::function<std::string(const std::string&)>& locate = {});

/// What all tools do at one instant.
struct Instant {
  double time = 0.0;
  ToolPoses tools;
};

/// The instants at which any tool has a pose, in order; a tool keeps its last pose, and is absent
/// before its first and after its last.
std::vector<Instant> merged(const std::vector<std::vector<StampedPose>>& paths);

/// The instants of a run: those of the paths, one for each tool of the scene; without any pose one
/// equilibrium or, with inertia, as long as the scene says.
std::vector<Instant> instants_of(const SceneDescription& scene,
                                 const std::vector<std::vector<StampedPose>>& paths);

}  // namespace tissue
