#include "ros/point_file.h"

#include "tissue/base/error.h"
#include "tissue/base/atomic_file.h"

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

namespace tissue_ros {

void write_points(const tissue::TetMesh& mesh, const std::string& path) {
  pcl::PointCloud<pcl::PointXYZI> cloud;
  cloud.reserve(mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    pcl::PointXYZI point;
    point.getVector3fMap() = mesh.vertices[v];
    point.intensity = mesh.densities[v];
    cloud.push_back(point);
  }
  tissue::AtomicFile file(path);
  try {
    if (pcl::io::savePCDFileBinary(file.temporary(), cloud) == 0) return file.commit();
  } catch (const pcl::IOException&) {
    // Said below.
  }
  throw tissue::InputError(tissue::ErrorCode::kIo, "output: '" + path + "' cannot be written");
}

}  // namespace tissue_ros
