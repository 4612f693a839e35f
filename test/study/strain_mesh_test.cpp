#include "tissue/study/strain_mesh.h"

#include "support/mesh_checks.h"
#include "support/shapes.h"
#include "tissue/simulate/scene_file.h"
#include "tissue/simulate/material_places.h"
#include "tissue/study/tumour_wishes.h"

#include <random>

namespace {

using namespace tissue;
using tissue_test::refusal;

constexpr std::uint32_t kSize = 48;

// A block of 48 mm with rounded corners and a hard ball in its middle.
tissue_test::VolumePtr organ() {
  static const auto volume = tissue_test::organ_phantom({kSize, kSize, kSize});
  return volume;
}

// A finger presses on top, at the end of z.
SceneMotion pressed(const Vec3& at, double depth = 0.002) {
  SceneMotion motion;
  motion.scene = parse_scene(
      "model: linear\nmaterial: {young: [[0, 3e3]], poisson: 0.4}\n"
      "anchors: [{plane: {axis: z, below: 30%, stiffness: 1e6}}]\n"
      "tools: [{name: finger, shape: {pad: {radius: 0.008}}, mode: grasp}]\n");
  motion.instants = {{0.0, {ToolPose{at}}}, {0.1, {ToolPose{at - depth * Vec3::UnitZ()}}}};
  return motion;
}

MeshOptions asked_for(std::uint64_t tets) {
  MeshOptions options;
  options.iso_value = 20.0;
  options.target_tetrahedra = tets;
  return options;
}

Vec3 top_of(const TetMesh& mesh) {
  Vec3f top = mesh.vertices.front();
  for (const Vec3f& vertex : mesh.vertices) {
    if (vertex.z() > top.z()) top = vertex;
  }
  return top.cast<double>();
}

TetMesh uniform_mesh() {
  MeshOptions options = asked_for(0);
  options.method = Method::kUniform;
  options.initial_tetrahedra = 3000;
  return build_mesh(organ(), nullptr, options).mesh;
}

TEST(StrainMesh, MeetsTheTotalConformsAndIsFineUnderTheTool) {
  const Vec3 top = top_of(uniform_mesh());
  const ImplicitSurface surface = surface_at_iso(organ(), 20.0);
  const TetMesh mesh = build_strain_mesh(organ(), surface, asked_for(8000), pressed(top)).mesh;
  tissue_test::expect_conforming(mesh);
  EXPECT_NEAR(static_cast<double>(mesh.tets.size()), 8000.0, 0.02 * 8000.0);
  double near = 0.0, far = 0.0;
  int near_count = 0, far_count = 0;
  for (const Tet& tet : mesh.tets) {
    const Vec3 place = mesh.vertices[tet[0]].cast<double>();
    const double volume = determinant(mesh.vertices, tet);
    const double distance = (place - top).norm();
    (distance < 0.008 ? near : far) += distance < 0.008 || distance > 0.03 ? volume : 0.0;
    near_count += distance < 0.008;
    far_count += distance > 0.03;
  }
  EXPECT_LT(near / near_count, 0.25 * far / far_count);
  EXPECT_EQ(mesh.statistics.stages[0].name, "pilot");
}

TEST(StrainMesh, IsTheSameForAnyNumberOfThreads) {
  const Vec3 top = top_of(uniform_mesh());
  const ImplicitSurface surface = surface_at_iso(organ(), 20.0);
  const MeshOptions options = asked_for(4000);
  tissue::Run run;
  std::string uuid;
  for (const int threads : {1, 2, 5}) {
    run.threads = threads;
    const TetMesh mesh = build_strain_mesh(organ(), surface, options, pressed(top), run).mesh;
    EXPECT_TRUE(uuid.empty() || mesh.uuid == uuid) << threads;
    uuid = mesh.uuid;
  }
}

TEST(StrainMesh, SaysWhatItNeeds) {
  const ImplicitSurface surface = surface_at_iso(organ(), 20.0);
  EXPECT_EQ(
      refusal([&] { build_strain_mesh(organ(), surface, asked_for(0), pressed(Vec3::Zero())); }),
      "E_PARAM: target_tetrahedra: 0; sizing by strain needs a total to share out");
  // A tool far away.
  EXPECT_EQ(refusal([&] {
              build_strain_mesh(organ(), surface, asked_for(3000), pressed(Vec3(9, 9, 9)));
            }).substr(0, 27),
            "E_SCENE: scene: scene strai");
  MeshOptions wished = asked_for(3000);
  wished.method = Method::kWished;
  EXPECT_EQ(refusal([&] { build_mesh(organ(), surface, wished); }),
            "E_PARAM: method: strain needs a scene");
}

TEST(StrainMesh, WhatLinearTetsCanFollowIsNotDifficult) {
  const Body body = body_of(uniform_mesh());
  Mat3 gradient;
  gradient << 1.1, 0.02, 0.0, 0.01, 0.95, 0.03, 0.0, -0.04, 1.02;
  std::vector<Vec3> straight, bent;
  for (const Vec3f& rest : body.rest) {
    const Vec3 place = rest.cast<double>();
    straight.push_back(gradient * place + Vec3(0.01, 0.0, 0.0));
    bent.push_back(place + 5.0 * place.x() * place.x() * Vec3::UnitZ());
  }
  const std::vector<double> young(body.tets.size(), 3e3);
  double most = 0.0, sum = 0.0;
  for (const double g : strain_difficulty(body, straight, young)) most = std::max(most, g);
  for (const double g : strain_difficulty(body, bent, young)) sum += g;
  // E |d²u/dx²|² h²: its mean over the body does not depend on the tets' size.
  const double mean = sum / static_cast<double>(body.tets.size());
  EXPECT_LT(most, 1e-9 * mean);
  EXPECT_GT(mean, 0.001 * 3e3 * 100.0);
  EXPECT_LT(mean, 3e3 * 100.0);
}

TEST(StrainMesh, ExperimentsRefineTheBorderOfTheTumourOrAllElse) {
  const ImplicitSurface surface = surface_at_iso(organ(), 20.0);
  MeshOptions options = asked_for(0);
  options.method = Method::kWished;
  options.initial_tetrahedra = 3000;
  options.wishes = border_wishes(*organ(), surface, 230.0, 1);
  const TetMesh border = build_mesh(organ(), surface, options).mesh;
  options.wishes = tissue_wishes(*organ(), surface, 230.0, 1);
  const TetMesh tissue = build_mesh(organ(), surface, options).mesh;
  tissue_test::expect_conforming(border);
  tissue_test::expect_conforming(tissue);
  EXPECT_LT(border.tets.size(), tissue.tets.size());
  EXPECT_GT(border.statistics.levels[0], 10 * border.statistics.levels[1]);
  EXPECT_GT(tissue.statistics.levels[1], 10 * tissue.statistics.levels[0]);
  // The count is known before the mesh is made.
  EXPECT_EQ(planned_tetrahedra(organ(), surface, options), tissue.tets.size());
}

TEST(MaterialPlaces, FindsTheTetThatHoldsAPointAndGoesOnLinearlyOutside) {
  const Body body = body_of(uniform_mesh());
  std::mt19937 random(7);
  std::uniform_real_distribution<double> anywhere(0.0, 1.0);
  std::vector<Vec3> points;
  for (int i = 0; i < 300; ++i) {
    points.emplace_back(anywhere(random) * 0.05, anywhere(random) * 0.05, anywhere(random) * 0.05);
  }
  points.emplace_back(0.2, -0.1, 0.3);
  const std::vector<TetPlace> places = material_places(body, points);
  std::size_t inside = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Vec3 sum = Vec3::Zero();
    double least = 1.0;
    for (std::size_t k = 0; k < 4; ++k) {
      sum += places[i].barycentric[k] * body.rest[body.tets[places[i].tet][k]].cast<double>();
      least = std::min(least, places[i].barycentric[k]);
    }
    EXPECT_LE((sum - points[i]).norm(), 1e-9);
    if (least >= 0.0) ++inside;
    if (least >= 0.0) continue;
    // No tet holds it: all say so.
    for (const Tet& tet : body.tets) {
      Mat3 edges;
      for (int k = 0; k < 3; ++k) {
        edges.col(k) = (body.rest[tet[k + 1]] - body.rest[tet[0]]).cast<double>();
      }
      const Vec3 b = edges.inverse() * (points[i] - body.rest[tet[0]].cast<double>());
      ASSERT_TRUE(b.minCoeff() < 0.0 || b.sum() > 1.0);
    }
  }
  EXPECT_GT(inside, 100u);
  EXPECT_LT(inside, points.size());
}

}  // namespace
