#pragma once

#include "ros/display_mesh.h"
#include "ros/parameters.h"
#include "ros/scene_worker.h"

#include <sensor_msgs/PointCloud2.h>
#include <soft_tissue_sim/Probes.h>
#include <soft_tissue_sim/SimulationStatus.h>
#include <visualization_msgs/MarkerArray.h>

namespace tissue_ros {

/// A mesh that moves as a scene says, and what is said of it in messages.
class Simulation {
 public:
  /// What is published of one instant.
  struct Clouds {
    boost::shared_ptr<sensor_msgs::PointCloud2> cloud;
    boost::shared_ptr<soft_tissue_sim::Probes> probes;
  };
  /// Hears of every cloud that is due in a replay.
  using OnClouds = std::function<void(const Clouds&)>;

  /// Throws tissue::InputError E_MESH_QUALITY for a mesh without tets, and what tissue::Scene does.
  Simulation(std::shared_ptr<const tissue::TetMesh> mesh, const tissue::SceneDescription& scene,
             const DeformerNodeParameters& parameters, OnClouds on_clouds,
             SceneWorker::OnError on_error);

  const std::shared_ptr<const tissue::TetMesh>& mesh() const { return mesh_; }
  const std::shared_ptr<SceneWorker>& worker() const { return worker_; }

  /// As everything is now, with the stamp of the newest pose that was used.
  Clouds clouds() const;
  visualization_msgs::MarkerArray markers() const;
  /// Counters are left open.
  soft_tissue_sim::SimulationStatus status() const;

 private:
  std::shared_ptr<const tissue::TetMesh> mesh_;
  std::shared_ptr<const std::vector<std::uint8_t>> levels_;
  DisplayMesh display_;
  // Tools may hold it longer than this lives.
  std::shared_ptr<SceneWorker> worker_;
};

}  // namespace tissue_ros
