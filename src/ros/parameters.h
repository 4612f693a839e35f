#pragma once

#include "ros/settings.h"
#include "tissue/refine/build_mesh.h"
#include "tissue/simulate/force_loop.h"

#include <string>
#include <vector>

namespace tissue_ros {

// The nodes' parameters, their only defaults and what numbers may be; config/parameters.yaml
// repeats the defaults with comments, and a test compares the two. `visit` names each of them to a
// reader or to that test.

constexpr Range kAny{-1e300, 1e300};
/// [Hz] or [s]
constexpr Range kRate{1e-4, 1e4};

struct VolumeNodeParameters {
  std::string file;
  std::string frame_id = "patient";
  std::string quantity = "density";
  std::vector<double> crop;
  std::vector<double> tumour;
  std::string mask_file;
  bool mask_by_threshold = false;
  double mask_above = 0.0;
  int mask_opening = 0;
  double mask_smoothing = 0.0;

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("file", file);
    visitor("frame_id", frame_id);
    visitor("quantity", quantity);
    visitor("crop", crop);
    visitor("tumour", tumour);
    visitor("mask_file", mask_file);
    visitor("mask_by_threshold", mask_by_threshold);
    visitor("mask_above", mask_above, kAny);
    visitor("mask_opening", mask_opening, Range{0, 100});
    visitor("mask_smoothing", mask_smoothing, Range{0, 100});
  }
};

struct MesherNodeParameters {
  bool build_on_volume = false;
  bool use_mask = false;
  double iso_value = tissue::MeshOptions{}.iso_value;
  double spacing = tissue::MeshOptions{}.spacing;
  std::string method = "density";
  int target_tetrahedra = 0;
  int initial_tetrahedra = static_cast<int>(tissue::MeshOptions{}.initial_tetrahedra);
  int level_sections = tissue::LevelOptions{}.sections;
  int base_level = tissue::LevelOptions{}.base_level;
  int smooth_levels = tissue::LevelOptions{}.smooth_levels;
  bool keep_interfaces = tissue::MeshOptions{}.keep_interfaces;
  bool project_boundary = tissue::MeshOptions{}.project_boundary;
  std::string folder, keep;
  int max_tetrahedra = static_cast<int>(tissue::MeshOptions{}.max_tetrahedra);
  int threads = tissue::Run{}.threads;
  int marker_max_triangles = 20000;
  std::string section_axis = "y";
  double section_at = 0.5;

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("build_on_volume", build_on_volume);
    visitor("use_mask", use_mask);
    visitor("iso_value", iso_value, kAny);
    visitor("spacing", spacing, Range{0, 10});
    visitor("method", method);
    visitor("target_tetrahedra", target_tetrahedra, Range{0, 1e9});
    visitor("initial_tetrahedra", initial_tetrahedra, Range{0, 1e9});
    visitor("level_sections", level_sections, Range{1, 255});
    visitor("base_level", base_level, Range{0, 20});
    visitor("smooth_levels", smooth_levels, Range{0, 1000});
    visitor("keep_interfaces", keep_interfaces);
    visitor("project_boundary", project_boundary);
    visitor("folder", folder);
    visitor("keep", keep);
    visitor("max_tetrahedra", max_tetrahedra, Range{1, 1e9});
    visitor("threads", threads, Range{0, 1024});
    visitor("marker_max_triangles", marker_max_triangles, Range{0, 1e8});
    visitor("section_axis", section_axis);
    visitor("section_at", section_at, Range{0, 1});
  }
};

struct DeformerNodeParameters {
  std::string scene, folder, keep;
  bool deterministic = false;
  bool reset_on_time_jump = true;
  double tool_timeout = 0.1;
  double max_force = tissue::ForceLoopOptions{}.max_force;
  double max_force_rise = tissue::ForceLoopOptions{}.max_rise;
  double cloud_rate = 30.0;
  double marker_rate = 10.0;
  double status_rate = 2.0;
  int marker_max_triangles = 20000;
  std::string section_axis = "y";
  double section_at = 0.5;

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("scene", scene);
    visitor("folder", folder);
    visitor("keep", keep);
    visitor("deterministic", deterministic);
    visitor("reset_on_time_jump", reset_on_time_jump);
    visitor("tool_timeout", tool_timeout, kRate);
    visitor("max_force", max_force, Range{1e-6, 1000});
    visitor("max_force_rise", max_force_rise, Range{1e-3, 1e6});
    visitor("cloud_rate", cloud_rate, kRate);
    visitor("marker_rate", marker_rate, kRate);
    visitor("status_rate", status_rate, kRate);
    visitor("marker_max_triangles", marker_max_triangles, Range{0, 1e8});
    visitor("section_axis", section_axis);
    visitor("section_at", section_at, Range{0, 1});
  }
};

struct ToolPathNodeParameters {
  std::string tool = "tool";
  std::string frame_id = "patient";
  std::string kind = "file";
  std::string file;
  std::vector<double> from;
  std::vector<double> to;
  std::vector<double> centre;
  std::vector<double> axis = {0.0, 0.0, 1.0};
  double radius = 0.01;
  double period = 2.0;
  double rate = 100.0;

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("tool", tool);
    visitor("frame_id", frame_id);
    visitor("kind", kind);
    visitor("file", file);
    visitor("from", from);
    visitor("to", to);
    visitor("centre", centre);
    visitor("axis", axis);
    visitor("radius", radius, Range{1e-6, 10});
    visitor("period", period, Range{1e-3, 1e6});
    visitor("rate", rate, kRate);
  }
};

struct MouseToolNodeParameters {
  std::string tool = "tool";
  std::string frame_id = "patient";
  std::vector<double> at = {0.0, 0.0, 0.1};
  double radius = 0.005;
  double rate = 100.0;

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("tool", tool);
    visitor("frame_id", frame_id);
    visitor("at", at);
    visitor("radius", radius, Range{1e-6, 10});
    visitor("rate", rate, kRate);
  }
};

struct DeviceAdapterNodeParameters {
  std::string device = "omni";
  std::string name = "phantom";
  std::string tool = "tool";
  std::string frame_id = "patient";
  double scale = 0.001;
  double force_timeout = 0.1;

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("device", device);
    visitor("name", name);
    visitor("tool", tool);
    visitor("frame_id", frame_id);
    visitor("scale", scale, Range{1e-9, 1e9});
    visitor("force_timeout", force_timeout, kRate);
  }
};

}  // namespace tissue_ros
