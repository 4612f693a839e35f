#include "support/bodies.h"
#include "tissue/simulate/material_places.h"
#include "tissue/simulate/scene_file.h"

#include <gtest/gtest.h>

namespace {

using namespace tissue;

TEST(ProbePoints, AreWhereQuadraticElementsSay) {
  Body bent = tissue_test::kuhn_block({4, 2, 2}, {0.06, 0.03, 0.03});
  bent.tet_densities.assign(bent.tets.size(), 200.0f);
  bent.tet_densities[7] = 10.0f;
  const auto body = std::make_shared<const Body>(bent);
  Scene scene(parse_scene("model: neo_hookean\nelement_order: 2\n"
                          "material: {young: [[0, 5e3]], poisson: 0.4}\n"
                          "anchors: [{plane: {axis: x, below: 10%}}]\n"
                          "tools: [{name: tool, shape: {sphere: 0.012}, mode: grasp}]\n"
                          "probes: {most: {density_above: 100}, inside: [0.041, 0.012, 0.017], "
                          "outside: [0.041, 0.012, 0.031], none: {density_above: 300}}\n"),
              body);
  const Vec3 end(0.06, 0.015, 0.015);
  scene.step(ToolPose{end, true}, 0.0);
  scene.step(ToolPose{end - Vec3(0.0, 0.0, 0.01), true}, 0.01);
  const auto probes = scene.probes();
  EXPECT_FALSE(probes.at("outside") || probes.at("none"));

  const TetPlace inside = material_places(*body, {Vec3(0.041, 0.012, 0.017)}).front();
  EXPECT_LE((*probes.at("inside") - scene.places({inside}).front()).norm(), 1e-12);
  Vec3 straight = Vec3::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    straight += inside.barycentric[k] * scene.state().positions[body->tets[inside.tet][k]];
  }
  EXPECT_GT((*probes.at("inside") - straight).norm(), 1e-5);

  // The integral of a quadratic over a tet, from its corners and the midpoints of its edges.
  Vec3 sum = Vec3::Zero();
  double total = 0.0;
  for (std::uint32_t t = 0; t < body->tets.size(); ++t) {
    if (t == 7) continue;
    const double volume = determinant(body->rest, body->tets[t]);
    total += volume;
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a; b < 4; ++b) {
        TetPlace place{t, {0.0, 0.0, 0.0, 0.0}};
        place.barycentric[a] += 0.5;
        place.barycentric[b] += 0.5;
        sum += volume * (a == b ? -0.05 : 0.2) * scene.places({place}).front();
      }
    }
  }
  EXPECT_LE((*probes.at("most") - sum / total).norm(), 1e-12);
}

}  // namespace
