// Recorded poses: only they and their stamps decide what happens.
#include "support/mesh_checks.h"
#include "support/pressing_scenes.h"
#include "tissue/base/error.h"
#include "tissue/simulate/playback.h"

#include <random>
#include <tuple>

namespace {

using namespace tissue;
using tissue_test::Case;
using tissue_test::organ;

constexpr std::int64_t kMillisecond = 1000000;

const std::string kTwoFingers =
    "[{name: left, shape: {sphere: 0.006}, mode: press}, "
    "{name: right, shape: {sphere: 0.006}, mode: press}]";

// What a cloud holds, and when.
struct Cloud {
  std::int64_t stamp;
  std::vector<Vec3> places;
  bool operator==(const Cloud& other) const {
    return stamp == other.stamp && places == other.places;
  }
};

// Two fingers press from both sides and go back; the right one's clock is a little off, and in the
// middle it is silent for a while.
std::vector<ToolSample> recording(std::int64_t start = 5000 * kMillisecond) {
  std::vector<ToolSample> samples;
  for (int i = 0; i < 30; ++i) {
    const double depth = 0.0002 * std::min(i, 30 - i);
    for (const std::size_t tool : {0u, 1u}) {
      if (tool == 1 && i >= 12 && i < 24) continue;
      const double side = tool == 0 ? -1.0 : 1.0;
      samples.push_back(
          {tool, start + (20 * i + (i % 3 == 0 ? 0 : 3 * static_cast<int>(tool))) * kMillisecond,
           ToolPose{Vec3(side * (0.036 - depth), 0.0013, 0.0007)}});
    }
  }
  return samples;
}

Scene scene_of(const Case& which, int threads = 1) {
  return Scene(parse_scene(tissue_test::scene_text(which, kTwoFingers)), organ(), threads);
}

struct Played {
  std::vector<Cloud> clouds;
  std::size_t steps = 0, time_jumps = 0;
};

Played play(Scene scene, const std::vector<ToolSample>& samples, PlaybackOptions options = {}) {
  Played played;
  Playback playback(scene, options, [&](std::int64_t stamp) {
    played.clouds.push_back({stamp, scene.state().positions});
  });
  for (const ToolSample& sample : samples) playback.add(sample);
  playback.finish();
  played.steps = playback.steps();
  played.time_jumps = playback.time_jumps();
  return played;
}

// As they may arrive: those of each tool in order.
std::vector<ToolSample> shuffled(const std::vector<ToolSample>& samples, unsigned seed) {
  std::mt19937 generator(seed);
  std::vector<ToolSample> result = samples;
  for (int round = 0; round < 500; ++round) {
    const std::size_t i = generator() % (result.size() - 1);
    if (result[i].tool != result[i + 1].tool) std::swap(result[i], result[i + 1]);
  }
  return result;
}

TEST(Playback, HowPosesArriveAndHowManyThreadsThereAreDoesNotMatter) {
  for (const Case& which : {Case{"linear"}, Case{"corotational", 1, ", inertia, damping"}}) {
    const Played first = play(scene_of(which), recording());
    ASSERT_GT(first.clouds.size(), 10u);
    for (unsigned seed = 0; seed < 3; ++seed) {
      EXPECT_EQ(play(scene_of(which), shuffled(recording(), seed)).clouds, first.clouds)
          << which.name() << seed;
    }
    EXPECT_EQ(play(scene_of(which, 2), recording()).clouds, first.clouds) << which.name();
  }
}

TEST(Playback, EveryPoseIsUsedOnceAndWhatHasOneStampIsOneStep) {
  const std::vector<ToolSample> samples = recording();
  std::vector<std::int64_t> stamps;
  for (const ToolSample& sample : samples) stamps.push_back(sample.stamp);
  std::sort(stamps.begin(), stamps.end());
  const auto instants = std::unique(stamps.begin(), stamps.end()) - stamps.begin();
  // One more where the right finger is lost.
  EXPECT_EQ(play(scene_of({"linear"}), samples).steps, static_cast<std::size_t>(instants) + 1);
}

// A jaw that closes and opens on the way, heard of before or after the poses around it.
TEST(Playback, JawsCloseAtTheirStampsHoweverTheyArrive) {
  const std::string text = tissue_test::scene_text(
      {"linear"},
      "[{name: left, shape: {sphere: 0.006}, mode: press}, {name: forceps, shape: {sphere: 0.012}, "
      "mode: grasp, input: {jaw: forceps/jaw/measured_js}}]");
  std::vector<ToolSample> samples;
  for (int i = 0; i < 20; ++i) {
    const std::int64_t stamp = 20 * i * kMillisecond;
    samples.push_back({1, stamp, ToolPose{Vec3(0.0305 + 0.0003 * i, 0.0, 0.0)}});
    samples.push_back({1, stamp + kMillisecond, std::nullopt, i >= 5 && i < 15});
  }
  const auto played = [&](const std::vector<ToolSample>& order) {
    return play(Scene(parse_scene(text), organ()), order);
  };
  const Played first = played(samples);
  EXPECT_EQ(first.steps, 20u);
  const Vec3 rest = organ()->rest[0].cast<double>();
  const auto moves = [&](const Cloud& cloud) { return cloud.places[0] != rest; };
  EXPECT_FALSE(moves(first.clouds.front()));
  EXPECT_TRUE(std::any_of(first.clouds.begin(), first.clouds.end(), moves));
  // Jaws late, then early.
  // (Not by stable_sort, whose buffer is not aligned as poses ask for.)
  std::sort(samples.begin(), samples.end(), [](const ToolSample& a, const ToolSample& b) {
    const auto key = [](const ToolSample& sample) {
      return std::make_tuple(sample.stamp / (100 * kMillisecond), !sample.pose, sample.stamp);
    };
    return key(a) < key(b);
  });
  EXPECT_EQ(played(samples).clouds, first.clouds);
}

TEST(Playback, CloudsAreDueAtTheirRateAndTissueRelaxesInAGap) {
  std::vector<ToolSample> samples = recording();
  const std::int64_t end = samples.back().stamp;
  // A second later something comes again.
  samples.push_back({0, end + 1000 * kMillisecond, ToolPose{Vec3(-0.05, 0.0, 0.0)}});
  const Played played =
      play(scene_of({"corotational", 1, ", inertia, {damping: {mass: 50}}"}), samples);
  for (std::size_t i = 0; i + 1 < played.clouds.size(); ++i) {
    EXPECT_GE(played.clouds[i + 1].stamp - played.clouds[i].stamp, 33 * kMillisecond);
  }
  const auto in_gap =
      std::count_if(played.clouds.begin(), played.clouds.end(), [&](const Cloud& c) {
        return c.stamp > end + 100 * kMillisecond && c.stamp < end + 1000 * kMillisecond;
      });
  EXPECT_GT(in_gap, 3);
}

TEST(Playback, P3_WhereStampsFallBackTheTissueStartsAgain) {
  std::vector<ToolSample> twice = recording();
  const Played once = play(scene_of({"linear"}), twice);
  for (const ToolSample& sample : recording()) twice.push_back(sample);
  const Played both = play(scene_of({"linear"}), twice);
  EXPECT_EQ(both.time_jumps, 1u);
  ASSERT_EQ(both.clouds.size(), 2 * once.clouds.size());
  EXPECT_TRUE(std::equal(once.clouds.begin(), once.clouds.end(), both.clouds.begin()));
  EXPECT_TRUE(std::equal(once.clouds.begin(), once.clouds.end(),
                         both.clouds.begin() + static_cast<std::ptrdiff_t>(once.clouds.size())));
  // Also where linear systems are solved by iterations, which keep what serves them.
  const auto ball = std::make_shared<Body>(body_of(tissue_test::refined_ball(0.02)));
  const auto swinging = [&] {
    return Scene(
        parse_scene(tissue_test::scene_text({"corotational", 1, ", inertia"}, kTwoFingers)), ball);
  };
  std::vector<ToolSample> start = recording();
  start.resize(24);
  const std::size_t count = play(swinging(), start).clouds.size();
  const std::vector<ToolSample> again = start;
  start.insert(start.end(), again.begin(), again.end());
  const std::vector<Cloud> clouds = play(swinging(), start).clouds;
  ASSERT_EQ(clouds.size(), 2 * count);
  EXPECT_TRUE(std::equal(clouds.begin(), clouds.begin() + static_cast<std::ptrdiff_t>(count),
                         clouds.begin() + static_cast<std::ptrdiff_t>(count)));
  // Without a reset the tools are still there.
  PlaybackOptions options;
  options.reset_on_time_jump = false;
  EXPECT_EQ(play(scene_of({"linear"}), twice, options).time_jumps, 1u);
}

TEST(Playback, AToolThatSaysNothingIsNotWaitedForForEver) {
  Scene scene = scene_of({"linear"});
  Playback playback(scene, {}, {});
  for (int i = 0; i < 200; ++i) {
    playback.add({0, 10 * i * kMillisecond, ToolPose{Vec3(-0.0355, 0.0, 0.0)}});
  }
  // A second of stamps is a hundred poses.
  EXPECT_EQ(playback.steps(), 100u);
  playback.finish();
  EXPECT_EQ(playback.steps(), 200u);
}

TEST(Playback, WhatMakesNoSenseIsRefused) {
  Scene scene = scene_of({"linear"});
  EXPECT_EQ(tissue_test::refusal([&] {
              Playback(scene, {0.0, 30.0}, {});
            }),
            "E_PARAM: tool_timeout: 0 is not between 0 and 1e6");
  EXPECT_EQ(tissue_test::refusal([&] {
              Playback(scene, {0.1, 0.0}, {});
            }),
            "E_PARAM: cloud_rate: 0 is not between 0 and 1e6");
  Playback playback(scene, {}, {});
  EXPECT_EQ(tissue_test::refusal([&] {
              playback.add({2, 0, {}});
            }),
            "E_PARAM: tool 2 is none of the 2 of the scene");
  // The next pose finds everything as it was.
  playback.add({0, 0, ToolPose{Vec3(-0.05, 0.0, 0.0)}});
  playback.finish();
  playback.add({0, 10, ToolPose{Vec3(std::nan(""), 0.0, 0.0)}});
  EXPECT_THROW(playback.finish(), InputError);
  playback.add({0, 20, ToolPose{Vec3(-0.05, 0.0, 0.0)}});
  playback.finish();
  EXPECT_EQ(playback.steps(), 2u);
}

}  // namespace
