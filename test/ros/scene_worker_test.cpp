// A scene in a thread of its own.
#include "ros/scene_worker.h"

#include "support/bodies.h"
#include "tissue/simulate/scene_file.h"

#include <gtest/gtest.h>

namespace {

using namespace tissue_ros;

tissue::Scene scene() {
  return {tissue::parse_scene("model: linear\nmaterial: {young: [[0, 3e3]]}\n"
                              "anchors: [{plane: {axis: z, below: 20%}}]\n"
                              "tools: [{name: finger, shape: {sphere: 0.006}, mode: press}]\n"
                              "effects: [contact, force_feedback]\n"),
          std::make_shared<tissue::Body>(tissue::body_of(tissue_test::refined_ball(0.024)))};
}

tissue::ToolSample finger(int i, double height) {
  return {0, 1000000LL * (1000 + i), tissue::ToolPose{tissue::Vec3(0.001, 0.0, 0.036 + height)}};
}

// Until it is so; the test's own time-out ends it where it never is.
template <class Condition>
void wait_for(const Condition& condition) {
  while (!condition()) std::this_thread::yield();
}

double farthest(SceneWorker& worker) {
  const auto view = worker.view();
  const auto& places = view->state.positions;
  double most = 0.0;
  for (std::size_t v = 0; v < places.size(); ++v) {
    most = std::max(most, (places[v] - worker.body().rest[v].cast<double>()).norm());
  }
  return most;
}

TEST(SceneWorker, TheNewestPoseWinsAndALostToolLetsGo) {
  SceneWorker worker(scene(), {}, {}, {});
  EXPECT_EQ(worker.progress()->steps, 1u);
  EXPECT_EQ(farthest(worker), 0.0);
  constexpr int kPoses = 2000;
  for (int i = 0; i < kPoses; ++i) {
    EXPECT_TRUE(worker.put(finger(i, 0.002 - 0.004 * i / kPoses)));
  }
  wait_for([&] { return worker.progress()->stamp == finger(kPoses - 1, 0.0).stamp; });
  const auto pressed = worker.progress();
  EXPECT_LE(pressed->steps, kPoses + 1u);
  ASSERT_TRUE(pressed->tissue[0]);
  EXPECT_GT(pressed->tissue[0]->force.z(), 0.0);
  EXPECT_TRUE(pressed->tissue[0]->compliance.allFinite());
  // (What is seen while a step runs is what was before it.)
  wait_for([&] { return farthest(worker) > 0.0005; });
  worker.lose(0);
  wait_for([&] { return !worker.progress()->tools[0]; });
  EXPECT_FALSE(worker.progress()->tissue[0]);
  wait_for([&] { return farthest(worker) < 1e-6; });
}

TEST(SceneWorker, P9_AToolThatFallsSilentDuringALongStepLetsGoAfterIt) {
  SceneWorker worker(scene(), {}, {}, {});
  worker.put(finger(0, -0.001));
  wait_for([&] { return worker.progress()->tools[0].has_value(); });
  // As while a step runs: its last pose and that it fell silent wait together.
  worker.pause(true);
  worker.put(finger(1, -0.001));
  worker.lose(0);
  worker.pause(false);
  wait_for([&] { return worker.progress()->steps >= 3; });
  EXPECT_FALSE(worker.progress()->tools[0].has_value());
  // One that has come back by then has let go in between.
  worker.put(finger(2, -0.001));
  wait_for([&] { return worker.progress()->stamp == finger(2, 0.0).stamp; });
  EXPECT_EQ(worker.progress()->steps, 4u);
  worker.pause(true);
  worker.lose(0);
  worker.put(finger(3, -0.001));
  worker.pause(false);
  wait_for([&] { return worker.progress()->stamp == finger(3, 0.0).stamp; });
  EXPECT_TRUE(worker.progress()->tools[0].has_value());
  EXPECT_EQ(worker.progress()->steps, 6u);
}

TEST(SceneWorker, AReplayUsesEveryPoseAndTellsWhenCloudsAreDue) {
  std::vector<std::int64_t> clouds;
  SceneWorkerOptions options;
  options.deterministic = true;
  constexpr int kPoses = 100;
  {
    SceneWorker worker(scene(), options,
                       [&](std::int64_t stamp, const tissue::Scene&) { clouds.push_back(stamp); },
                       {});
    for (int i = 0; i < kPoses; ++i) worker.put(finger(i, 0.001));
    wait_for([&] { return worker.progress()->steps == kPoses + 1u; });
  }
  // A tenth of a second at thirty a second.
  EXPECT_EQ(clouds.size(), 3u);
}

TEST(SceneWorker, WhatCannotBeDoneIsTold) {
  std::mutex mutex;
  std::string told;
  SceneWorker worker(scene(), {}, {}, [&](const std::string& sentence) {
    const std::lock_guard<std::mutex> lock(mutex);
    told = sentence;
  });
  worker.put(finger(0, -0.001));
  wait_for([&] { return worker.progress()->tissue[0].has_value(); });
  worker.put({0, finger(1, 0.0).stamp, tissue::ToolPose{tissue::Vec3(std::nan(""), 0.0, 0.0)}});
  wait_for([&] {
    const std::lock_guard<std::mutex> lock(mutex);
    return !told.empty();
  });
  // Nothing is felt on the word of a step before it, and it serves on.
  EXPECT_FALSE(worker.progress()->tissue[0].has_value());
  worker.put(finger(2, 0.001));
  wait_for([&] { return worker.progress()->stamp == finger(2, 0.0).stamp; });
}

TEST(SceneWorker, WhilePausedNothingMovesAndThenTheNewestPoseCounts) {
  SceneWorker worker(scene(), {}, {}, {});
  worker.pause(true);
  EXPECT_TRUE(worker.is_paused());
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(worker.put(finger(i, -0.001)));
  // A reset is done while paused; poses from before it are gone.
  worker.reset();
  EXPECT_EQ(worker.progress()->steps, 2u);
  EXPECT_EQ(farthest(worker), 0.0);
  for (int i = 10; i < 20; ++i) EXPECT_TRUE(worker.put(finger(i, -0.001)));
  worker.pause(false);
  wait_for([&] { return farthest(worker) > 0.0003; });
  EXPECT_EQ(worker.progress()->steps, 3u);
  EXPECT_EQ(worker.progress()->stamp, finger(19, 0.0).stamp);
}

TEST(SceneWorker, AReplayThatWasPausedLosesNothing) {
  SceneWorkerOptions options;
  options.deterministic = true;
  SceneWorker worker(scene(), options, [](std::int64_t, const tissue::Scene&) {}, {});
  worker.pause(true);
  constexpr int kPoses = 50;
  for (int i = 0; i < kPoses; ++i) worker.put(finger(i, -0.001));
  EXPECT_EQ(worker.progress()->steps, 1u);
  worker.pause(false);
  wait_for([&] { return worker.progress()->steps == kPoses + 1u; });
  wait_for([&] { return farthest(worker) > 0.0003; });
  worker.reset();
  EXPECT_EQ(farthest(worker), 0.0);
  // From the start again.
  for (int i = 0; i < kPoses; ++i) worker.put(finger(i, -0.001));
  wait_for([&] { return worker.progress()->steps == 2u * (kPoses + 1u); });
  wait_for([&] { return farthest(worker) > 0.0003; });
}

}  // namespace
