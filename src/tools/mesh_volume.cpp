// From a volume file to a mesh file, without ROS.
#include "mesh_volume_arguments.h"
#include "program.h"
#include "statistics_json.h"
#include "tissue/base/error.h"
#include "tissue/base/mesh_file.h"
#include "tissue/base/stage_clock.h"
#include "tissue/field/read_volume.h"
#include "tissue/field/triangle_surface.h"
#include "tissue/simulate/scene_file.h"
#include "tissue/study/strain_mesh.h"

#include <cstdio>

namespace {

tissue::ImplicitSurface organ_in(const tissue_tools::MeshVolumeArguments& arguments,
                                 const std::shared_ptr<const tissue::Volume>& volume) {
  if (!arguments.surface.empty()) {
    return tissue::surface_of_triangles(tissue::read_surface(arguments.surface), volume->grid);
  }
  if (arguments.mask.empty()) return tissue::surface_at_iso(volume, arguments.mesh.iso_value);
  auto mask = std::make_shared<tissue::Volume>(tissue::read_volume(arguments.mask));
  mask->quantity = tissue::Quantity::kLabel;
  return tissue::surface_of_mask(mask);
}

tissue::BuiltMesh build(const tissue_tools::MeshVolumeArguments& arguments,
                        const std::shared_ptr<const tissue::Volume>& volume,
                        const tissue::ImplicitSurface& organ, const tissue::Run& run) {
  if (arguments.scene.empty()) return tissue::build_mesh(volume, organ, arguments.mesh, run);
  const tissue::SceneDescription scene = tissue::read_scene(arguments.scene);
  const auto instants = tissue::instants_of(scene, tissue::read_paths(scene, arguments.paths));
  return tissue::build_strain_mesh(volume, organ, arguments.mesh, {scene, instants}, run);
}

// What a person wants to know at once; `--stats` has it all.
void print_summary(const tissue::MeshStatistics& statistics, std::uint64_t target,
                   double meshing_seconds) {
  constexpr double kDegrees = 180.0 / 3.14159265358979323846;
  const auto tets = static_cast<double>(statistics.tetrahedra);
  const double wished = tets - static_cast<double>(statistics.closure);
  std::printf("%llu tets, %llu vertices, from %llu initial tets (closure %.1f %%)\n",
              static_cast<unsigned long long>(statistics.tetrahedra),
              static_cast<unsigned long long>(statistics.vertices),
              static_cast<unsigned long long>(statistics.initial),
              100.0 * static_cast<double>(statistics.closure) / wished);
  if (target > 0) {
    std::printf("asked for %llu: %+.2f %%\n", static_cast<unsigned long long>(target),
                100.0 * (tets / static_cast<double>(target) - 1.0));
  }
  if (statistics.components_dropped > 0) {
    std::printf("%llu smaller components dropped\n",
                static_cast<unsigned long long>(statistics.components_dropped));
  }
  std::printf("dihedral angles %.1f to %.1f deg, boundary to isosurface mean %.2g m, max %.2g m\n",
              statistics.dihedral[0] * kDegrees, statistics.dihedral[1] * kDegrees,
              statistics.surface_error[0], statistics.surface_error[1]);
  std::printf("%llu of %llu boundary vertices stay more than a tenth of a voxel away\n",
              static_cast<unsigned long long>(statistics.boundary_vertices_astray),
              static_cast<unsigned long long>(statistics.boundary_vertices));
  std::printf("%.3f CPU s from volume to mesh: %.2f million tets per CPU s, %.0f bytes per tet\n",
              meshing_seconds, 1e-6 * tets / meshing_seconds,
              static_cast<double>(statistics.peak_bytes) / tets);
}

void run(const tissue_tools::MeshVolumeArguments& arguments) {
  tissue::StageClock files;
  files.start("read");
  auto volume = std::make_shared<tissue::Volume>(tissue::read_volume(arguments.volume));
  for (const tissue::Tumour& tumour : arguments.tumours) insert_tumour(*volume, tumour);
  if (!arguments.mesh.label_densities.empty()) volume->quantity = tissue::Quantity::kLabel;
  const tissue::ImplicitSurface organ = organ_in(arguments, volume);
  if (!arguments.marching_cubes.empty()) {
    const tissue::TriangleSurface surface =
        tissue::decimated(tissue::marching_cubes(organ), arguments.decimate);
    tissue::write_surface(surface, arguments.marching_cubes);
    std::printf("marching cubes: %zu vertices, %zu triangles\n", surface.vertices.size(),
                surface.triangles.size());
  }
  files.stop();
  tissue::Run watched;
  watched.threads = arguments.threads;
  watched.report = [](const tissue::Progress& progress) {
    tissue_tools::show_progress(
        progress.fraction,
        std::string(progress.stage) + ", " + std::to_string(progress.tetrahedra) + " tets");
  };
  tissue::BuiltMesh built = build(arguments, volume, organ, watched);
  files.start("write");
  std::vector<tissue::TetField> further;
  if (arguments.mesh.lattice_only) {
    further.push_back({"density", built.lattice_densities});
    further.push_back({"level_wish", {built.level_wishes.begin(), built.level_wishes.end()}});
  }
  tissue::write_mesh(built.mesh, arguments.output, further);
  files.stop();

  tissue::MeshStatistics& statistics = built.mesh.statistics;
  double meshing_seconds = 0.0;
  for (const tissue::StageCost& stage : statistics.stages) meshing_seconds += stage.cpu_seconds;
  statistics.stages.insert(statistics.stages.begin(), files.stages()[0]);
  statistics.stages.push_back(files.stages()[1]);
  if (!arguments.stats.empty()) {
    tissue_tools::write_text("--stats", arguments.stats, tissue::to_json(statistics).dump(2));
  }
  print_summary(statistics, arguments.mesh.target_tetrahedra, meshing_seconds);
}

}  // namespace

int main(int argc, char** argv) {
  return tissue_tools::run_program(
      "mesh_volume", tissue_tools::mesh_volume_options(), "volume", argc, argv,
      [](const auto& given) { run(tissue_tools::mesh_volume_arguments(given)); });
}
