#include "tissue/field/surface_distance.h"

#include "tissue/base/parallel.h"
#include "tissue/base/topology.h"
#include "tissue/field/surface_search.h"

namespace tissue {
namespace {

// Distances are good to this fraction of a voxel where the surface is near, a tenth of what counts
// as astray.
constexpr double kAccuracy = 0.01;

}  // namespace

SurfaceDistance surface_distance(const ImplicitSurface& surface, const std::vector<Vec3f>& vertices,
                                 const std::vector<Triangle>& boundary, double reach,
                                 const Run& run) {
  const std::vector<std::uint32_t> wanted = vertices_of(boundary, vertices.size());
  const double voxel = surface.field->grid.spacing.minCoeff();
  std::vector<float> distances(wanted.size());
  with_implicit_function(surface, [&](const auto& f) {
    parallel_ranges(wanted.size(), 256, run, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Vec3 place = vertices[wanted[i]].template cast<double>();
        distances[i] =
            static_cast<float>(search_surface(f, place, voxel, reach, kAccuracy).distance);
      }
    });
  });
  SurfaceDistance result;
  result.vertices = wanted.size();
  double sum = 0.0;
  for (const float distance : distances) {
    sum += static_cast<double>(distance);
    result.max = std::max(result.max, static_cast<double>(distance));
    result.astray += static_cast<double>(distance) > 0.1 * voxel;
  }
  if (!wanted.empty()) result.mean = sum / static_cast<double>(wanted.size());
  return result;
}

}  // namespace tissue
