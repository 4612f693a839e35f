// Forces for a hand, between steps.
#include "support/mesh_checks.h"
#include "support/pressing_scenes.h"
#include "tissue/simulate/force_loop.h"

#include <deque>

namespace {

using namespace tissue;
using tissue_test::above;
using tissue_test::kRadius;
using tissue_test::organ;
using tissue_test::refusal;

constexpr double kSample = 1e-3;

// A wall at z = 0 that pushes upwards.
LocalTissue wall(double stiffness) {
  LocalTissue tissue;
  tissue.compliance = Mat3::Identity() / stiffness;
  tissue.force = Vec3(0.0, 0.0, 1e-9);
  return tissue;
}

// A device of 100 g that nothing brakes; its forces reach it so many samples late.
struct Device {
  explicit Device(int delay) : forces(static_cast<std::size_t>(delay), Vec3::Zero()) {}
  void move(const Vec3& answer) {
    forces.push_back(answer);
    const Vec3 force = forces.front();
    forces.pop_front();
    const Vec3 acceleration = force / kMass;
    position += kSample * velocity + 0.5 * kSample * kSample * acceleration;
    velocity += kSample * acceleration;
  }
  double energy() const { return 0.5 * kMass * velocity.squaredNorm(); }

  static constexpr double kMass = 0.1;
  Vec3 position = Vec3::Zero(), velocity = Vec3::Zero();
  std::deque<Vec3> forces;
};

TEST(ForceLoop, IsTheSpringThatTheStepFoundWithinItsLimits) {
  ForceLoop loop({2.0, 100.0});
  LocalTissue tissue;
  tissue.position = Vec3(0.01, 0.0, 0.03);
  tissue.force = Vec3(0.0, 0.0, 0.5);
  tissue.compliance = Vec3(0.01, 0.01, 0.002).asDiagonal();
  loop.set_tissue(tissue);
  const double long_ago = 1.0;
  EXPECT_LE((loop.force_at(tissue.position, long_ago) - tissue.force).norm(), 1e-12);
  // A millimetre deeper.
  EXPECT_NEAR(loop.force_at(tissue.position - Vec3(0.0, 0.0, 1e-3), kSample).z(), 0.6, 1e-12)
      << "rises by no more than a tenth of a newton in a sample";
  EXPECT_NEAR(loop.force_at(tissue.position - Vec3(0.0, 0.0, 1e-3), long_ago).z(), 1.0, 1e-12);
  EXPECT_NEAR(loop.force_at(tissue.position - Vec3(0.0, 0.0, 0.1), long_ago).norm(), 2.0, 1e-12);
  // Where tissue would have to pull there is none, but for a tool that holds it.
  loop.stop();
  EXPECT_EQ(loop.force_at(tissue.position, long_ago), Vec3(Vec3::Zero()));
  loop.set_tissue(tissue);
  EXPECT_EQ(loop.force_at(tissue.position + Vec3(0.0, 0.0, 0.002), long_ago), Vec3(Vec3::Zero()));
  tissue.pulls = true;
  loop.set_tissue(tissue);
  EXPECT_NEAR(loop.force_at(tissue.position + Vec3(0.0, 0.0, 0.002), long_ago).z(), -0.5, 1e-12);
  // Nothing at all is nothing, and so is what is not finite.
  loop.stop();
  loop.set_tissue(std::nullopt);
  EXPECT_EQ(loop.force_at(tissue.position, long_ago).norm(), 0.0);
  tissue.compliance(0, 0) = std::nan("");
  loop.set_tissue(tissue);
  EXPECT_TRUE(loop.force_at(Vec3::Zero(), long_ago).allFinite());
  EXPECT_EQ(refusal([] {
              ForceLoop({0.0, 1.0});
            }),
            "E_PARAM: max_force: 0 is not a positive number");
}

// What a spring of that stiffness alone makes of a device that is thrown at it.
double plain_gain(double stiffness, int delay) {
  Device device(delay);
  device.position = Vec3(0.0, 0.0, 0.001);
  device.velocity = Vec3(0.0, 0.0, -0.1);
  const double before = device.energy();
  for (int i = 0; i < 2000 && device.position.z() < 0.002; ++i) {
    const double depth = -device.position.z();
    device.move(Vec3(0.0, 0.0, depth > 0.0 ? stiffness * depth : 0.0));
  }
  return device.energy() / before;
}

TEST(ForceLoop, ADeviceThrownAtAStiffWallGainsNoEnergy) {
  for (const double stiffness : {300.0, 1000.0, 3000.0}) {
    for (const int delay : {0, 1, 2}) {
      Device device(delay);
      device.position = Vec3(0.0, 0.0, 0.001);
      device.velocity = Vec3(0.0, 0.0, -0.1);
      const double before = device.energy();
      ForceLoop loop({100.0, 1e6});
      loop.set_tissue(wall(stiffness));
      for (int i = 0; i < 2000; ++i) {
        device.move(loop.force_at(device.position, kSample));
      }
      std::printf("%g N/m, %d late: %.3f of its energy is left; a spring alone leaves %.3f\n",
                  stiffness, delay, device.energy() / before, plain_gain(stiffness, delay));
      EXPECT_LE(device.energy(), before * (1.0 + 1e-9)) << stiffness << " N/m, late by " << delay;
      EXPECT_GT(plain_gain(stiffness, delay), 1.0);
    }
  }
}

// The device falls on an organ whose steps come thirty times a second, and late.
TEST(ForceLoop, ADeviceThrownAtAStiffTumourGainsNoEnergyThoughStepsAreSlow) {
  constexpr int kSamplesPerStep = 33;
  for (const char* hard : {"60e3", "6e6"}) {
    for (const char* more : {"", ", inertia, damping"}) {
      Scene scene(
          parse_scene(std::string("model: corotational\nmaterial: {young: [[58, 3e3], [80, ") +
                      hard +
                      "]], poisson: 0.45}\nanchors: [{plane: {axis: z, below: 20%}}]\ntools: " +
                      tissue_test::kFinger +
                      "\neffects: [density_response, contact, force_feedback" + more + "]\n"),
          organ());
      Device device(1);
      device.position = above(0.001).position;
      device.velocity = Vec3(0.0, 0.0, -0.1);
      const double before = device.energy();
      ForceLoop loop({});
      std::optional<LocalTissue> found;
      double hardest = 0.0, most = 0.0;
      for (int i = 0; i < 500; ++i) {
        if (i % kSamplesPerStep == 0) {
          // What the step before found.
          loop.set_tissue(found);
          scene.step(ToolPose{device.position}, kSamplesPerStep * kSample);
          const std::optional<ToolFeedback> felt = scene.tool_feedback()[0];
          found.reset();
          if (felt) found = LocalTissue{device.position, felt->wrench.force, felt->compliance};
        }
        const Vec3 force = loop.force_at(device.position, kSample);
        hardest = std::max(hardest, force.norm());
        device.move(force);
        ASSERT_TRUE(device.position.allFinite());
        most = std::max(most, device.energy());
      }
      std::printf(
          "tumour of %s Pa%s: %.3f of its energy is left after up to %.2f N, at most %.3f\n", hard,
          more, device.energy() / before, hardest, most / before);
      EXPECT_LE(most, before * (1.0 + 1e-3)) << hard << more;
      EXPECT_GT(hardest, 0.01) << hard << more;
    }
  }
}

}  // namespace
