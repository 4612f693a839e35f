#pragma once

#include "tissue/refine/build_mesh.h"
#include "tissue/simulate/force_loop.h"

#include <string>
#include <vector>

namespace tissue_ros {

// The nodes' parameters and their only defaults; config/parameters.yaml repeats them with comments,
// and a test compares the two. `visit` names each of them to a reader or to that test.

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
    visitor("mask_above", mask_above);
    visitor("mask_opening", mask_opening);
    visitor("mask_smoothing", mask_smoothing);
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
  std::string folder;
  int max_tetrahedra = static_cast<int>(tissue::MeshOptions{}.max_tetrahedra);
  int threads = tissue::MeshOptions{}.threads;
  int marker_max_triangles = 20000;
  std::string section_axis = "y";
  double section_at = 0.5;

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("build_on_volume", build_on_volume);
    visitor("use_mask", use_mask);
    visitor("iso_value", iso_value);
    visitor("spacing", spacing);
    visitor("method", method);
    visitor("target_tetrahedra", target_tetrahedra);
    visitor("initial_tetrahedra", initial_tetrahedra);
    visitor("level_sections", level_sections);
    visitor("base_level", base_level);
    visitor("smooth_levels", smooth_levels);
    visitor("keep_interfaces", keep_interfaces);
    visitor("project_boundary", project_boundary);
    visitor("folder", folder);
    visitor("max_tetrahedra", max_tetrahedra);
    visitor("threads", threads);
    visitor("marker_max_triangles", marker_max_triangles);
    visitor("section_axis", section_axis);
    visitor("section_at", section_at);
  }
};

struct DeformerNodeParameters {
  std::string scene;
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
    visitor("deterministic", deterministic);
    visitor("reset_on_time_jump", reset_on_time_jump);
    visitor("tool_timeout", tool_timeout);
    visitor("max_force", max_force);
    visitor("max_force_rise", max_force_rise);
    visitor("cloud_rate", cloud_rate);
    visitor("marker_rate", marker_rate);
    visitor("status_rate", status_rate);
    visitor("marker_max_triangles", marker_max_triangles);
    visitor("section_axis", section_axis);
    visitor("section_at", section_at);
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
    visitor("radius", radius);
    visitor("period", period);
    visitor("rate", rate);
  }
};

/// Reads every parameter from a node handle.
template <class Parameters, class NodeHandle>
Parameters read_parameters(const NodeHandle& private_handle) {
  Parameters parameters;
  parameters.visit([&](const char* name, auto& value) {
    const auto fallback = value;
    private_handle.param(name, value, fallback);
  });
  return parameters;
}

}  // namespace tissue_ros
