#include "mesh_design.h"

#include "check_options.h"
#include "tissue/field/density_sampling.h"

#include <algorithm>
#include <utility>

namespace tissue {
namespace {

// A tet straddles the border of a tumour where its corners differ by more than this part of d_max:
// more than tissue's own grain, less than the step from tissue to tumour.
constexpr double kJump = 0.25;

std::vector<std::uint8_t> boundary_flags(const LatticeMesh& mesh) {
  std::vector<std::uint8_t> flags(mesh.vertices.size(), 0);
  for (const Triangle& triangle : mesh.surface) {
    for (const std::uint32_t vertex : triangle) flags[vertex] = 1;
  }
  return flags;
}

std::vector<std::uint8_t> wished(const LatticeMesh& mesh, const Grid& grid,
                                 const MeshOptions& options, MeshDesign& design) {
  switch (options.method) {
    case Method::kUniform: return std::vector<std::uint8_t>(mesh.tets.size(), 0);
    case Method::kSurface: return surface_levels(mesh.tets, boundary_flags(mesh), options.levels);
    case Method::kWished: {
      std::vector<Vec3> places;
      places.reserve(mesh.vertices.size());
      for (const Vec3& vertex : mesh.vertices) places.push_back(grid.to_world(vertex));
      return options.wishes(places, mesh.tets);
    }
    case Method::kDensity: break;
  }
  design.thresholds = density_thresholds(design.tet_means, options.levels);
  if (!options.keep_interfaces) {
    return wished_levels(design.tet_means, design.thresholds, options.levels.base_level);
  }
  return wished_levels(
      softest_at_jumps(design.tet_means, mesh.tets, design.densities, kJump * options.levels.d_max),
      design.thresholds, options.levels.base_level);
}

}  // namespace

MeshDesign design_mesh(const Organ& organ, const StuffingOptions& stuffing,
                       const MeshOptions& options, TemplateLibrary& library, StageClock& clock,
                       const Run& run) {
  MeshDesign design;
  clock.start("lattice");
  run.enter({"lattice", 0.0, 0});
  LatticeMesh mesh = stuff(organ.surface, stuffing, run);

  clock.start("levels");
  run.enter({"levels", 0.1, mesh.tets.size()});
  std::vector<Vec3f> places;
  places.reserve(mesh.vertices.size());
  for (const Vec3& vertex : mesh.vertices) places.push_back(vertex.cast<float>());
  design.densities = sample_densities(organ.volume, organ.window, places, 0, {}, run);
  places = {};
  // The uniform mesh has no use for them, but those who look at the lattice stage have.
  if (options.method == Method::kDensity || options.lattice_only) {
    design.tet_means = smoothed(tet_means(mesh.tets, design.densities), mesh.tets,
                                mesh.vertices.size(), options.levels.smooth_levels);
  }
  design.wishes = wished(mesh, organ.volume.grid, options, design);
  const std::uint64_t predicted = predicted_tets(design.wishes);
  check_total(options, static_cast<double>(predicted),
              "level_sections: " + std::to_string(options.levels.sections) + " on " +
                  std::to_string(mesh.tets.size()) + " initial tets");
  design.levels = design.wishes;
  design.tetrahedra = mesh.tets.size();
  const bool flat = std::count(design.wishes.begin(), design.wishes.end(), 0) ==
                    static_cast<std::ptrdiff_t>(design.wishes.size());
  if (flat) {
    design.lattice.mesh = std::move(mesh);
    return design;
  }
  design.lattice = refinable(std::move(mesh), run);
  const EdgeTopology& edges = design.lattice.edges;
  raise_levels(design.levels, edges.tet_edges, edges.edges.size());
  if (options.lattice_only) return design;

  clock.start("refinement");
  run.enter({"refinement", 0.3, predicted});
  design.refined = true;
  design.plan = plan_refinement(design.lattice, design.levels, library, run);
  design.blocks = number_blocks(design.lattice, design.plan, options.max_tetrahedra);
  design.tetrahedra = design.blocks.first_tet.back();
  check_total(options, static_cast<double>(design.tetrahedra), "refinement");
  return design;
}

}  // namespace tissue
