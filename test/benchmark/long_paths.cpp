// Many random poses through every model, on a small block or a refined ball with a hard core: what
// comes out, and whether each step that went wrong said so. scripts/long_paths
#include "support/bodies.h"
#include "tissue/simulate/scene.h"
#include "tissue/simulate/scene_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace tissue;

struct Path {
  std::string name, model, effects, mode;
  // How far from its first touch the tool gets [m].
  double reach;
};

// Models without a barrier may fold where they are moved far; how far each is moved is printed.
const std::vector<Path> kPaths = {
    {"closed_form", "closed_form", "recovery: {time: 0.05}, fold_guard", "press", 0.015},
    {"mass_spring", "mass_spring", "", "grasp", 0.004},
    {"linear", "linear", "", "grasp", 0.004},
    {"corotational", "corotational", "", "grasp", 0.004},
    {"neo_hookean", "neo_hookean", "", "grasp", 0.004},
    {"corotational, swinging", "corotational", "inertia, damping", "grasp", 0.004},
    {"neo_hookean, swinging", "neo_hookean", "inertia, damping", "grasp", 0.004},
    {"linear, pressed", "linear", "contact", "press", 0.004},
    {"neo_hookean, pressed", "neo_hookean", "contact", "press", 0.004},
};

std::string scene_text(const Path& path) {
  // One effect a line: a name, or a name and its parameters.
  std::string effects = "effects:\n  - density_response\n";
  for (std::size_t begin = 0; begin < path.effects.size();) {
    const std::size_t end = std::min(path.effects.find(", ", begin), path.effects.size());
    effects += "  - " + path.effects.substr(begin, end - begin) + "\n";
    begin = end + 2;
  }
  std::string text = "model: " + path.model +
                     "\ntools: [{name: tool, shape: {sphere: 0.008}, mode: " + path.mode + "}]\n";
  if (path.model == "closed_form") {
    text += "range: 0.02\n";
  } else {
    text +=
        "material: {young: [[0, 1e3], [130, 1e3], [131, 1e5], [255, 1e5]], poisson: 0.45, "
        "mass_density: 1000}\n"
        "anchors: [{plane: {axis: z, below: 20%}}]\nsolver: {tolerance: 1e-6, max_iterations: "
        "30}\n";
  }
  return text + effects;
}

// A tool over the top of the ball: it wanders, jumps, is lost and comes again.
class Wanderer {
 public:
  Wanderer(double reach, const Vec3& start) : reach_(reach), start_(start) {}

  std::optional<ToolPose> next() {
    if (chance() < 0.002) lost_ = 5;
    if (lost_ > 0) {
      --lost_;
      offset_.setZero();
      return std::nullopt;
    }
    const Vec3 random(2.0 * chance() - 1.0, 2.0 * chance() - 1.0, 2.0 * chance() - 1.0);
    offset_ = chance() < 0.01 ? Vec3(reach_ * random) : Vec3(offset_ + 0.2 * reach_ * random);
    if (offset_.norm() > reach_) offset_ *= reach_ / offset_.norm();
    return ToolPose{start_ + offset_};
  }

 private:
  double chance() { return std::uniform_real_distribution<double>()(generator_); }

  double reach_;
  Vec3 start_;
  int lost_ = 0;
  Vec3 offset_ = Vec3::Zero();
  std::mt19937_64 generator_{1};
};

struct Outcome {
  std::size_t not_converged = 0, clamped = 0, folded = 0, unsaid = 0;
  double early_energy = 0.0, late_energy = 0.0, farthest = 0.0;
};

// A body whose core is a hundred times as stiff, and where its top is.
struct Case {
  std::string name;
  std::shared_ptr<const Body> body;
  Vec3 top;
};

Case small_block() {
  Body block = tissue_test::kuhn_block({3, 3, 3}, Vec3::Constant(0.045));
  block.densities.assign(block.rest.size(), 60.0f);
  // The cube in the middle.
  block = tissue_test::with_core(std::move(block), Vec3::Constant(0.0225), 0.008, 255.0f, 60.0f);
  return {"uniform block", std::make_shared<const Body>(block), Vec3(0.015, 0.015, 0.045)};
}

Case refined_ball() {
  Body ball = tissue_test::ball_body(tissue_test::refined_ball(0.02, 2), 0.010, 255.0f, 60.0f);
  return {"refined ball", std::make_shared<const Body>(ball), Vec3(0.0, 0.0, 0.030)};
}

Outcome run(const Path& path, const Case& which, std::size_t steps) {
  const Body& body = *which.body;
  Scene scene(parse_scene(scene_text(path)), which.body);
  const double above = path.mode == "grasp" ? 0.0 : 0.007;
  Wanderer wanderer(path.reach, which.top + Vec3(0.0, 0.0, above));
  Outcome outcome;
  for (std::size_t i = 0; i < steps; ++i) {
    const StepReport report = scene.step(wanderer.next(), 0.002);
    outcome.not_converged += report.not_converged;
    outcome.clamped += report.clamped;
    bool finite = true;
    const bool inverted = deformation_quality(body, scene.state()).inverted > 0;
    const std::vector<Vec3>& places = scene.state().positions;
    for (std::size_t v = 0; v < places.size(); ++v) {
      finite = finite && places[v].allFinite();
      outcome.farthest =
          std::max(outcome.farthest, (places[v] - body.rest[v].cast<double>()).norm());
    }
    outcome.folded += inverted;
    outcome.unsaid += !finite || (inverted && !report.not_converged && !report.folded);
    if (!report.energy) continue;
    if (!std::isfinite(*report.energy)) ++outcome.unsaid;
    double& most = i < steps / 10 ? outcome.early_energy : outcome.late_energy;
    most = std::max(most, *report.energy);
  }
  return outcome;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string wish = argc > 1 ? argv[1] : "";
  const std::size_t steps = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 0;
  if ((wish != "block" && wish != "ball") || steps < 10) {
    std::fprintf(stderr, "usage: long_paths block|ball STEPS [PATH ...], at least 10 steps\n");
    return 2;
  }
  const Case which = wish == "block" ? small_block() : refined_ball();
  std::printf(
      "A %s of %zu tets, %zu vertices, its core a hundred times as stiff; %zu random poses through "
      "each.\n\n"
      "| path | reach [mm] | not converged | clamped | folded, as it said | not finite, or folded "
      "and unsaid | "
      "most energy in the first tenth, later [mJ] | moved [mm] | step [us] |\n"
      "|---|---|---|---|---|---|---|---|---|\n",
      which.name.c_str(), which.body->tets.size(), which.body->rest.size(), steps);
  bool good = true;
  for (const Path& path : kPaths) {
    bool wished = argc <= 3;
    for (int i = 3; i < argc; ++i) wished = wished || path.name == argv[i];
    if (!wished) continue;
    const std::clock_t begin = std::clock();
    const Outcome o = run(path, which, steps);
    const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    std::printf("| %s | %.0f | %zu | %zu | %zu | %zu | %.3g, %.3g | %.1f | %.1f |\n",
                path.name.c_str(), 1e3 * path.reach, o.not_converged, o.clamped, o.folded, o.unsaid,
                1e3 * o.early_energy, 1e3 * o.late_energy, 1e3 * o.farthest,
                1e6 * seconds / static_cast<double>(steps));
    std::fflush(stdout);
    good = good && o.unsaid == 0;
  }
  return good ? 0 : 1;
}
