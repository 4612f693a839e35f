#pragma once

#include "ros/rviz/face_renderable.h"
#include "ros/rviz/legend.h"
#include "ros/section.h"

#include <rviz/display.h>
#include <sensor_msgs/PointCloud2.h>
#include <soft_tissue_sim/TetMesh.h>

#include <memory>
#include <optional>

namespace rviz {
class BoolProperty;
class EnumProperty;
class FloatProperty;
class RosTopicProperty;
}  // namespace rviz

namespace tissue_ros {

/// soft_tissue_sim/TetMesh in rviz: the mesh as it is deformed, from the mesh itself and the cloud
/// of its vertices.
class TetMeshDisplay : public rviz::Display {
  Q_OBJECT
 public:
  TetMeshDisplay();
  ~TetMeshDisplay() override;

  void setTopic(const QString& topic, const QString& datatype) override;
  void update(float wall_dt, float ros_dt) override;
  void reset() override;

 protected:
  void onInitialize() override;
  void onEnable() override;
  void onDisable() override;

 private Q_SLOTS:
  void subscribe();
  void change_section();
  void change_style();
  void change_colours();

 private:
  void take_mesh(const soft_tissue_sim::TetMesh::ConstPtr& message);
  void take_cloud(const sensor_msgs::PointCloud2::ConstPtr& cloud);
  // Of each face by what the user wants to see.
  std::vector<Colour> colours() const;
  void show_legend();

  rviz::RosTopicProperty* mesh_topic_;
  rviz::RosTopicProperty* cloud_topic_;
  rviz::EnumProperty* colour_by_;
  rviz::FloatProperty* farthest_;
  rviz::EnumProperty* style_;
  rviz::FloatProperty* alpha_;
  rviz::EnumProperty* section_axis_;
  rviz::FloatProperty* section_at_;
  rviz::BoolProperty* section_flip_;
  rviz::BoolProperty* legend_wished_;

  ros::Subscriber mesh_subscriber_, cloud_subscriber_;
  tissue::TetMesh mesh_;
  std::optional<OpenedMesh> opened_;
  std::vector<SeenFace> faces_;
  // Where the vertices are now.
  std::vector<tissue::Vec3f> places_;
  bool places_changed_ = false;
  std::unique_ptr<FaceRenderable> renderable_;
  std::unique_ptr<Legend> legend_;
  // For the rate that the status shows.
  int frames_ = 0;
  float seconds_ = 0.0f;
};

}  // namespace tissue_ros
