#include "ros/rviz/tet_mesh_display.h"

#include "ros/convert.h"

#include <OgreSceneNode.h>
#include <ros/message_traits.h>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/enum_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/ros_topic_property.h>

#include <algorithm>
#include <cstdio>

namespace tissue_ros {
namespace {

using rviz::StatusProperty;
using tissue::Vec3f;

enum ColourBy { kLevel, kDensity, kDisplacement };

// Of what Ogre knows by name.
std::string unique_name() {
  static int count = 0;
  return "TissueTetMesh" + std::to_string(count++);
}

template <class Message>
QString type_of() {
  return QString::fromStdString(ros::message_traits::datatype<Message>());
}

float mean_of_corners(const SeenFace& face, const std::vector<float>& values) {
  return (values[face.corners[0]] + values[face.corners[1]] + values[face.corners[2]]) / 3.0f;
}

std::string number(float value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g", static_cast<double>(value));
  return text;
}

}  // namespace

TetMeshDisplay::TetMeshDisplay() {
  mesh_topic_ =
      new rviz::RosTopicProperty("Mesh Topic", "mesh", type_of<soft_tissue_sim::TetMesh>(),
                                 "The mesh at rest.", this, SLOT(subscribe()), this);
  cloud_topic_ = new rviz::RosTopicProperty(
      "Cloud Topic", "deformed_cloud", type_of<sensor_msgs::PointCloud2>(),
      "Where its vertices are, in their order.", this, SLOT(subscribe()), this);
  colour_by_ = new rviz::EnumProperty("Colour", "Level", "What the colour of a tet shows.", this,
                                      SLOT(change_colours()), this);
  colour_by_->addOption("Level", kLevel);
  colour_by_->addOption("Density", kDensity);
  colour_by_->addOption("Displacement", kDisplacement);
  farthest_ =
      new rviz::FloatProperty("Farthest", 0.01f, "The displacement that gets the last colour [m].",
                              colour_by_, SLOT(change_colours()), this);
  farthest_->setMin(1e-6f);
  style_ = new rviz::EnumProperty("Style", "Shaded with edges", "How tets are drawn.", this,
                                  SLOT(change_style()), this);
  style_->addOption("Shaded", static_cast<int>(FaceRenderable::Style::kShaded));
  style_->addOption("Wireframe", static_cast<int>(FaceRenderable::Style::kWireframe));
  style_->addOption("Shaded with edges", static_cast<int>(FaceRenderable::Style::kBoth));
  alpha_ = new rviz::FloatProperty("Alpha", 1.0f, "0 is invisible, 1 hides what is behind.", this,
                                   SLOT(change_style()), this);
  alpha_->setMin(0.0f);
  alpha_->setMax(1.0f);
  section_axis_ = new rviz::EnumProperty("Section", "none",
                                         "Cuts the mesh open: whole tets behind the plane stay.",
                                         this, SLOT(change_section()), this);
  section_axis_->addOption("none", -1);
  section_axis_->addOption("x", 0);
  section_axis_->addOption("y", 1);
  section_axis_->addOption("z", 2);
  section_at_ = new rviz::FloatProperty("At", 0.5f, "Where, as a part of the mesh's extent.",
                                        section_axis_, SLOT(change_section()), this);
  section_at_->setMin(0.0f);
  section_at_->setMax(1.0f);
  section_flip_ =
      new rviz::BoolProperty("Keep upper", false, "Shows what lies above the plane instead.",
                             section_axis_, SLOT(change_section()), this);
  legend_wished_ = new rviz::BoolProperty("Legend", true, "Says what colours mean.", this,
                                          SLOT(change_colours()), this);
}

TetMeshDisplay::~TetMeshDisplay() {
  mesh_subscriber_.shutdown();
  cloud_subscriber_.shutdown();
}

void TetMeshDisplay::onInitialize() {
  const std::string name = unique_name();
  renderable_ = std::make_unique<FaceRenderable>(scene_node_, name);
  legend_ = std::make_unique<Legend>(name + "Legend");
  legend_->hide();
  change_style();
}

void TetMeshDisplay::onEnable() {
  subscribe();
  show_legend();
}

void TetMeshDisplay::onDisable() {
  mesh_subscriber_.shutdown();
  cloud_subscriber_.shutdown();
  legend_->hide();
}

void TetMeshDisplay::setTopic(const QString& topic, const QString&) {
  mesh_topic_->setString(topic);
}

void TetMeshDisplay::reset() {
  Display::reset();
  if (isEnabled()) subscribe();
}

void TetMeshDisplay::subscribe() {
  mesh_subscriber_.shutdown();
  cloud_subscriber_.shutdown();
  if (!isEnabled()) return;
  // Both in the thread that draws: what they change is its own.
  try {
    mesh_subscriber_ =
        update_nh_.subscribe(mesh_topic_->getTopicStd(), 1, &TetMeshDisplay::take_mesh, this);
    cloud_subscriber_ =
        update_nh_.subscribe(cloud_topic_->getTopicStd(), 1, &TetMeshDisplay::take_cloud, this);
    setStatus(StatusProperty::Ok, "Topics", "OK");
  } catch (const ros::Exception& error) {
    setStatus(StatusProperty::Error, "Topics", error.what());
  }
}

void TetMeshDisplay::take_mesh(const soft_tissue_sim::TetMesh::ConstPtr& message) {
  try {
    tissue::TetMesh mesh = from_message(*message);
    opened_.reset();
    mesh_ = std::move(mesh);
    opened_.emplace(mesh_);
  } catch (const tissue::InputError& error) {
    // The last good mesh stays.
    setStatus(StatusProperty::Error, "Mesh", error.what());
    if (!opened_ && !mesh_.tets.empty()) opened_.emplace(mesh_);
    return;
  }
  places_ = mesh_.vertices;
  setStatus(StatusProperty::Ok, "Mesh",
            QString("%1 tets, %2 vertices").arg(mesh_.tets.size()).arg(mesh_.vertices.size()));
  setStatus(StatusProperty::Ok, "Cloud", "none yet: the mesh is shown at rest");
  change_section();
}

void TetMeshDisplay::take_cloud(const sensor_msgs::PointCloud2::ConstPtr& cloud) {
  if (!opened_) return;
  std::vector<Vec3f> places;
  try {
    places = places_in(*cloud);
  } catch (const tissue::InputError& error) {
    setStatus(StatusProperty::Warn, "Cloud", error.what());
    return;
  }
  if (places.size() != mesh_.vertices.size()) {
    setStatus(StatusProperty::Warn, "Cloud",
              QString("has %1 points, and the mesh %2 vertices")
                  .arg(places.size())
                  .arg(mesh_.vertices.size()));
    return;
  }
  places_ = std::move(places);
  setStatus(StatusProperty::Ok, "Cloud", "OK");
  places_changed_ = true;
}

void TetMeshDisplay::change_section() {
  if (!opened_) return;
  const OpenedMesh::Faces seen =
      opened_->faces({section_axis_->getOptionInt(), static_cast<double>(section_at_->getFloat()),
                      section_flip_->getBool()});
  faces_ = seen.hull;
  faces_.insert(faces_.end(), seen.cut.begin(), seen.cut.end());
  renderable_->set_faces(faces_);
  places_changed_ = true;
  change_colours();
}

void TetMeshDisplay::change_style() {
  const bool wires = style_->getOptionInt() == static_cast<int>(FaceRenderable::Style::kWireframe);
  alpha_->setHidden(wires);
  renderable_->set_style(static_cast<FaceRenderable::Style>(style_->getOptionInt()),
                         alpha_->getFloat());
  change_colours();
}

void TetMeshDisplay::change_colours() {
  farthest_->setHidden(colour_by_->getOptionInt() != kDisplacement);
  if (!renderable_) return;
  if (!faces_.empty()) renderable_->set_colours(colours());
  show_legend();
  context_->queueRender();
}

std::vector<Colour> TetMeshDisplay::colours() const {
  std::vector<Colour> result;
  result.reserve(faces_.size());
  const int by = colour_by_->getOptionInt();
  const auto range = std::minmax_element(mesh_.densities.begin(), mesh_.densities.end());
  const float span = std::max(*range.second - *range.first, 1e-6f);
  for (const SeenFace& face : faces_) {
    if (by == kLevel) {
      result.push_back(level_colour(mesh_.levels[face.tet]));
    } else if (by == kDensity) {
      result.push_back(
          share_colour((mean_of_corners(face, mesh_.densities) - *range.first) / span));
    } else {
      float moved = 0.0f;
      for (const std::uint32_t v : face.corners)
        moved += (places_[v] - mesh_.vertices[v]).norm() / 3.0f;
      result.push_back(share_colour(moved / farthest_->getFloat()));
    }
  }
  return result;
}

void TetMeshDisplay::show_legend() {
  if (!isEnabled() || !legend_wished_->getBool() || !opened_) {
    legend_->hide();
    return;
  }
  std::vector<Legend::Line> lines;
  const int by = colour_by_->getOptionInt();
  if (by == kLevel) {
    std::vector<std::size_t> tets(256, 0);
    for (const std::uint8_t level : mesh_.levels) ++tets[level];
    for (int level = 0; level < 256; ++level) {
      const std::size_t count = tets[static_cast<std::size_t>(level)];
      if (count == 0) continue;
      lines.push_back(
          {level_colour(level), std::to_string(level) + ": " + std::to_string(count) + " tets"});
    }
    legend_->show("Level", lines);
    return;
  }
  const auto range = std::minmax_element(mesh_.densities.begin(), mesh_.densities.end());
  const float low = by == kDensity ? *range.first : 0.0f,
              high = by == kDensity ? *range.second : 1e3f * farthest_->getFloat();
  for (const float share : {1.0f, 0.75f, 0.5f, 0.25f, 0.0f}) {
    lines.push_back({share_colour(share), number(low + share * (high - low))});
  }
  legend_->show(by == kDensity ? "Density" : "Displacement [mm]", lines);
}

void TetMeshDisplay::update(float wall_dt, float) {
  ++frames_;
  seconds_ += wall_dt;
  if (seconds_ > 2.0f) {
    setStatus(StatusProperty::Ok, "Drawing",
              QString("%1 triangles, %2 frames/s")
                  .arg(faces_.size())
                  .arg(static_cast<double>(static_cast<float>(frames_) / seconds_), 0, 'f', 1));
    frames_ = 0;
    seconds_ = 0.0f;
  }
  if (!opened_) return;
  Ogre::Vector3 position;
  Ogre::Quaternion orientation;
  if (context_->getFrameManager()->getTransform(mesh_.frame_id, ros::Time(), position,
                                                orientation)) {
    scene_node_->setPosition(position);
    scene_node_->setOrientation(orientation);
    setStatus(StatusProperty::Ok, "Transform", "OK");
  } else {
    std::string reason;
    context_->getFrameManager()->transformHasProblems(mesh_.frame_id, ros::Time(), reason);
    setStatusStd(StatusProperty::Error, "Transform", reason);
  }
  if (!places_changed_) return;
  places_changed_ = false;
  renderable_->set_places(places_);
  if (colour_by_->getOptionInt() == kDisplacement) renderable_->set_colours(colours());
  context_->queueRender();
}

}  // namespace tissue_ros

#include <pluginlib/class_list_macros.hpp>
PLUGINLIB_EXPORT_CLASS(tissue_ros::TetMeshDisplay, rviz::Display)
