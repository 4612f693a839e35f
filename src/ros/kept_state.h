#pragma once

#include "tissue/base/tet_mesh.h"

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace tissue_ros {

/// Where a node's files are: `folder`, or below ROS_HOME if that is empty. Made if it is not there.
/// Throws tissue::InputError E_PATH if it cannot be.
std::string state_folder(const std::string& folder);

/// The last good mesh and scene in files, for the node that takes the place of one that crashed or
/// lost its master. Meshes are written in a thread of its own; the newest wins.
class KeptState {
 public:
  /// Keeps NAME.vtu and NAME.yaml in `folder` (see state_folder()); nothing if `name` is empty.
  /// Throws tissue::InputError E_PATH for a name that leads out of the folder.
  KeptState(const std::string& folder, const std::string& name);
  ~KeptState();
  KeptState(const KeptState&) = delete;
  KeptState& operator=(const KeptState&) = delete;

  void keep(std::shared_ptr<const tissue::TetMesh> mesh);
  void keep_scene(const std::string& yaml);
  /// What was kept; nothing if that cannot be read any more.
  std::optional<tissue::TetMesh> mesh() const;
  std::optional<std::string> scene() const;
  /// The node ends well: nobody takes its place.
  void forget();

 private:
  void write_all();

  std::string mesh_file_, scene_file_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<const tissue::TetMesh> next_;
  bool is_over_ = false;
  std::thread writer_;
};

}  // namespace tissue_ros
