#include "tissue/simulate/scene.h"

#include "support/figures.h"
#include "support/mesh_checks.h"
#include "support/shapes.h"
#include "support/subjects.h"
#include "tissue/refine/build_mesh.h"
#include "tissue/simulate/fold_guard.h"
#include "tissue/simulate/surface_touch.h"

#include <cmath>
#include <limits>
#include <random>

namespace {

using namespace tissue;
using tissue_test::refusal;

// A soft ball of 24 mm radius with a hard core, fine outside and coarse inside.
std::shared_ptr<const Body> ball_body(double spacing) {
  const auto volume = tissue_test::byte_volume(64, [](double x, double y, double z) {
    const double d =
        std::sqrt(std::pow(x - 31.5, 2) + std::pow(y - 31.5, 2) + std::pow(z - 31.5, 2));
    return d < 9.0 ? 255.0 : d < 24.5 ? 60.0 + 2.0 * (24.5 - d) : 0.0;
  });
  MeshOptions options;
  options.iso_value = 30.0;
  options.spacing = spacing;
  options.levels.sections = 2;
  return std::make_shared<Body>(body_of(build_mesh(volume, nullptr, options).mesh));
}

SceneDescription with_all_effects() {
  SceneDescription scene;
  scene.push.range = 0.03;
  scene.effects = {DensityResponseOptions{}, RecoveryOptions{0.2}, FoldGuardOptions{}};
  scene.tools[0].radius = 0.002;
  return scene;
}

const Vec3 kTop(31.5e-3, 31.5e-3, 57.0e-3);  // 0.9 mm or so above the ball's north pole

ToolPose at(const Vec3& position, std::optional<bool> closed = std::nullopt) {
  return {position, closed};
}

TEST(Scene, TheTargetFollowsTheToolAndATumourMovesLessThanSoftTissue) {
  const auto body = ball_body(0.006);
  Scene scene(with_all_effects(), body);
  scene.step(at(kTop), 0.0);
  const StepReport report = scene.step(at(kTop - Vec3(0, 0, 0.004)), 0.01);
  EXPECT_FALSE(report.clamped);
  EXPECT_GT(report.moved_vertices, 100u);
  const std::uint32_t target = *SurfaceTouch(*body).target(kTop, 0.002);
  const auto moved_by = [&](std::uint32_t v) {
    return (scene.state().positions[v] - body->rest[v].cast<double>()).norm();
  };
  EXPECT_NEAR(moved_by(target), 0.004, 1e-9);
  // Vertices at equal distances from the target, inside the hard core and beside it.
  double hard = 0.0, soft = 0.0;
  int n_hard = 0, n_soft = 0;
  for (std::uint32_t v = 0; v < body->rest.size(); ++v) {
    const double d = (body->rest[v] - body->rest[target]).norm();
    if (d < 0.017 || d > 0.023) continue;
    if (body->densities[v] > 250.0f) hard += moved_by(v), ++n_hard;
    if (body->densities[v] < 100.0f) soft += moved_by(v), ++n_soft;
  }
  ASSERT_GT(n_hard, 3);
  ASSERT_GT(n_soft, 3);
  EXPECT_LT(hard / n_hard, 0.5 * soft / n_soft);
}

TEST(Scene, ReleaseEndsInTheBitExactRestShape) {
  const auto body = ball_body(0.008);
  Scene scene(with_all_effects(), body);
  scene.step(at(kTop), 0.0);
  scene.step(at(kTop - Vec3(0.001, 0.002, 0.005)), 0.01);
  EXPECT_NE(scene.state().positions, rest_state(*body).positions);
  scene.step(std::nullopt, 0.05);
  EXPECT_TRUE(scene.recovering());
  for (int i = 0; i < 4; ++i) scene.step(std::nullopt, 0.05);
  EXPECT_FALSE(scene.recovering());
  EXPECT_EQ(scene.state().positions, rest_state(*body).positions);
}

TEST(Scene, TissueStaysWhereItWasLeftWithoutRecovery) {
  SceneDescription description = with_all_effects();
  description.effects = {DensityResponseOptions{}, FoldGuardOptions{}};
  Scene scene(description, ball_body(0.008));
  scene.step(at(kTop), 0.0);
  scene.step(at(kTop - Vec3(0, 0, 0.005)), 0.01);
  const std::vector<Vec3> held = scene.state().positions;
  scene.step(std::nullopt, 10.0);
  EXPECT_EQ(scene.state().positions, held);
  scene.reset();
  EXPECT_EQ(scene.state().positions, rest_state(scene.body()).positions);
}

TEST(Scene, P7_LetsGoBeyondTheRange) {
  SceneDescription description = with_all_effects();
  description.push.range = 0.01;
  Scene scene(description, ball_body(0.008));
  scene.step(at(kTop), 0.0);
  EXPECT_GT(scene.step(at(kTop - Vec3(0, 0, 0.008)), 0.01).moved_vertices, 0u);
  scene.step(at(kTop - Vec3(0, 0, 0.0205)), 0.01);
  EXPECT_TRUE(scene.recovering());
  scene.step(at(kTop - Vec3(0, 0, 0.0205)), 1.0);
  EXPECT_EQ(scene.state().positions, rest_state(scene.body()).positions);
}

TEST(Scene, GraspsOnlyWhenTheJawCloses) {
  SceneDescription description = with_all_effects();
  description.tools[0].grasps = true;
  const auto body = ball_body(0.008);
  Scene scene(description, body);
  scene.step(at(kTop, false), 0.0);
  EXPECT_EQ(scene.step(at(kTop - Vec3(0, 0, 0.001), false), 0.01).moved_vertices, 0u);
  EXPECT_GT(scene.step(at(kTop, true), 0.01).moved_vertices, 0u);
  scene.step(at(kTop + Vec3(0, 0, 0.004), true), 0.01);
  EXPECT_NE(scene.state().positions, rest_state(*body).positions);
  scene.step(at(kTop + Vec3(0, 0, 0.004), false), 0.01);
  EXPECT_TRUE(scene.recovering());
}

TEST(Scene, P8_ATouchWithoutMotionMovesNothing) {
  const auto body = ball_body(0.008);
  Scene scene(with_all_effects(), body);
  for (int i = 0; i < 5; ++i) {
    EXPECT_GT(scene.step(at(kTop), 0.01).moved_vertices, 0u);  // It is held all the same.
  }
  EXPECT_EQ(scene.state().positions, rest_state(*body).positions);
}

TEST(Scene, T3_APathThatReturnsToItsStartLeavesNothingBehind) {
  for (const tissue_test::Subject& subject : tissue_test::subjects()) {
    Scene scene(with_all_effects(), subject.body);
    const Vec3 top = tissue_test::top_of(subject);
    std::mt19937 random(2);
    std::normal_distribution<> step(0.0, 0.001);
    scene.step(at(top), 0.0);
    Vec3 offset = Vec3::Zero();
    for (int i = 0; i < 500; ++i) {
      offset = 0.95 * offset + Vec3(step(random), step(random), step(random));
      scene.step(at(top + offset), 0.001);
      ASSERT_NE(scene.state().positions, rest_state(*subject.body).positions) << subject.name;
    }
    scene.step(at(top), 0.001);
    EXPECT_EQ(scene.state().positions, rest_state(*subject.body).positions) << subject.name;
  }
}

TEST(Scene, RiseTimeBringsTheTissueUpSmoothly) {
  SceneDescription description = with_all_effects();
  description.rise_time = 1.0;
  const auto body = ball_body(0.008);
  const std::uint32_t target = *SurfaceTouch(*body).target(kTop, 0.002);
  Scene scene(description, body);
  scene.step(at(kTop), 0.0);
  scene.step(at(kTop - Vec3(0, 0, 0.004)), 0.5);
  const auto moved = [&] {
    return (scene.state().positions[target] - body->rest[target].cast<double>()).norm();
  };
  EXPECT_NEAR(moved(), 0.25 * 0.004, 1e-9);
  scene.step(at(kTop - Vec3(0, 0, 0.004)), 0.7);
  EXPECT_NEAR(moved(), 0.004, 1e-9);
}

TEST(Scene, EffectsThatAreNotNamedCostNothing) {
  const auto body = ball_body(0.008);
  Scene bare(SceneDescription{}, body);
  bare.step(at(kTop), 0.0);
  EXPECT_TRUE(bare.effect_costs().empty());
  Scene full(with_all_effects(), body);
  full.step(at(kTop), 0.0);
  ASSERT_EQ(full.effect_costs().size(), 3u);
  for (const EffectCost& cost : full.effect_costs()) {
    EXPECT_EQ(cost.bytes > 0, cost.name == "fold_guard");
  }
}

TEST(Scene, RefusesTimeStepsAndPosesThatAreNone) {
  Scene scene(with_all_effects(), ball_body(0.008));
  scene.step(at(kTop), 0.0);
  scene.step(at(kTop - Vec3(0, 0, 0.003)), 0.01);
  const std::vector<Vec3> held = scene.state().positions;
  for (const double dt : {-0.1, std::nan(""), HUGE_VAL}) {
    EXPECT_EQ(refusal([&] { scene.step(at(kTop), dt); }).substr(0, 4), "E_DT") << dt;
  }
  EXPECT_EQ(refusal([&] { scene.step(at(Vec3(0, std::nan(""), 0)), 0.1); }).substr(0, 11),
            "E_NONFINITE");
  EXPECT_EQ(scene.state().positions, held);
}

State pushed_state(const Body& body, const PushField<float>& field, const Vec3& displacement) {
  State state = rest_state(body);
  displace<float>(body.rest, field, displacement.cast<float>(), state.positions);
  return state;
}

TEST(FoldGuard, T1_NoTetFoldsInAHundredThousandPushesAndOneDoesJustBeyondTheLimit) {
  std::mt19937 random(9);
  std::uniform_real_distribution<float> density(1.0f, 255.0f);
  std::uniform_real_distribution<> amplitude(0.0, 1.0), range(0.01, 0.06);
  std::normal_distribution<> component;
  std::size_t clamped = 0;
  for (const tissue_test::Subject& subject : tissue_test::subjects()) {
    Body body = *subject.body;
    for (int grasp = 0; grasp < 250; ++grasp) {
      for (float& value : body.densities) value = density(random);
      const auto& triangle = body.surface[random() % body.surface.size()];
      const PushField<float> field = push_field<float>(body.rest, body.densities, triangle[0],
                                                       {range(random), true, 0.0, false});
      const FoldGuard guard(body, field);
      for (int push = 0; push < 200; ++push) {
        const Vec3 n = Vec3(component(random), component(random), component(random)).normalized();
        const double wished = amplitude(random), limit = guard.limit(n);
        clamped += wished > 0.999 * limit;
        const State state = pushed_state(body, field, std::min(wished, 0.999 * limit) * n);
        const DeformationQuality quality = deformation_quality(body, state);
        ASSERT_EQ(quality.inverted, 0u);
        ASSERT_TRUE(std::isfinite(quality.min_det_f));
        if (push == 0 && std::isfinite(limit)) {
          const State folded = pushed_state(body, field, 1.001 * limit * n);
          ASSERT_GE(deformation_quality(body, folded).inverted, 1u);
        }
      }
    }
  }
  EXPECT_GT(clamped, 50000u);
  tissue_test::figure("pushes of 100,000 at their limit", static_cast<double>(clamped));
}

TEST(FoldGuard, TheSceneClampsAndSaysSo) {
  SceneDescription description = with_all_effects();
  const auto body = ball_body(0.008);
  Scene guarded(description, body);
  description.effects.pop_back();
  Scene unguarded(description, body);
  for (Scene* scene : {&guarded, &unguarded}) scene->step(at(kTop), 0.0);
  const Vec3 deep = kTop - Vec3(0, 0, 0.029);
  EXPECT_TRUE(guarded.step(at(deep), 0.01).clamped);
  EXPECT_EQ(deformation_quality(*body, guarded.state()).inverted, 0u);
  EXPECT_FALSE(unguarded.step(at(deep), 0.01).clamped);
  EXPECT_GT(deformation_quality(*body, unguarded.state()).inverted, 0u);
}

TEST(SurfaceTouch, FindsTheNearestVertexWithinReachOfTheSurface) {
  const auto body = ball_body(0.008);
  const SurfaceTouch touch(*body);
  EXPECT_FALSE(touch.target(kTop + Vec3(0, 0, 0.01), 0.002));
  EXPECT_FALSE(touch.target(Vec3::Constant(31.5e-3), 0.002));
  // Over the middle of a triangle whose corners are all farther away than the radius.
  const Triangle& triangle = body->surface[0];
  Vec3 middle = Vec3::Zero();
  double nearest = 1.0;
  for (const std::uint32_t v : triangle) middle += body->rest[v].cast<double>() / 3.0;
  for (const std::uint32_t v : triangle) {
    nearest = std::min(nearest, (body->rest[v].cast<double>() - middle).norm());
  }
  EXPECT_TRUE(touch.target(middle, 0.1 * nearest));
}

TEST(DistanceToTriangle, KnowsItsCornersEdgesAndFace) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  EXPECT_NEAR(distance_to_triangle({0.2, 0.2, 3}, a, b, c), 3.0, 1e-12);
  EXPECT_NEAR(distance_to_triangle({-3, -4, 0}, a, b, c), 5.0, 1e-12);
  EXPECT_NEAR(distance_to_triangle({0.5, -2, 0}, a, b, c), 2.0, 1e-12);
  EXPECT_NEAR(distance_to_triangle({1, 1, 0}, a, b, c), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(distance_to_triangle({4, -4, 0}, a, b, c), 5.0, 1e-12);
}

}  // namespace
