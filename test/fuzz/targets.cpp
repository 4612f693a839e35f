#include "fuzz/targets.h"

#include "tissue/base/boundary.h"
#include "tissue/base/check_mesh.h"
#include "tissue/base/error.h"
#include "tissue/base/mesh_file.h"
#include "tissue/field/volume.h"
#include "tissue/simulate/pose_path.h"
#include "tissue/simulate/scene_file.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <sstream>
#include <stdexcept>

namespace tissue_fuzz {
namespace {

using namespace tissue;

void require(bool holds, const char* what) {
  if (!holds) throw std::logic_error(what);
}

// Bytes taken from the front, zeros when there are no more.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  template <class T>
  T take() {
    T value{};
    const std::size_t count = std::min(sizeof(T), size_);
    if (count > 0) std::memcpy(&value, data_, count);
    skip(count);
    return value;
  }
  template <class T>
  std::vector<T> take_all(std::size_t most) {
    std::vector<T> values(std::min(most, size_ / sizeof(T)));
    const std::size_t size = values.size() * sizeof(T);
    if (size > 0) std::memcpy(static_cast<void*>(values.data()), data_, size);
    skip(values.size() * sizeof(T));
    return values;
  }
  std::string take_word() {
    const std::vector<char> letters = take_all<char>(take<std::uint8_t>());
    return {letters.begin(), letters.end()};
  }
  const std::uint8_t* data() const { return data_; }
  std::size_t size() const { return size_; }

 private:
  void skip(std::size_t count) {
    data_ += count;
    size_ -= count;
  }
  const std::uint8_t* data_;
  std::size_t size_;
};

void volume(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  RawVolume raw;
  for (auto& extent : raw.size) extent = bytes.take<std::uint32_t>();
  for (int axis = 0; axis < 3; ++axis) raw.spacing[axis] = bytes.take<double>();
  for (int axis = 0; axis < 3; ++axis) raw.origin[axis] = bytes.take<double>();
  for (double& number : raw.orientation) number = bytes.take<double>();
  raw.slope = bytes.take<double>();
  raw.intercept = bytes.take<double>();
  raw.is_bigendian = (bytes.take<std::uint8_t>() & 1) != 0;
  raw.encoding = bytes.take_word();
  raw.quantity = bytes.take_word();
  raw.frame_id = bytes.take_word();
  raw.data = bytes.data();
  raw.data_size = bytes.size();
  const Volume decoded = decode_volume(raw);
  check_volume(decoded);
}

void mesh(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  TetMesh mesh;
  mesh.frame_id = "patient";
  const std::size_t vertices = bytes.take<std::uint8_t>(), tets = bytes.take<std::uint8_t>(),
                    parents = bytes.take<std::uint8_t>();
  mesh.lattice_vertices = bytes.take<std::uint32_t>();
  mesh.vertices = bytes.take_all<Vec3f>(vertices);
  mesh.tets = bytes.take_all<Tet>(tets);
  mesh.parents = bytes.take_all<Edge>(parents);
  mesh.densities = bytes.take_all<float>(vertices);
  mesh.tet_densities = bytes.take_all<float>(tets);
  mesh.levels = bytes.take_all<std::uint8_t>(tets);
  check_mesh(mesh);
  for (const Triangle& triangle : boundary_of(mesh.tets, mesh.vertices.size())) {
    for (const std::uint32_t v : triangle) require(v < mesh.vertices.size(), "beyond the vertices");
  }
}

void mesh_file(const std::uint8_t* data, std::size_t size) {
  static const int file = memfd_create("mesh", 0);
  require(file >= 0 && ftruncate(file, 0) == 0 &&
              pwrite(file, data, size, 0) == static_cast<ssize_t>(size),
          "no file in memory");
  // Only what carries the right hash gets as far as XML.
  read_mesh("/proc/self/fd/" + std::to_string(file), /*only_own=*/true);
}

void scene(const std::uint8_t* data, std::size_t size) {
  const SceneDescription scene = parse_scene({reinterpret_cast<const char*>(data), size});
  for (const ToolDescription& tool : scene.tools) {
    require(std::isfinite(tool.radius) && tool.radius > 0.0, "a tool without a size");
  }
}

void poses(const std::uint8_t* data, std::size_t size) {
  std::istringstream lines(std::string(reinterpret_cast<const char*>(data), size));
  const std::vector<StampedPose> path = parse_poses(lines, "poses.csv");
  require(!path.empty(), "no poses");
  for (const double time : {-1e300, 0.0, 0.5, 1e300}) {
    const ToolPose pose = pose_at(path, time);
    require(pose.position.allFinite() && pose.orientation.coeffs().allFinite(), "not finite");
  }
}

}  // namespace

const std::map<std::string, Target>& targets() {
  static const std::map<std::string, Target> all = {{"volume", volume},
                                                    {"mesh", mesh},
                                                    {"mesh_file", mesh_file},
                                                    {"scene", scene},
                                                    {"poses", poses}};
  return all;
}

}  // namespace tissue_fuzz
