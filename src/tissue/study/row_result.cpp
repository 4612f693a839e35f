#include "tissue/study/row_result.h"

#include "tissue/base/error.h"
#include "tissue/base/peak_memory.h"
#include "tissue/base/topology.h"
#include "tissue/field/mask.h"
#include "tissue/field/read_volume.h"
#include "tissue/simulate/scene_run.h"
#include "tissue/study/leave_out.h"
#include "tissue/simulate/material_places.h"
#include "tissue/study/tumour_wishes.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>
#include <numeric>

namespace tissue {
namespace {

constexpr std::size_t kInstants = 4;
// A reference is solved until nothing of it is the solver's.
constexpr double kReferenceTolerance = 1e-5;

TetMesh mesh_for(const StudyProblem& problem, const std::shared_ptr<const Volume>& volume,
                 const ImplicitSurface& surface, const StudyMesh& mesh, const StudyRow& row,
                 double tumour_above, const Run& run) {
  MeshOptions options = mesh.options;
  options.target_tetrahedra = row.tetrahedra;
  if (options.method == Method::kWished && mesh.wishes == Wishes::kStrain) {
    return build_strain_mesh(volume, surface, options, problem.motion, run).mesh;
  }
  const int finest = options.levels.sections - 1;
  if (mesh.wishes == Wishes::kBorder) {
    options.wishes = border_wishes(*volume, surface, tumour_above, finest);
  } else if (mesh.wishes == Wishes::kTissue) {
    options.wishes = tissue_wishes(*volume, surface, tumour_above, finest);
  }
  return build_mesh(volume, surface, options, run).mesh;
}

ImplicitSurface surface_for(const StudyProblem& problem,
                            const std::shared_ptr<const Volume>& volume) {
  if (problem.smoothing == 0.0) return surface_at_iso(volume, problem.iso_value);
  return surface_of_mask(std::make_shared<Volume>(
      smooth_mask(threshold_mask(*volume, problem.iso_value), problem.smoothing)));
}

// The scene as the row wants it.
SceneDescription scene_for(const StudyProblem& problem, const StudyRow& row, const Body& body) {
  SceneDescription scene = problem.motion.scene;
  scene.model = row.model;
  scene.element_order = row.element_order;
  if (row.purpose == RowPurpose::kReference || row.purpose == RowPurpose::kCheck) {
    scene.solver.tolerance = std::min(scene.solver.tolerance, kReferenceTolerance);
  }
  for (const Effect& effect : scene.effects) {
    if (can_have(row.model, effect.name())) continue;
    throw InputError(ErrorCode::kScene, std::string("model ") + name(row.model) +
                                            " cannot have the effect " + effect.name());
  }
  return row.without ? leave_out(scene, *row.without, body) : scene;
}

// Whether anything is to move between one instant and the one before.
bool moves(const std::vector<Instant>& instants, std::size_t i, bool swings) {
  if (i == 0 || swings) return i > 0;
  const ToolPoses &now = instants[i].tools, &before = instants[i - 1].tools;
  for (std::size_t k = 0; k < now.size(); ++k) {
    if (now[k] && before[k] &&
        (now[k]->position != before[k]->position ||
         now[k]->orientation.coeffs() != before[k]->orientation.coeffs())) {
      return true;
    }
  }
  return false;
}

// In per cent.
double volume_change(const Scene& scene) {
  const Body& body = scene.body();
  const std::vector<TetStrain> strains = scene.strains();
  const std::vector<Vec3>& now = scene.state().positions;
  double before = 0.0, after = 0.0;
  for (std::size_t t = 0; t < body.tets.size(); ++t) {
    const Tet& tet = body.tets[t];
    const double rest = determinant(body.rest, tet);
    before += rest;
    after += strains.empty() ? determinant(now, tet) : rest * strains[t].det_f;
  }
  return 100.0 * (after / before - 1.0);
}

// Takes down what a row is measured by.
class Recorder {
 public:
  Recorder(const SamplePoints& points, const Body& body)
      : points_(points),
        organ_(material_places(body, points.organ)),
        tumour_(material_places(body, points.tumour)) {}

  void take(const Scene& scene, RowResult& result) const {
    const std::vector<Vec3> now = scene.places(organ_);
    for (std::size_t i = 0; i < now.size(); ++i) {
      result.displacements.push_back(now[i] - points_.organ[i]);
    }
    Vec3 sum = Vec3::Zero();
    const std::vector<Vec3> tumour = scene.places(tumour_);
    for (std::size_t i = 0; i < tumour.size(); ++i) sum += tumour[i] - points_.tumour[i];
    result.tumour.push_back(sum / static_cast<double>(tumour.size()));
    Vec3 force = Vec3::Zero();
    bool known = false;
    for (const std::optional<Vec3>& on_tool : scene.tool_forces()) {
      if (!on_tool) continue;
      force += *on_tool;
      known = true;
    }
    if (known) result.force.push_back(force);
  }

 private:
  const SamplePoints& points_;
  std::vector<TetPlace> organ_, tumour_;
};

void simulate(const Study& study, const StudyRow& row, const SamplePoints& points,
              const TetMesh& mesh, RowResult& result) {
  const StudyProblem& problem = study.problems[row.problem];
  const auto body = std::make_shared<const Body>(body_of(mesh));
  const Recorder recorder(points, *body);
  const SceneDescription description = scene_for(problem, row, *body);
  const std::vector<Instant>& instants = problem.motion.instants;
  const PeakMemory memory;
  const auto start = std::chrono::steady_clock::now();
  Scene scene(description, body, study.threads);
  const double making =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const RunRecord record = run_along(scene, instants, [&](std::size_t done) {
    const std::size_t wanted = std::min(kInstants, instants.size());
    for (std::size_t k = 1; k <= wanted; ++k) {
      if (done == (k * instants.size() + wanted - 1) / wanted) recorder.take(scene, result);
    }
  });
  result.bytes = memory.bytes();
  result.setup_seconds = making + record.seconds.front();
  result.run_seconds = std::accumulate(record.seconds.begin(), record.seconds.end(), making);
  result.effects = scene.effect_costs();
  std::vector<double> seconds;
  const bool swings = description.has<InertiaOptions>() || description.has<RecoveryOptions>();
  for (std::size_t i = 0; i < instants.size(); ++i) {
    if (moves(instants, i, swings)) seconds.push_back(record.seconds[i]);
  }
  if (seconds.empty()) seconds = record.seconds;
  result.steps = seconds.size();
  result.step_median = percentile(seconds, 0.5);
  result.step_p99 = percentile(seconds, 0.99);
  result.iterations = record.last.iterations;
  result.solver = record.last.solver;
  result.volume_change = volume_change(scene);
  const DeformationQuality quality = deformation_quality(*body, scene.state());
  result.min_det_f = quality.min_det_f;
  result.inverted = quality.inverted;
  if (record.not_converged > 0) {
    result.failure = "NOT_CONVERGED in " + std::to_string(record.not_converged) +
                     " steps, residual of the last " + to_text(record.last.residual);
  }
}

void run_or_throw(const Study& study, const StudyRow& row, const Run& run, RowResult& result) {
  const StudyProblem& problem = study.problems[row.problem];
  auto volume = std::make_shared<Volume>(read_volume(problem.volume));
  for (const Tumour& tumour : problem.tumours) insert_tumour(*volume, tumour);
  const ImplicitSurface surface = surface_for(problem, volume);
  if (problem.tissue) {
    volume = std::make_shared<Volume>(*volume);
    fill_volume(*volume, *problem.tissue);
    for (const Tumour& tumour : problem.tumours) insert_tumour(*volume, tumour);
  }
  const SamplePoints points = sample_points(*volume, surface, study.points);
  const TetMesh mesh = mesh_for(problem, volume, surface, study.meshes[row.mesh], row,
                                study.points.tumour_above, run);
  for (const StageCost& stage : mesh.statistics.stages) {
    if (stage.name != "search") result.meshing_seconds += stage.cpu_seconds;
  }
  result.tetrahedra = mesh.tets.size();
  result.vertices = result.nodes = mesh.vertices.size();
  if (row.element_order == 2) {
    result.nodes += edge_topology(mesh.tets, mesh.vertices.size()).edges.size();
  }
  simulate(study, row, points, mesh, result);
}

}  // namespace

RowResult run_row(const Study& study, const StudyRow& row, const Run& run) {
  RowResult result;
  Run on_threads = run;
  on_threads.threads = study.threads;
  try {
    run_or_throw(study, row, on_threads, result);
  } catch (const InputError& error) {
    result.failure = std::string(name(error.code())) + ": " + error.what();
  } catch (const std::bad_alloc&) {
    result.failure = "E_NOMEM: out of memory";
  }
  return result;
}

}  // namespace tissue
