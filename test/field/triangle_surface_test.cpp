#include "tissue/field/triangle_surface.h"

#include "support/mesh_checks.h"
#include "support/shapes.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace {

using namespace tissue;
using tissue_test::refusal;

std::string temporary(const std::string& name) {
  return (std::filesystem::temp_directory_path() / name).string();
}

const tissue_test::Shape& ball() { return tissue_test::synthetic_shapes()[0]; }

TriangleSurface ball_surface() { return marching_cubes(surface_at_iso(ball().volume, ball().iso)); }

double volume_inside(const TriangleSurface& surface) {
  double sum = 0.0;
  for (const Triangle& t : surface.triangles) {
    sum += surface.vertices[t[0]].dot(surface.vertices[t[1]].cross(surface.vertices[t[2]]));
  }
  return std::abs(sum) / 6.0;
}

TEST(TriangleSurface, MarchingCubesEnclosesABallAndDecimationKeepsItsVolume) {
  const TriangleSurface surface = ball_surface();
  const double expected = 4.0 / 3.0 * M_PI * std::pow(24.3e-3, 3);
  EXPECT_NEAR(volume_inside(surface), expected, 0.005 * expected);
  const TriangleSurface fewer = decimated(surface, 0.25);
  EXPECT_NEAR(static_cast<double>(fewer.triangles.size()),
              0.25 * static_cast<double>(surface.triangles.size()),
              0.02 * static_cast<double>(surface.triangles.size()));
  EXPECT_NEAR(volume_inside(fewer), expected, 0.01 * expected);
  EXPECT_EQ(refusal([&] { decimated(surface, 0.0); }).substr(0, 7), "E_PARAM");
}

TEST(TriangleSurface, MarchingCubesClosesAnOrganAtTheBorderAndMakesNoTriangleWithoutAnArea) {
  // All solid, and values exactly on the iso value.
  const auto solid =
      tissue_test::byte_volume(12, [](double x, double, double) { return x < 6 ? 200.0 : 100.0; });
  for (const double iso : {50.0, 100.0}) {
    const TriangleSurface surface = marching_cubes(surface_at_iso(solid, iso));
    EXPECT_NO_THROW(surface_of_triangles(surface, solid->grid));
    for (const Triangle& t : surface.triangles) {
      const Vec3 a = surface.vertices[t[0]];
      EXPECT_GT((surface.vertices[t[1]] - a).cross(surface.vertices[t[2]] - a).norm(), 0.0);
    }
  }
}

TEST(TriangleSurface, EveryFormatComesBackAndBoundsTheOrganItCameFrom) {
  TriangleSurface surface = ball_surface();
  for (const std::string ending : {"ply", "stl", "vtp"}) {
    const std::string path = temporary("tissue_surface." + ending);
    write_surface(surface, path);
    const TriangleSurface read = read_surface(path);
    EXPECT_EQ(read.triangles.size(), surface.triangles.size()) << ending;
    const ImplicitSurface organ = surface_of_triangles(read, ball().volume->grid);
    with_implicit_function(organ, [&](const auto& f) {
      // Between the voxels the distance of a sphere is off by h²/(8 r).
      for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(-1, 2, 3)}) {
        const Vec3 place = Vec3::Constant(31.5e-3) + 24.8e-3 * direction.normalized();
        EXPECT_NEAR(f(place), 0.5e-3, 0.05e-3) << ending;
      }
    });
  }
}

TEST(TriangleSurface, ReadsObj) {
  const std::string path = temporary("tissue_surface.obj");
  std::ofstream(path) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                         "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  const TriangleSurface surface = read_surface(path);
  EXPECT_EQ(surface.triangles.size(), 4u);
  EXPECT_NEAR(volume_inside(surface), 1.0 / 6.0, 1e-6);
}

TEST(TriangleSurface, TakesMillimetresForWhatTheyAre) {
  TriangleSurface surface = ball_surface();
  const ImplicitSurface metres = surface_of_triangles(surface, ball().volume->grid);
  for (Vec3& vertex : surface.vertices) vertex *= 1000.0;
  const ImplicitSurface millimetres = surface_of_triangles(surface, ball().volume->grid);
  EXPECT_EQ(voxel_volume_inside(metres), voxel_volume_inside(millimetres));
}

TEST(TriangleSurface, RefusesWhatIsOpenOrElsewhereOrNoSurface) {
  TriangleSurface surface = ball_surface();
  for (Vec3& vertex : surface.vertices) vertex += Vec3(0.5, 0.0, 0.0);
  EXPECT_EQ(refusal([&] { surface_of_triangles(surface, ball().volume->grid); }).substr(0, 15),
            "E_EMPTY_SURFACE");
  surface = ball_surface();
  surface.triangles.pop_back();
  EXPECT_EQ(refusal([&] { surface_of_triangles(surface, ball().volume->grid); }),
            "E_CONFORMITY: surface: 3 open edges; it has to be closed");
  EXPECT_EQ(refusal([] { read_surface("/nowhere/x.stl"); }).substr(0, 6), "E_FILE");
  const std::string path = temporary("tissue_surface_bad.ply");
  for (const char* text : {"", "ply", "nonsense\n"}) {
    std::ofstream(path) << text;
    EXPECT_EQ(refusal([&] { read_surface(path); }).substr(0, 6), "E_FILE") << text;
  }
  EXPECT_EQ(refusal([&] { read_surface(temporary("tissue_surface.xyz")); }).substr(0, 6), "E_FILE");
  EXPECT_EQ(refusal([&] { write_surface(surface, temporary("x.doc")); }).substr(0, 7), "E_PARAM");
}

TEST(TriangleSurface, SelfIntersectionsStillBoundSomething) {
  // Two balls that overlap: counted by crossings, so that their common part is outside or inside,
  // but the sign is clean everywhere.
  TriangleSurface surface = ball_surface();
  const auto shift = static_cast<std::uint32_t>(surface.vertices.size());
  const std::size_t triangles = surface.triangles.size();
  for (std::uint32_t v = 0; v < shift; ++v) {
    surface.vertices.push_back(surface.vertices[v] + Vec3(0.004, 0.003, 0.002));
  }
  for (std::size_t t = 0; t < triangles; ++t) {
    const Triangle& c = surface.triangles[t];
    surface.triangles.push_back({c[0] + shift, c[1] + shift, c[2] + shift});
  }
  const ImplicitSurface organ = surface_of_triangles(surface, ball().volume->grid);
  EXPECT_GT(voxel_volume_inside(organ), 1e-6);
}

}  // namespace
