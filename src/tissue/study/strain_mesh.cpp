#include "tissue/study/strain_mesh.h"

#include "tet_samples.h"
#include "tissue/base/error.h"
#include "tissue/base/stage_clock.h"
#include "tissue/simulate/scene_run.h"
#include "tissue/simulate/material_places.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tissue {
namespace {

// Of the budget: the pilot's tets, and the lattice's before refinement. Halving or doubling either
// changes errors by less than the place of the lattice does.
constexpr double kPilotPart = 0.25;
constexpr double kLatticePart = 0.5;
// Levels jump, so that not every total can be met.
constexpr double kTolerance = 0.002;
constexpr int kRounds = 30;
// What moves less is at rest, as a fraction of the body's size.
constexpr double kRounding = 1e-9;

double long_edge(double volume) { return std::cbrt(12.0 * volume); }

// What a pilot found out: how hard tissue is to get right, anywhere.
struct Pilot {
  Body body;
  std::vector<double> difficulty;

  std::vector<double> at(const std::vector<Vec3>& vertices, const std::vector<Tet>& tets) const {
    std::vector<Vec3> places;
    for (const Tet& tet : tets) {
      const auto samples = tet_samples(vertices, tet);
      places.insert(places.end(), samples.begin(), samples.end());
    }
    const std::vector<TetPlace> in_body = material_places(body, places);
    const std::size_t per_tet = places.size() / tets.size();
    std::vector<double> means(tets.size(), 0.0);
    for (std::size_t i = 0; i < in_body.size(); ++i) {
      means[i / per_tet] += difficulty[in_body[i].tet] / static_cast<double>(per_tet);
    }
    return means;
  }
};

Pilot run_pilot(const std::shared_ptr<const Volume>& volume, const ImplicitSurface& surface,
                const MeshOptions& options, const SceneMotion& motion, const Run& run) {
  MeshOptions coarse = options;
  coarse.method = Method::kUniform;
  coarse.spacing = 0.0;
  coarse.target_tetrahedra = 0;
  coarse.initial_tetrahedra = static_cast<std::uint32_t>(
      std::max(kPilotPart * static_cast<double>(options.target_tetrahedra), 100.0));
  const TetMesh mesh = build_mesh(volume, surface, coarse, run).mesh;
  const auto body = std::make_shared<const Body>(body_of(mesh));
  Scene scene(motion.scene, body, run.threads);
  const std::vector<double> young = young_of(motion.scene.material, *body);
  Pilot pilot = {*body, std::vector<double>(body->tets.size(), 0.0)};
  double farthest = 0.0;
  run_along(scene, motion.instants, [&](std::size_t) {
    run.go_on();
    const std::vector<double> now = strain_difficulty(*body, scene.state().positions, young);
    for (std::size_t t = 0; t < now.size(); ++t) pilot.difficulty[t] += now[t];
    for (std::size_t v = 0; v < body->rest.size(); ++v) {
      farthest =
          std::max(farthest, (scene.state().positions[v] - body->rest[v].cast<double>()).norm());
    }
  });
  if (farthest > kRounding * std::cbrt(mesh.statistics.volume)) return pilot;
  throw InputError(ErrorCode::kScene,
                   "scene: " + motion.scene.name + " strains nothing on a mesh of " +
                       std::to_string(body->tets.size()) + " tets; does its tool touch the organ?");
}

// With n tets for each unit of volume a place of difficulty g contributes g n^(−2/3) to the squared
// error: the least for a total of tets is reached where n goes with g^(3/5), and edges with
// g^(−1/5).
std::vector<std::uint8_t> wishes_for(const std::vector<double>& difficulty, double lattice_edge,
                                     double unit_edge, int finest) {
  std::vector<std::uint8_t> levels;
  for (const double g : difficulty) {
    const double edge = unit_edge * std::pow(std::max(g, 1e-300), -0.2);
    const double halvings = std::round(std::log2(lattice_edge / edge));
    levels.push_back(static_cast<std::uint8_t>(std::clamp(halvings, 0.0, double(finest))));
  }
  return levels;
}

}  // namespace

std::vector<double> strain_difficulty(const Body& body, const std::vector<Vec3>& positions,
                                      const std::vector<double>& young) {
  std::vector<Mat3> gradients(body.tets.size());
  std::vector<double> volumes(body.tets.size()), weights(body.rest.size(), 0.0);
  std::vector<Mat3> recovered(body.rest.size(), Mat3::Zero());
  for (std::size_t t = 0; t < body.tets.size(); ++t) {
    const Tet& tet = body.tets[t];
    Mat3 rest, now;
    for (int k = 0; k < 3; ++k) {
      rest.col(k) = (body.rest[tet[k + 1]] - body.rest[tet[0]]).cast<double>();
      now.col(k) = positions[tet[k + 1]] - positions[tet[0]];
    }
    volumes[t] = rest.determinant() / 6.0;
    gradients[t] = now * rest.inverse() - Mat3::Identity();
    for (const std::uint32_t v : tet) {
      recovered[v] += volumes[t] * gradients[t];
      weights[v] += volumes[t];
    }
  }
  for (std::size_t v = 0; v < recovered.size(); ++v) {
    if (weights[v] > 0.0) recovered[v] /= weights[v];
  }
  std::vector<double> difficulty;
  difficulty.reserve(body.tets.size());
  for (std::size_t t = 0; t < body.tets.size(); ++t) {
    // The mean over the tet of the square of what is linear in it.
    Mat3 sum = Mat3::Zero();
    double squares = 0.0;
    for (const std::uint32_t v : body.tets[t]) {
      const Mat3 error = recovered[v] - gradients[t];
      sum += error;
      squares += error.squaredNorm();
    }
    const double edge = long_edge(volumes[t]);
    difficulty.push_back(young[t] * (squares + sum.squaredNorm()) / 20.0 / (edge * edge));
  }
  return difficulty;
}

BuiltMesh build_strain_mesh(const std::shared_ptr<const Volume>& volume,
                            const ImplicitSurface& surface, const MeshOptions& options,
                            const SceneMotion& motion, const Run& run) {
  if (options.target_tetrahedra == 0) {
    throw InputError(ErrorCode::kParam,
                     "target_tetrahedra: 0; sizing by strain needs a total to share out");
  }
  StageClock clock;
  clock.start("pilot");
  run.enter({"pilot", 0.0, 0});
  const Pilot pilot = run_pilot(volume, surface, options, motion, run);

  clock.start("search");
  const auto wished = static_cast<double>(options.target_tetrahedra);
  MeshOptions sized = options;
  sized.method = Method::kWished;
  sized.target_tetrahedra = 0;
  // A guess may lie beyond a limit that the mesh to be found keeps.
  sized.max_tetrahedra *= 8;
  sized.spacing = std::cbrt(12.0 * voxel_volume_inside(surface) / (kLatticePart * wished));
  // The lattice stays the same, and so does how hard its tets are.
  std::vector<double> difficulty;
  double unit_edge = 0.0;
  sized.wishes = [&](const std::vector<Vec3>& vertices, const std::vector<Tet>& tets) {
    if (difficulty.size() != tets.size()) difficulty = pilot.at(vertices, tets);
    return wishes_for(difficulty, sized.spacing, unit_edge, options.levels.sections - 1);
  };
  // The larger the unit, the fewer tets; bisection on its logarithm.
  double low = std::log(sized.spacing) - 25.0, high = low + 50.0, nearest = high;
  double gap = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kRounds && gap > kTolerance; ++round) {
    run.enter({"search", 0.3, 0});
    const double middle = 0.5 * (low + high);
    unit_edge = std::exp(middle);
    const double ratio =
        static_cast<double>(planned_tetrahedra(volume, surface, sized, run)) / wished;
    if (std::abs(ratio - 1.0) < gap) {
      gap = std::abs(ratio - 1.0);
      nearest = middle;
    }
    (ratio > 1.0 ? low : high) = middle;
  }
  unit_edge = std::exp(nearest);
  clock.stop();
  sized.max_tetrahedra = options.max_tetrahedra;
  BuiltMesh built = build_mesh(volume, surface, sized, run);
  std::vector<StageCost>& stages = built.mesh.statistics.stages;
  stages.insert(stages.begin(), clock.stages().begin(), clock.stages().end());
  return built;
}

}  // namespace tissue
