#include "ros/kept_state.h"

#include "ros/guarded.h"
#include "tissue/base/mesh_file.h"
#include "tissue/base/atomic_file.h"
#include "tissue/base/safe_path.h"

#include <ros/console.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

namespace tissue_ros {
namespace {

namespace fs = std::filesystem;
using tissue::ErrorCode;
using tissue::InputError;

bool exists(const std::string& path) {
  std::error_code failed;
  return !path.empty() && fs::is_regular_file(path, failed);
}

template <class Work>
void warn_if_it_fails(const std::string& path, const Work& work) {
  const Outcome outcome = guarded(work);
  if (!outcome.ok()) ROS_WARN("'%s' is not kept: %s", path.c_str(), outcome.sentence.c_str());
}

}  // namespace

std::string state_folder(const std::string& named) {
  const char* home = std::getenv("HOME");
  const char* ros_home = std::getenv("ROS_HOME");
  const fs::path root =
      ros_home != nullptr ? fs::path(ros_home) : fs::path(home != nullptr ? home : "/tmp") / ".ros";
  const fs::path folder = named.empty() ? root / "soft_tissue_sim" : fs::path(named);
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (!fs::is_directory(folder, failed)) {
    throw InputError(ErrorCode::kPath, "~folder: '" + folder.string() + "' is no folder");
  }
  return folder.string();
}

KeptState::KeptState(const std::string& folder, const std::string& name) {
  if (name.empty()) return;
  const std::string below = state_folder(folder);
  tissue::remove_unfinished(below);
  mesh_file_ = tissue::confined_path(below, name + ".vtu", false);
  scene_file_ = tissue::confined_path(below, name + ".yaml", false);
  writer_ = std::thread([this] { write_all(); });
}

KeptState::~KeptState() {
  if (!writer_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_over_ = true;
  }
  changed_.notify_one();
  writer_.join();
}

void KeptState::keep(std::shared_ptr<const tissue::TetMesh> mesh) {
  if (mesh_file_.empty()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    next_ = std::move(mesh);
  }
  changed_.notify_one();
}

void KeptState::write_all() {
  std::unique_lock<std::mutex> lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return is_over_ || next_ != nullptr; });
    if (next_ == nullptr) return;
    const std::shared_ptr<const tissue::TetMesh> mesh = std::exchange(next_, nullptr);
    lock.unlock();
    warn_if_it_fails(mesh_file_, [&] { tissue::write_mesh(*mesh, mesh_file_); });
    lock.lock();
  }
}

void KeptState::keep_scene(const std::string& yaml) {
  if (scene_file_.empty()) return;
  warn_if_it_fails(scene_file_, [&] {
    tissue::AtomicFile file(scene_file_);
    std::ofstream(file.temporary()) << yaml;
    file.commit();
  });
}

std::optional<tissue::TetMesh> KeptState::mesh() const {
  std::optional<tissue::TetMesh> mesh;
  if (exists(mesh_file_)) {
    warn_if_it_fails(mesh_file_, [&] { mesh = tissue::read_mesh(mesh_file_, /*only_own=*/true); });
  }
  return mesh;
}

std::optional<std::string> KeptState::scene() const {
  if (!exists(scene_file_)) return std::nullopt;
  std::ifstream file(scene_file_);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

void KeptState::forget() {
  if (mesh_file_.empty()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_over_ = true;
    next_ = nullptr;
  }
  changed_.notify_one();
  writer_.join();
  std::error_code failed;
  fs::remove(mesh_file_, failed);
  fs::remove(scene_file_, failed);
}

}  // namespace tissue_ros
