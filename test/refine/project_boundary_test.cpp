#include "tissue/refine/project_boundary.h"

#include "support/mesh_checks.h"
#include "support/shapes.h"
#include "tissue/field/mask.h"
#include "tissue/refine/build_mesh.h"

#include <cmath>

namespace {

using namespace tissue;
using tissue_test::Shape;

constexpr double kVoxel = 1e-3;

MeshStatistics meshed(const Shape& shape, double spacing, const ProjectionOptions& projection) {
  MeshOptions options;
  options.iso_value = shape.iso;
  options.spacing = spacing;
  options.projection = projection;
  const TetMesh mesh = build_mesh(shape.volume, nullptr, options).mesh;
  tissue_test::expect_conforming(mesh);
  EXPECT_GE(mesh.statistics.dihedral[0] * 180.0 / M_PI, 8.0);
  EXPECT_LE(mesh.statistics.dihedral[1] * 180.0 / M_PI, 168.0);
  return mesh.statistics;
}

TEST(ProjectBoundary, BringsABallAndATorusOntoTheirSurface) {
  for (const int shape : {0, 1}) {
    const MeshStatistics found = meshed(tissue_test::synthetic_shapes()[shape], 4 * kVoxel, {});
    EXPECT_LE(found.surface_error[0], 0.001 * kVoxel);
    EXPECT_LE(found.surface_error[1], 0.1 * kVoxel);
    EXPECT_EQ(found.boundary_vertices_astray, 0u);
  }
}

// Organs as scans give them: the mask above the iso value, opened and smoothed.
Shape smoothed_organ(const Shape& raw, double sigma) {
  const Volume mask = open_mask(threshold_mask(*raw.volume, raw.iso), 2);
  return {raw.name, std::make_shared<Volume>(smooth_mask(mask, sigma)), 127.5};
}

TEST(ProjectBoundary, BringsSmoothedOrgansOntoTheirSurface) {
  for (const Shape& raw : tissue_test::real_volumes()) {
    SCOPED_TRACE(raw.name);
    // What is narrower than the lattice cannot be reached: the CT's sulci are cut out to the voxel
    // and take more smoothing.
    const Shape organ = smoothed_organ(raw, raw.name.rfind("invesalius", 0) == 0 ? 4.0 : 2.5);
    const double voxel = organ.volume->grid.spacing.minCoeff();
    const MeshStatistics found = meshed(organ, 6.5 * voxel, {});
    EXPECT_LE(found.surface_error[0], 0.01 * voxel);
    EXPECT_LE(static_cast<double>(found.boundary_vertices_astray),
              0.02 * static_cast<double>(found.boundary_vertices));
  }
}

TEST(ProjectBoundary, FollowingBringsInWhatSweepsAloneDoNot) {
  const Shape organ = smoothed_organ({"ch2bet", tissue_test::shipped_brain(), 20.0}, 2.5);
  const MeshStatistics four = meshed(organ, 6.5 * kVoxel, {4, 0}),
                       six = meshed(organ, 6.5 * kVoxel, {});
  EXPECT_LT(six.boundary_vertices_astray, four.boundary_vertices_astray);
  EXPECT_LT(six.surface_error[0], four.surface_error[0]);
}

TEST(ProjectBoundary, NeverTurnsATetInsideOut) {
  // The surface cuts through between the base and the apex of a tet: moving all the way would fold
  // it, since the base stays where it is.
  const auto volume = tissue_test::float_volume(
      20, [](double, double, double z) { return 100.0 + 10.0 * (9.0 - z); });
  std::vector<Vec3f> vertices = {{0.005f, 0.005f, 0.010f},
                                 {0.012f, 0.005f, 0.010f},
                                 {0.008f, 0.012f, 0.010f},
                                 {0.008f, 0.007f, 0.014f}};
  const std::vector<Vec3f> before = vertices;
  // The base belongs to no boundary triangle, so that only the apex may move.
  const auto moved = project_boundary(surface_at_iso(volume, 100.0), vertices, {{0, 1, 2, 3}},
                                      {{3, 3, 3}}, {{0, 1}}, 0.01, {4, 0}, {});
  for (int v = 0; v < 3; ++v) EXPECT_EQ(vertices[v], before[v]);
  EXPECT_EQ(moved, (std::vector<std::uint8_t>{0, 0, 0, 1}));
  EXPECT_LT(vertices[3].z(), 0.014f);
  EXPECT_GT(vertices[3].z(), 0.010f);
}

}  // namespace
