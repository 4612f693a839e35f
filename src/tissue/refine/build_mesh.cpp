#include "tissue/refine/build_mesh.h"

#include "check_options.h"
#include "filler.h"
#include "lattice_choice.h"
#include "mesh_design.h"
#include "mesh_measures.h"
#include "tissue/base/error.h"
#include "tissue/base/parallel.h"
#include "tissue/field/density_sampling.h"
#include "tissue/field/label_densities.h"
#include "tissue/field/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tissue {
namespace {

// Angles of the lattice's own tets, 60 and 90 degrees, as cos·|cos|.
constexpr DihedralRange kWholeAngles = {0.0, 0.25};

DensityWindow window_for(const Volume& volume, const ImplicitSurface& surface,
                         const MeshOptions& options) {
  const double d_max = options.levels.d_max;
  if (options.window) return {(*options.window)[0], (*options.window)[1], d_max};
  return default_window(volume, surface, d_max);
}

TetMesh as_uniform(LatticeMesh& lattice, std::vector<std::uint8_t> levels) {
  TetMesh mesh;
  mesh.vertices.reserve(lattice.vertices.size());
  for (const Vec3& vertex : lattice.vertices) mesh.vertices.push_back(vertex.cast<float>());
  lattice.vertices = {};
  mesh.tets = std::move(lattice.tets);
  mesh.levels = std::move(levels);
  mesh.surface = std::move(lattice.surface);
  return mesh;
}

TetMesh as_refined(RefinedMesh refined) {
  TetMesh mesh;
  mesh.vertices = std::move(refined.vertices);
  mesh.tets = std::move(refined.tets);
  mesh.levels = std::move(refined.levels);
  mesh.surface = std::move(refined.surface);
  mesh.parents = std::move(refined.parents);
  return mesh;
}

// Builds one mesh, stage by stage, and measures it on the way.
class Builder {
 public:
  Builder(const Organ& organ, const MeshOptions& options, const Run& run)
      : organ_(organ), options_(options), run_(run) {}

  BuiltMesh build() {
    const StuffingOptions stuffing = lattice_for(organ_, options_, library_, clock_, run_);
    design_ = design_mesh(organ_, stuffing, options_, library_, clock_, run_);
    statistics_.initial = design_.lattice.mesh.tets.size();
    lattice_vertices_ = static_cast<std::uint32_t>(design_.lattice.mesh.vertices.size());
    spacing_ = design_.lattice.mesh.spacing;
    take_counts();
    make_tets();
    project();
    sample();
    finish();
    BuiltMesh built;
    built.mesh = std::move(mesh_);
    if (options_.lattice_only) {
      built.lattice_densities = std::move(design_.tet_means);
      built.level_wishes = std::move(design_.wishes);
    }
    return built;
  }

 private:
  void take_counts() {
    const LatticeMesh& lattice = design_.lattice.mesh;
    statistics_.border_touched = lattice.border_touched;
    statistics_.components_dropped = lattice.components_dropped;
    statistics_.vertices_copied = lattice.vertices_copied;
    statistics_.tets_dropped = lattice.tets_dropped;
    statistics_.tets_promoted = design_.plan.tets_promoted;
    statistics_.thresholds = design_.thresholds;
    if (!design_.tet_means.empty()) {
      statistics_.distinct_densities = distinct_densities(design_.tet_means);
    }
    statistics_.levels = level_counts(design_.refined ? design_.plan.levels : design_.levels);
    statistics_.closure = options_.lattice_only
                              ? 0
                              : static_cast<std::int64_t>(design_.tetrahedra) -
                                    static_cast<std::int64_t>(predicted_tets(design_.wishes));
  }

  void make_tets() {
    clock_.start("refinement");
    run_.enter({"refinement", 0.4, design_.tetrahedra});
    whole_ = std::move(design_.lattice.mesh.whole);
    if (design_.refined) {
      mesh_ = as_refined(fill_mesh(design_.lattice, design_.plan, design_.blocks, run_));
      first_tet_ = std::move(design_.blocks.first_tet);
      near_boundary_ = tets_near_boundary(design_.lattice.mesh.tets, first_tet_, mesh_.surface,
                                          lattice_vertices_);
      dihedral_ = design_.plan.whole_dihedral;
      dihedral_.include(design_.plan.cut_dihedral);
      whole_dihedral_ = design_.plan.whole_dihedral;
    } else {
      mesh_ = as_uniform(design_.lattice.mesh, std::move(design_.levels));
      near_boundary_ = {{0, mesh_.tets.size()}};
      whole_dihedral_ = kWholeAngles;
      dihedral_ = angles({});
    }
    mesh_.lattice_vertices = lattice_vertices_;
    // What only the design needed makes room for the mesh.
    design_.lattice = {};
    design_.plan = {};
    design_.blocks = {};
    design_.levels = {};
  }

  // The angles of the mesh as it is: known for the parts of whole lattice tets that have not moved,
  // measured for all others.
  DihedralRange angles(const std::vector<std::uint8_t>& moved) const {
    std::vector<std::uint8_t> known = whole_;
    if (!first_tet_.empty()) {
      known.resize(mesh_.tets.size());
      for (std::size_t t = 0; t + 1 < first_tet_.size(); ++t) {
        std::fill(known.begin() + static_cast<std::ptrdiff_t>(first_tet_[t]),
                  known.begin() + static_cast<std::ptrdiff_t>(first_tet_[t + 1]), whole_[t]);
      }
    }
    DihedralRange range = measured_angles(mesh_, spacing_, run_, [&](std::size_t t) {
      if (known[t] == 0 || moved.empty()) return known[t] != 0;
      const Tet& tet = mesh_.tets[t];
      return (moved[tet[0]] | moved[tet[1]] | moved[tet[2]] | moved[tet[3]]) == 0;
    });
    if (std::find(known.begin(), known.end(), 1) != known.end()) range.include(whole_dihedral_);
    return range;
  }

  void project() {
    clock_.start("projection");
    run_.enter({"projection", 0.5, mesh_.tets.size()});
    if (options_.project_boundary && !options_.lattice_only) {
      const std::vector<std::uint8_t> moved =
          project_boundary(organ_.surface, mesh_.vertices, mesh_.tets, mesh_.surface,
                           near_boundary_, spacing_, options_.projection, run_);
      dihedral_ = angles(moved);
    }
    const SurfaceDistance distance =
        surface_distance(organ_.surface, mesh_.vertices, mesh_.surface, spacing_, run_);
    statistics_.surface_error = {distance.mean, distance.max};
    statistics_.boundary_vertices = distance.vertices;
    statistics_.boundary_vertices_astray = distance.astray;
    whole_ = {};
    first_tet_ = {};
    near_boundary_ = {};
  }

  void sample() {
    clock_.start("densities");
    run_.enter({"densities", 0.8, mesh_.tets.size()});
    // Lattice vertices on the boundary may have followed; their density decided the levels and
    // stays what it was.
    mesh_.densities = sample_densities(organ_.volume, organ_.window, mesh_.vertices,
                                       lattice_vertices_, std::move(design_.densities), run_);
    mesh_.tet_densities = sample_tet_densities(organ_.volume, organ_.window, mesh_.vertices,
                                               mesh_.tets, mesh_.levels, spacing_, run_);
  }

  void finish() {
    const Grid& grid = organ_.volume.grid;
    parallel_ranges(mesh_.vertices.size(), 4096, run_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        mesh_.vertices[v] = grid.to_world(mesh_.vertices[v].cast<double>()).cast<float>();
      }
    });
    mesh_.frame_id = organ_.volume.frame_id;
    mesh_.uuid = mesh_uuid(mesh_);
    statistics_.volume = volume_inside(mesh_);
    clock_.stop();
    statistics_.tetrahedra = mesh_.tets.size();
    statistics_.vertices = mesh_.vertices.size();
    statistics_.dihedral = {dihedral_.min_angle(), dihedral_.max_angle()};
    statistics_.stages = clock_.stages();
    statistics_.peak_bytes = clock_.peak_bytes();
    mesh_.statistics = std::move(statistics_);
    run_.enter({"densities", 1.0, mesh_.tets.size()});
  }

  const Organ& organ_;
  const MeshOptions& options_;
  const Run& run_;
  StageClock clock_;
  TemplateLibrary library_;
  MeshDesign design_;
  TetMesh mesh_;
  MeshStatistics statistics_;
  DihedralRange dihedral_, whole_dihedral_;
  // For each lattice tet: whether it is whole, and where its parts begin (empty for the uniform
  // mesh, whose tets are the lattice's).
  std::vector<std::uint8_t> whole_;
  std::vector<std::size_t> first_tet_;
  std::vector<TetRange> near_boundary_;
  std::uint32_t lattice_vertices_ = 0;
  double spacing_ = 0.0;
};

// Calls body(organ) with what a mesh is made from. Throws as build_mesh().
template <class Body>
auto with_organ(const std::shared_ptr<const Volume>& volume, const ImplicitSurface& surface,
                const MeshOptions& options, const Body& body) {
  check_options(options);
  const Grid& grid = surface.field->grid;
  if (!same_grid(volume->grid, grid)) {
    throw InputError(ErrorCode::kSizeMismatch, "mask: its grid of " + std::to_string(grid.size[0]) +
                                                   " x " + std::to_string(grid.size[1]) + " x " +
                                                   std::to_string(grid.size[2]) +
                                                   " voxels is not the volume's");
  }
  std::shared_ptr<const Volume> densities = volume;
  if (!options.label_densities.empty()) {
    densities = std::make_shared<Volume>(relabelled(*volume, options.label_densities));
  }
  return body(Organ{*densities, surface, window_for(*densities, surface, options)});
}

}  // namespace

BuiltMesh build_mesh(const std::shared_ptr<const Volume>& volume, const ImplicitSurface& surface,
                     const MeshOptions& options, const Run& run) {
  return with_organ(volume, surface, options,
                    [&](const Organ& organ) { return Builder(organ, options, run).build(); });
}

std::uint64_t planned_tetrahedra(const std::shared_ptr<const Volume>& volume,
                                 const ImplicitSurface& surface, const MeshOptions& options,
                                 const Run& run) {
  return with_organ(volume, surface, options, [&](const Organ& organ) {
    StageClock clock;
    TemplateLibrary library;
    const StuffingOptions stuffing = lattice_for(organ, options, library, clock, run);
    return design_mesh(organ, stuffing, options, library, clock, run).tetrahedra;
  });
}

BuiltMesh build_mesh(const std::shared_ptr<const Volume>& volume,
                     const std::shared_ptr<const Volume>& mask, const MeshOptions& options,
                     const Run& run) {
  check_options(options);
  if (mask == nullptr) {
    return build_mesh(volume, surface_at_iso(volume, options.iso_value), options, run);
  }
  return build_mesh(volume, surface_of_mask(mask), options, run);
}

}  // namespace tissue
