#pragma once

#include "ros/parameters.h"
#include "tissue/base/error.h"
#include "tissue/field/triangle_surface.h"
#include "tissue/simulate/scene_file.h"
#include "tissue/study/strain_mesh.h"

#include <soft_tissue_sim/BuildMesh.h>

namespace tissue_ros {

// From the request of BuildMesh.srv or the goal of BuildMesh.action, which have the same fields, to
// the core's options. Each throws tissue::InputError that names the field and the value.

inline tissue::Method method_from(const std::string& name) {
  const std::optional<tissue::Method> method = tissue::method_named(name.empty() ? "density" : name);
  if (method) return *method;
  throw tissue::InputError(tissue::ErrorCode::kParam, "method: '" + name.substr(0, 40) +
                                                          "' is not " + tissue::method_names());
}

template <class Request>
std::map<std::int64_t, double> label_densities_from(const Request& request) {
  if (request.labels.size() != request.label_densities.size()) {
    throw tissue::InputError(tissue::ErrorCode::kSizeMismatch,
                             "label_densities: " + std::to_string(request.label_densities.size()) +
                                 " for " + std::to_string(request.labels.size()) + " labels");
  }
  std::map<std::int64_t, double> densities;
  for (std::size_t i = 0; i < request.labels.size(); ++i) {
    densities[request.labels[i]] = request.label_densities[i];
  }
  return densities;
}

/// Calls `file` for the path of what a request names below the mesher's folder.
using FileNamed = std::function<std::string(const std::string&)>;

template <class Request>
tissue::ImplicitSurface surface_for(const Request& request,
                                    const std::shared_ptr<const tissue::Volume>& volume,
                                    const std::shared_ptr<const tissue::Volume>& mask,
                                    const FileNamed& file) {
  if (!request.surface_file.empty()) {
    return tissue::surface_of_triangles(tissue::read_surface(file(request.surface_file)),
                                        volume->grid);
  }
  if (mask != nullptr) return tissue::surface_of_mask(mask);
  return tissue::surface_at_iso(volume, request.iso_value);
}

/// What strains the tissue, for the method of that name.
template <class Request>
tissue::SceneMotion motion_from(const Request& request, const FileNamed& file) {
  if (request.scene_file.empty()) {
    throw tissue::InputError(tissue::ErrorCode::kParam,
                             "scene_file: is empty; the method strain needs a scene");
  }
  const tissue::SceneDescription scene = tissue::read_scene(file(request.scene_file));
  return {scene, instants_of(scene, read_paths(scene, request.path_files, file))};
}

template <class Request>
tissue::Component component_from(const Request& request) {
  tissue::Component component;
  if (request.all_components) component.choice = tissue::Component::Choice::kAll;
  if (request.component_at_place) {
    component.choice = tissue::Component::Choice::kNearest;
    const auto& place = request.component_place;
    component.place = {place.x, place.y, place.z};
  }
  return component;
}

template <class Request>
tissue::MeshOptions options_from(const Request& request, const MesherNodeParameters& parameters) {
  const auto small = [](std::uint32_t value) {
    return static_cast<int>(std::min<std::uint32_t>(value, 1000000));
  };
  tissue::MeshOptions options;
  options.method = method_from(request.method);
  options.iso_value = request.iso_value;
  options.spacing = request.spacing;
  options.target_tetrahedra = request.target_tetrahedra;
  options.initial_tetrahedra = request.initial_tetrahedra;
  options.levels.sections = small(request.level_sections);
  options.levels.base_level = small(request.base_level);
  options.levels.smooth_levels = small(request.smooth_levels);
  options.keep_interfaces = request.keep_interfaces;
  options.project_boundary = request.project_boundary;
  if (request.d_max != 0.0) options.levels.d_max = request.d_max;
  // Not equal also where one of them is not a number, which is then refused by name.
  if (!(request.window_low == request.window_high)) {
    options.window = {{request.window_low, request.window_high}};
  }
  options.label_densities = label_densities_from(request);
  options.component = component_from(request);
  options.max_tetrahedra = static_cast<std::uint64_t>(std::max(parameters.max_tetrahedra, 1));
  return options;
}

/// What the node asks of itself where it builds on every new volume.
inline soft_tissue_sim::BuildMeshRequest request_from(const MesherNodeParameters& parameters) {
  const auto natural = [](const char* name, int value) {
    if (value >= 0) return static_cast<std::uint32_t>(value);
    throw tissue::InputError(tissue::ErrorCode::kParam, std::string("~") + name + ": " +
                                                            std::to_string(value) + " is negative");
  };
  soft_tissue_sim::BuildMeshRequest request;
  request.use_mask = parameters.use_mask;
  request.iso_value = parameters.iso_value;
  request.spacing = parameters.spacing;
  request.method = parameters.method;
  request.target_tetrahedra = natural("target_tetrahedra", parameters.target_tetrahedra);
  request.initial_tetrahedra = natural("initial_tetrahedra", parameters.initial_tetrahedra);
  request.keep_interfaces = parameters.keep_interfaces;
  request.project_boundary = parameters.project_boundary;
  request.level_sections = natural("level_sections", parameters.level_sections);
  request.base_level = natural("base_level", parameters.base_level);
  request.smooth_levels = natural("smooth_levels", parameters.smooth_levels);
  return request;
}

}  // namespace tissue_ros
