#pragma once

#include "ros/guarded.h"
#include "ros/parameters.h"

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <soft_tissue_sim/BuildMesh.h>
#include <soft_tissue_sim/Volume.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace tissue_ros {

/// Takes `volume` and `mask`, builds on request and publishes `mesh`, `mesh_markers` and
/// `mesh_density_markers`, latched. Building happens on threads of its own: nothing else waits for
/// it, and a second request meanwhile is answered E_BUSY at once. Whatever is refused leaves the
/// last volume and the last mesh as they were.
class MesherNode {
 public:
  MesherNode(ros::NodeHandle handle, ros::NodeHandle private_handle,
             const MesherNodeParameters& parameters);
  ~MesherNode();

 private:
  using Request = soft_tissue_sim::BuildMesh::Request;
  using Response = soft_tissue_sim::BuildMesh::Response;
  using VolumePtr = std::shared_ptr<const tissue::Volume>;

  void take_volume(const soft_tissue_sim::Volume& message, const char* name, VolumePtr& slot);
  bool serve(Request& request, Response& response);
  /// The caller holds build_mutex_.
  Outcome build(const Request& request, Response& response);
  void build_if_wanted();
  Request request_from_parameters() const;
  void publish(const tissue::TetMesh& mesh);
  void report(const char* what, const Outcome& outcome);
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  MesherNodeParameters parameters_;
  std::mutex volume_mutex_;
  VolumePtr volume_, mask_;
  std::mutex build_mutex_;
  std::atomic<std::uint64_t> rejected_{0}, built_{0};

  // Requests are served from a queue of their own, by two threads: one that builds and one that can
  // still say that it is busy. They take one request at a time, which roscpp's spinner does not.
  ros::CallbackQueue build_queue_;
  ros::Publisher mesh_publisher_, marker_publisher_, density_publisher_;
  ros::Subscriber volume_subscriber_, mask_subscriber_;
  ros::ServiceServer service_;
  diagnostic_updater::Updater diagnostics_;
  ros::WallTimer diagnostics_timer_;
  std::atomic<bool> build_wanted_{false}, ending_{false};
  std::vector<std::thread> build_threads_;
};

}  // namespace tissue_ros
