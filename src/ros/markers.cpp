#include "ros/markers.h"

#include "ros/colours.h"
#include "ros/geometry.h"

#include <algorithm>
#include <map>
#include <set>

namespace tissue_ros {
namespace {

using visualization_msgs::Marker;

std_msgs::ColorRGBA opaque(const Colour& colour) {
  std_msgs::ColorRGBA result;
  result.r = colour[0];
  result.g = colour[1];
  result.b = colour[2];
  result.a = 1.0f;
  return result;
}

// Stamp 0, so that late joiners show it too.
Marker empty_marker(const std::string& frame_id, const std::string& name, int type) {
  Marker marker;
  marker.header.frame_id = frame_id;
  marker.ns = name;
  marker.type = type;
  marker.action = Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  marker.color = opaque({1.0f, 1.0f, 1.0f});
  return marker;
}

}  // namespace

visualization_msgs::MarkerArray level_markers(const DisplayMesh& display, const PlaceOf& place,
                                              const std::string& frame_id) {
  std::map<int, Marker> by_level;
  for (const auto* faces : {&display.hull, &display.cut}) {
    for (const DisplayMesh::Face& face : *faces) {
      auto found = by_level.find(face.level);
      if (found == by_level.end()) {
        Marker marker =
            empty_marker(frame_id, "level_" + std::to_string(face.level), Marker::TRIANGLE_LIST);
        marker.color = opaque(level_colour(face.level));
        found = by_level.emplace(face.level, std::move(marker)).first;
      }
      for (const std::uint32_t v : face.corners)
        found->second.points.push_back(point_message(place(v)));
    }
  }
  Marker edges = empty_marker(frame_id, "edges", Marker::LINE_LIST);
  edges.color = opaque({0.05f, 0.05f, 0.05f});
  edges.scale.x = 0.0002;
  std::set<tissue::Edge> seen;
  for (const DisplayMesh::Face& face : display.cut) {
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = face.corners[i], b = face.corners[(i + 1) % 3];
      if (!seen.insert({std::min(a, b), std::max(a, b)}).second) continue;
      edges.points.push_back(point_message(place(a)));
      edges.points.push_back(point_message(place(b)));
    }
  }
  visualization_msgs::MarkerArray array;
  for (auto& entry : by_level) array.markers.push_back(std::move(entry.second));
  if (!edges.points.empty()) array.markers.push_back(std::move(edges));
  return array;
}

visualization_msgs::MarkerArray density_markers(const DisplayMesh& display,
                                                const tissue::TetMesh& mesh) {
  Marker marker = empty_marker(mesh.frame_id, "density", Marker::TRIANGLE_LIST);
  const auto [low, high] = std::minmax_element(mesh.densities.begin(), mesh.densities.end());
  const float range = std::max(*high - *low, 1e-6f);
  for (const auto* faces : {&display.hull, &display.cut}) {
    for (const DisplayMesh::Face& face : *faces) {
      for (const std::uint32_t v : face.corners) {
        const float share = (mesh.densities[v] - *low) / range;
        marker.points.push_back(point_message(mesh.vertices[v].cast<double>()));
        marker.colors.push_back(opaque(share_colour(share)));
      }
    }
  }
  visualization_msgs::MarkerArray array;
  array.markers.push_back(std::move(marker));
  return array;
}

visualization_msgs::MarkerArray replacing_all(visualization_msgs::MarkerArray array) {
  if (array.markers.empty()) return array;
  Marker marker = empty_marker(array.markers[0].header.frame_id, "", Marker::TRIANGLE_LIST);
  marker.action = Marker::DELETEALL;
  array.markers.insert(array.markers.begin(), marker);
  return array;
}

visualization_msgs::Marker ball_marker(const std::string& name, const tissue::Vec3& position,
                                       double radius, float opacity, const std::string& frame_id) {
  Marker marker = empty_marker(frame_id, name, Marker::SPHERE);
  marker.pose.position = point_message(position);
  marker.scale.x = marker.scale.y = marker.scale.z = 2.0 * radius;
  marker.color = opaque({1.0f, 0.85f, 0.1f});
  marker.color.a = opacity;
  return marker;
}

}  // namespace tissue_ros
