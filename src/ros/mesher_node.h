#pragma once

#include "ros/guarded.h"
#include "ros/kept_state.h"
#include "ros/parameters.h"

#include <actionlib/server/action_server.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <soft_tissue_sim/BuildMesh.h>
#include <soft_tissue_sim/BuildMeshAction.h>
#include <soft_tissue_sim/MeshFile.h>
#include <soft_tissue_sim/Volume.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace tissue_ros {

/// Takes `volume` and `mask`, builds on request, by service or action, and publishes `mesh`,
/// `mesh_markers` and `mesh_density_markers`, latched; saves the mesh and loads others. Building
/// happens on threads of its own: nothing else waits for it, a second request meanwhile is answered
/// E_BUSY at once, and cancelling stops it between two pieces of its loops. Whatever is refused
/// leaves the last volume and the last mesh as they were.
class MesherNode {
 public:
  MesherNode(ros::NodeHandle handle, ros::NodeHandle private_handle,
             const MesherNodeParameters& parameters);
  ~MesherNode();

  /// The node ends well: what it kept for one that takes its place is of no use.
  void forget() { kept_.forget(); }

 private:
  using Request = soft_tissue_sim::BuildMesh::Request;
  using Response = soft_tissue_sim::BuildMesh::Response;
  using FileRequest = soft_tissue_sim::MeshFile::Request;
  using FileResponse = soft_tissue_sim::MeshFile::Response;
  using ActionServer = actionlib::ActionServer<soft_tissue_sim::BuildMeshAction>;
  using Goal = ActionServer::GoalHandle;
  using VolumePtr = std::shared_ptr<const tissue::Volume>;
  using MeshPtr = std::shared_ptr<const tissue::TetMesh>;
  // What a build looks at, and stops when it is set.
  using Token = std::shared_ptr<std::atomic<bool>>;

  void take_volume(const soft_tissue_sim::Volume& message, const char* name, VolumePtr& slot);
  tissue::Run run_until(Token cancelled) const;
  bool serve(Request& request, Response& response);
  void take_goal(Goal goal);
  void pursue(Goal goal, const tissue::Run& run);
  void cancel(Goal goal);
  bool save(FileRequest& request, FileResponse& response);
  bool load(FileRequest& request, FileResponse& response);
  void build_if_wanted();
  /// Builds and publishes, unless a build is running: then E_BUSY. `Answer` is the response of the
  /// service or the result of the action, which have the same fields, as their requests have.
  template <class Asked, class Answer>
  void build(const Asked& request, Answer& answer, const tissue::Run& run);
  template <class Asked>
  tissue::TetMesh mesh_for(const Asked& request, const tissue::Run& run) const;
  void publish(const MeshPtr& mesh);
  void report(const char* what, const Outcome& outcome);
  /// What became of `work`; what was refused is reported.
  template <class Work>
  soft_tissue_sim::Result result_of(const char* what, const Work& work);
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  MesherNodeParameters parameters_;
  KeptState kept_;
  mutable std::mutex data_mutex_;
  VolumePtr volume_, mask_;
  MeshPtr mesh_;
  std::mutex build_mutex_;
  std::mutex publish_mutex_;
  // That of the goal last taken, and of all other builds.
  std::mutex goal_mutex_;
  Token goal_cancelled_ = std::make_shared<std::atomic<bool>>(false);
  const Token node_ending_ = std::make_shared<std::atomic<bool>>(false);
  std::atomic<std::uint64_t> rejected_{0}, built_{0};

  // Requests are served from a queue of their own, by two threads: one that builds and one that can
  // still say that it is busy. They take one request at a time, which roscpp's spinner does not.
  ros::CallbackQueue build_queue_;
  ros::Publisher mesh_publisher_, marker_publisher_, density_publisher_;
  ros::Subscriber volume_subscriber_, mask_subscriber_;
  std::vector<ros::ServiceServer> services_;
  std::unique_ptr<ActionServer> action_;
  diagnostic_updater::Updater diagnostics_;
  ros::WallTimer diagnostics_timer_;
  bool has_kept_mesh_ = false;
  std::atomic<bool> build_wanted_{false}, ending_{false};
  std::vector<std::thread> build_threads_;
  std::atomic<bool> pursuing_{false};
  std::thread pursuit_;
};

}  // namespace tissue_ros
