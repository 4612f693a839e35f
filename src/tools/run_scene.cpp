// Runs a scene on a mesh file, without ROS.
#include "program.h"
#include "tissue/base/error.h"
#include "tissue/base/mesh_file.h"
#include "tissue/simulate/scene_file.h"
#include "tissue/simulate/scene_run.h"

#ifdef TISSUE_WITH_BAGS
#include "bag_run.h"
#endif

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace {

namespace po = boost::program_options;
using tissue::ErrorCode;
using tissue::InputError;

struct Arguments {
  std::string scene, mesh, output, stats, bag, cloud_bag;
  double cloud_rate = 30.0;
  std::vector<std::string> paths;
  int threads = 1;
};

po::options_description options() {
  po::options_description all(
      "run_scene SCENE.yaml --mesh IN.vtu [--path [TOOL=]POSES.csv ...] -o OUT.vtu\n"
      "Moves a mesh as a scene says: one equilibrium without poses, one step per pose with them.\n"
      "example: run_scene config/scenes/sag.yaml --mesh brain.vtu -o sagged.vtu\n");
  all.add_options()("scene", po::value<std::string>(), "scene file")(
      "mesh", po::value<std::string>(), "VTU file of tets [m]")(
      "path", po::value<std::vector<std::string>>()->composing(),
      "poses t,x,y,z,qx,qy,qz,qw[,grip] of a tool (s, m); of the first without a name")(
      "threads", po::value<int>()->default_value(1), "threads; the result is the same")(
#ifdef TISSUE_WITH_BAGS
      "bag", po::value<std::string>(), "bag with what the tools said, on the scene's topics")(
      "cloud-bag", po::value<std::string>(), "bag for the clouds that deformer_node would publish")(
      "cloud-rate", po::value<double>()->default_value(30.0), "clouds per second of stamps")(
#endif
      "output,o", po::value<std::string>(), "VTU file: the mesh at rest with its displacement")(
      "stats", po::value<std::string>(), "JSON file of figures")("help,h", "show this");
  return all;
}

Arguments arguments_from(const po::variables_map& given) {
  Arguments arguments;
  arguments.scene = tissue_tools::required(given, "scene");
  arguments.mesh = tissue_tools::required(given, "mesh");
  arguments.output = tissue_tools::required(given, "output");
  if (given.count("stats") != 0) arguments.stats = given["stats"].as<std::string>();
  if (given.count("path") != 0) arguments.paths = given["path"].as<std::vector<std::string>>();
  if (given.count("bag") != 0) arguments.bag = given["bag"].as<std::string>();
  if (given.count("cloud-bag") != 0) arguments.cloud_bag = given["cloud-bag"].as<std::string>();
  if (given.count("cloud-rate") != 0) arguments.cloud_rate = given["cloud-rate"].as<double>();
  if (!arguments.bag.empty() && !arguments.paths.empty()) {
    throw InputError(ErrorCode::kParam, "--bag: the tools have paths already, from --path");
  }
  if (!arguments.cloud_bag.empty() && arguments.bag.empty()) {
    throw InputError(ErrorCode::kParam, "--cloud-bag: clouds have the stamps of a --bag");
  }
  arguments.threads = given["threads"].as<int>();
  if (arguments.threads < 1 || arguments.threads > 1024) {
    throw InputError(ErrorCode::kParam, "--threads: " + std::to_string(arguments.threads) +
                                            " is not within 1 to 1024");
  }
  return arguments;
}

nlohmann::json triple(const tissue::Vec3& v) { return {v.x(), v.y(), v.z()}; }

// What tools feel, by their names; nothing without the effect force_feedback.
nlohmann::json feedback_of(const tissue::Scene& scene) {
  nlohmann::json result = nlohmann::json::object();
  const auto feedback = scene.tool_feedback();
  for (std::size_t i = 0; i < feedback.size(); ++i) {
    if (!feedback[i]) continue;
    const tissue::Mat3& c = feedback[i]->compliance;
    result[scene.description().tools[i].name] = {
        {"force_n", triple(feedback[i]->wrench.force)},
        {"torque_nm", triple(feedback[i]->wrench.torque)},
        {"compliance_m_per_n", {triple(c.row(0)), triple(c.row(1)), triple(c.row(2))}}};
  }
  return result;
}

nlohmann::json figures(const tissue::Scene& scene, const tissue::RunRecord& record) {
  const tissue::DeformationQuality quality =
      tissue::deformation_quality(scene.body(), scene.state());
  nlohmann::json effects = nlohmann::json::array(), probes = nlohmann::json::object(),
                 reactions = nlohmann::json::object(), flags = nlohmann::json::array();
  for (const tissue::EffectCost& cost : scene.effect_costs()) {
    effects.push_back({{"name", cost.name}, {"seconds", cost.seconds}, {"bytes", cost.bytes}});
  }
  for (const auto& [name, place] : scene.probes()) {
    probes[name] = place ? triple(*place) : nlohmann::json();
  }
  const std::vector<std::optional<tissue::Vec3>> forces = scene.tool_forces();
  for (std::size_t i = 0; i < forces.size(); ++i) {
    if (forces[i]) reactions[scene.description().tools[i].name] = triple(*forces[i]);
  }
  const std::vector<tissue::Vec3> anchors = scene.anchor_forces();
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    reactions["anchors[" + std::to_string(i) + "]"] = triple(anchors[i]);
  }
  if (record.not_converged > 0) flags.push_back("NOT_CONVERGED");
  if (record.folded) flags.push_back("FOLDED");
  if (record.clamped) flags.push_back("CLAMPED");
  if (record.tool_inside) flags.push_back("TOOL_INSIDE");
  return {{"scene", scene.description().name},
          {"model", name(scene.description().model)},
          {"element_order", scene.description().element_order},
          {"tetrahedra", scene.body().tets.size()},
          {"vertices", scene.body().rest.size()},
          {"steps", record.seconds.size()},
          {"steps_not_converged", record.not_converged},
          {"step_seconds",
           {{"median", tissue::percentile(record.seconds, 0.5)},
            {"p99", tissue::percentile(record.seconds, 0.99)},
            {"max", tissue::percentile(record.seconds, 1.0)}}},
          {"effects", effects},
          {"unknowns", record.last.unknowns},
          {"iterations", record.last.iterations},
          {"residual", record.last.residual},
          {"solver", record.last.solver},
          {"energy_j", record.last.energy ? nlohmann::json(*record.last.energy) : nlohmann::json()},
          {"min_det_f", quality.min_det_f},
          {"inverted", quality.inverted},
          {"penetration_m", record.penetration},
          {"probes", probes},
          {"reaction_n", reactions},
          {"feedback", feedback_of(scene)},
          {"flags", flags}};
}

void write_result(const tissue::TetMesh& mesh, const tissue::Scene& scene,
                  const std::string& path) {
  std::vector<tissue::Vec3> displacements;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    displacements.push_back(scene.state().positions[v] - mesh.vertices[v].cast<double>());
  }
  std::vector<tissue::TetField> fields;
  const std::vector<tissue::TetStrain> strains = scene.strains();
  if (!strains.empty()) {
    fields = {{"von_mises_stress", {}}, {"largest_strain", {}}};
    for (const tissue::TetStrain& strain : strains) {
      fields[0].values.push_back(strain.von_mises);
      fields[1].values.push_back(strain.largest_strain);
    }
  }
  tissue::write_mesh(mesh, path, fields, displacements);
}

tissue::RunRecord moved(tissue::Scene& scene, const tissue::TetMesh& mesh,
                        const std::vector<tissue::Instant>& instants, const Arguments& arguments) {
#ifdef TISSUE_WITH_BAGS
  if (!arguments.bag.empty()) {
    return tissue_ros::run_bag(scene, mesh,
                               {arguments.bag, arguments.cloud_bag, arguments.cloud_rate},
                               [](double part) { tissue_tools::show_progress(part, "bag"); });
  }
#endif
  static_cast<void>(mesh);
  static_cast<void>(arguments);
  return run_along(scene, instants, [&](std::size_t done) {
    tissue_tools::show_progress(static_cast<double>(done) / static_cast<double>(instants.size()),
                                "step " + std::to_string(done));
  });
}

void run(const Arguments& arguments) {
  const tissue::SceneDescription description = tissue::read_scene(arguments.scene);
  const std::vector<tissue::Instant> instants =
      instants_of(description, read_paths(description, arguments.paths));
  const tissue::TetMesh mesh = tissue::read_mesh(arguments.mesh);
  tissue::Scene scene(description, std::make_shared<tissue::Body>(tissue::body_of(mesh)),
                      arguments.threads);
  const tissue::RunRecord record = moved(scene, mesh, instants, arguments);
  write_result(mesh, scene, arguments.output);
  const nlohmann::json stats = figures(scene, record);
  if (!arguments.stats.empty()) {
    tissue_tools::write_text("--stats", arguments.stats, stats.dump(2));
  }
  double farthest = 0.0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    farthest =
        std::max(farthest, (scene.state().positions[v] - mesh.vertices[v].cast<double>()).norm());
  }
  std::printf("%s, %s of order %d, %zu tets: %zu steps, %.4g s each (median)\n",
              description.name.c_str(), name(description.model), description.element_order,
              mesh.tets.size(), record.seconds.size(), tissue::percentile(record.seconds, 0.5));
  std::printf("largest displacement %.3g m, smallest det F %.3g, %zu tets inverted\n", farthest,
              stats["min_det_f"].get<double>(), stats["inverted"].get<std::size_t>());
  if (record.not_converged > 0) {
    std::printf(
        "NOT_CONVERGED in %zu steps, residual of the last %.3g: the state is the last "
        "that was an equilibrium\n",
        record.not_converged, record.last.residual);
  }
}

}  // namespace

int main(int argc, char** argv) {
  return tissue_tools::run_program("run_scene", options(), "scene", argc, argv,
                                   [](const auto& given) { run(arguments_from(given)); });
}
