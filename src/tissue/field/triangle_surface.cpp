#include "tissue/field/triangle_surface.h"

#include "poly_data.h"
#include "tissue/base/error.h"

#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkImageStencilData.h>
#include <vtkMarchingCubes.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataToImageStencil.h>
#include <vtkDecimatePro.h>
#include <vtkSmartPointer.h>
#include <vtkStaticCellLocator.h>

#include <algorithm>
#include <cmath>

namespace tissue {
namespace {

// Every edge belongs to an even number of triangles: two, or where sheets touch four.
void require_closed(const TriangleSurface& surface) {
  std::vector<Edge> edges;
  for (const Triangle& triangle : surface.triangles) {
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = triangle[i], b = triangle[(i + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(edges.begin(), edges.end());
  std::size_t open = 0;
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end] == edges[begin]) ++end;
    open += (end - begin) % 2;
  }
  if (open == 0) return;
  throw InputError(ErrorCode::kConformity,
                   "surface: " + std::to_string(open) + " open edges; it has to be closed");
}

// 1 for every voxel whose centre lies inside; `poly` is in the grid's frame.
std::vector<std::uint8_t> voxels_inside(vtkPolyData* poly, const Grid& grid) {
  vtkNew<vtkPolyDataToImageStencil> stencil;
  stencil->SetInputData(poly);
  stencil->SetOutputSpacing(grid.spacing.data());
  stencil->SetOutputOrigin(0.0, 0.0, 0.0);
  stencil->SetOutputWholeExtent(0, static_cast<int>(grid.size[0]) - 1, 0,
                                static_cast<int>(grid.size[1]) - 1, 0,
                                static_cast<int>(grid.size[2]) - 1);
  stencil->Update();
  vtkImageStencilData* data = stencil->GetOutput();
  std::vector<std::uint8_t> inside(grid.voxel_count(), 0);
  for (int z = 0; z < static_cast<int>(grid.size[2]); ++z) {
    for (int y = 0; y < static_cast<int>(grid.size[1]); ++y) {
      int first = 0, last = 0, iteration = 0;
      while (data->GetNextExtent(first, last, 0, static_cast<int>(grid.size[0]) - 1, y, z,
                                 iteration) != 0) {
        const std::size_t row = grid.size[0] * (y + std::size_t{grid.size[1]} * z);
        std::fill(inside.begin() + static_cast<std::ptrdiff_t>(row + first),
                  inside.begin() + static_cast<std::ptrdiff_t>(row + last + 1), std::uint8_t{1});
      }
    }
  }
  return inside;
}

// The corners of all cells that the surface crosses, and the voxels around them.
std::vector<std::uint8_t> next_to_border(const std::vector<std::uint8_t>& inside,
                                         const Grid& grid) {
  std::vector<std::uint8_t> result(inside.size(), 0);
  const std::array<std::ptrdiff_t, 3> size = {grid.size[0], grid.size[1], grid.size[2]};
  const auto index = [&](std::ptrdiff_t x, std::ptrdiff_t y, std::ptrdiff_t z) {
    return static_cast<std::size_t>(x + size[0] * (y + size[1] * z));
  };
  const auto is_crossed = [&](std::ptrdiff_t x, std::ptrdiff_t y, std::ptrdiff_t z) {
    int sum = 0;
    for (int i = 0; i < 8; ++i) sum += inside[index(x + (i & 1), y + (i >> 1 & 1), z + (i >> 2))];
    return sum != 0 && sum != 8;
  };
  for (std::ptrdiff_t z = 0; z + 1 < size[2]; ++z) {
    for (std::ptrdiff_t y = 0; y + 1 < size[1]; ++y) {
      for (std::ptrdiff_t x = 0; x + 1 < size[0]; ++x) {
        if (!is_crossed(x, y, z)) continue;
        for (std::ptrdiff_t c = std::max(z - 1, std::ptrdiff_t{0}); c < std::min(z + 3, size[2]);
             ++c) {
          for (std::ptrdiff_t b = std::max(y - 1, std::ptrdiff_t{0}); b < std::min(y + 3, size[1]);
               ++b) {
            const std::ptrdiff_t first = std::max(x - 1, std::ptrdiff_t{0});
            const std::ptrdiff_t last = std::min(x + 3, size[0]);
            std::fill_n(result.begin() + static_cast<std::ptrdiff_t>(index(first, b, c)),
                        last - first, std::uint8_t{1});
          }
        }
      }
    }
  }
  return result;
}

double extent_of(const std::vector<Vec3>& places) {
  Eigen::AlignedBox3d box;
  for (const Vec3& place : places) box.extend(place);
  return box.diagonal().norm();
}

}  // namespace

ImplicitSurface surface_of_triangles(TriangleSurface surface, const Grid& grid) {
  constexpr double kSurelyMillimetres = 30.0;
  const Vec3 extent = Vec3(grid.size[0], grid.size[1], grid.size[2]).cwiseProduct(grid.spacing);
  const double unit = extent_of(surface.vertices) > kSurelyMillimetres * extent.norm() ? 1e-3 : 1.0;
  for (Vec3& vertex : surface.vertices) vertex = grid.to_grid(unit * vertex);
  require_closed(surface);
  const PolyData poly = poly_of(surface);

  const std::vector<std::uint8_t> inside = voxels_inside(poly, grid);
  const std::vector<std::uint8_t> near = next_to_border(inside, grid);
  if (std::find(inside.begin(), inside.end(), 1) == inside.end()) {
    throw InputError(ErrorCode::kEmptySurface,
                     "surface: no voxel of the volume lies inside; it is " +
                         to_text(extent_of(surface.vertices)) + " m across");
  }
  vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(poly);
  locator->BuildLocator();
  // Beyond the cells that the surface crosses only the sign counts.
  const double far = extent.norm();
  auto distance = std::make_shared<Volume>();
  distance->grid = grid;
  std::vector<float> values(inside.size());
  for (std::size_t i = 0; i < inside.size(); ++i) {
    double to_surface = 2.0 * grid.spacing.maxCoeff();
    if (near[i] != 0) {
      const std::size_t yz = i / grid.size[0];
      Vec3 place =
          Vec3(static_cast<double>(i % grid.size[0]), static_cast<double>(yz % grid.size[1]),
               static_cast<double>(yz / grid.size[1]))
              .cwiseProduct(grid.spacing);
      Vec3 closest;
      vtkIdType cell = 0;
      int sub = 0;
      double squared = 0.0;
      if (locator->FindClosestPointWithinRadius(place.data(), far, closest.data(), cell, sub,
                                                squared) != 0) {
        to_surface = std::sqrt(squared);
      }
    }
    values[i] = static_cast<float>(inside[i] != 0 ? -to_surface : to_surface);
  }
  distance->voxels = std::move(values);
  return {distance, 0.0, false, value_range(*distance)};
}

TriangleSurface marching_cubes(const ImplicitSurface& surface) {
  const Volume& field = *surface.field;
  // A layer around the volume closes an organ that touches the border.
  vtkNew<vtkImageData> image;
  const auto& size = field.grid.size;
  image->SetDimensions(static_cast<int>(size[0]) + 2, static_cast<int>(size[1]) + 2,
                       static_cast<int>(size[2]) + 2);
  image->SetSpacing(field.grid.spacing.data());
  const Vec3 origin = -field.grid.spacing;
  image->SetOrigin(origin.data());
  image->AllocateScalars(VTK_FLOAT, 1);
  auto* values = static_cast<float*>(image->GetScalarPointer());
  // As far beyond the iso value as the innermost value is on this side.
  const double innermost = surface.range[surface.inside_above ? 1 : 0];
  const auto outside = static_cast<float>(2.0 * surface.iso - innermost);
  std::visit(
      [&](const auto& voxels) {
        std::size_t next = 0;
        for (std::uint32_t z = 0; z < size[2] + 2; ++z) {
          for (std::uint32_t y = 0; y < size[1] + 2; ++y) {
            for (std::uint32_t x = 0; x < size[0] + 2; ++x) {
              const bool margin =
                  x == 0 || y == 0 || z == 0 || x > size[0] || y > size[1] || z > size[2];
              *values = outside;
              if (!margin) {
                *values = static_cast<float>(field.slope * static_cast<double>(voxels[next++]) +
                                             field.intercept);
              }
              ++values;
            }
          }
        }
      },
      field.voxels);
  vtkNew<vtkMarchingCubes> contour;
  contour->SetInputData(image);
  // Exactly on a value of the voxels triangles would have no area.
  const double range = surface.range[1] - surface.range[0];
  contour->SetValue(0, surface.iso + 1e-6 * (range > 0.0 ? range : 1.0));
  contour->ComputeNormalsOff();
  contour->ComputeScalarsOff();
  contour->Update();
  TriangleSurface result = surface_from(contour->GetOutput());
  for (Vec3& vertex : result.vertices) vertex = field.grid.to_world(vertex);
  return result;
}

TriangleSurface decimated(const TriangleSurface& surface, double keep) {
  if (!(keep > 0.0 && keep <= 1.0)) {
    throw InputError(ErrorCode::kParam, "decimate: " + to_text(keep) + " is not within 0 to 1");
  }
  vtkNew<vtkDecimatePro> decimation;
  decimation->SetInputData(poly_of(surface));
  decimation->SetTargetReduction(1.0 - keep);
  decimation->PreserveTopologyOn();
  decimation->Update();
  return surface_from(decimation->GetOutput());
}

}  // namespace tissue
