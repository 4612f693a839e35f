#include "tissue/refine/build_mesh.h"

#include "tissue/base/error.h"
#include "tissue/base/parallel.h"
#include "tissue/base/stage_clock.h"
#include "tissue/field/density_window.h"
#include "tissue/field/surface_distance.h"
#include "tissue/refine/refine.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace tissue {
namespace {

// A mesh needs at least the tets around one lattice point.
constexpr std::uint32_t kFewestTets = 24;

[[noreturn]] void refuse(ErrorCode code, const std::string& sentence) {
  throw InputError(code, sentence);
}

void check(const MeshOptions& options) {
  const LevelOptions& levels = options.levels;
  if (levels.sections < 1 || levels.sections > 255) {
    refuse(ErrorCode::kN,
           "level_sections: " + std::to_string(levels.sections) + " is not within 1 to 255");
  }
  if (levels.base_level < 0 || levels.base_level > 20) {
    refuse(ErrorCode::kParam,
           "base_level: " + std::to_string(levels.base_level) + " is not within 0 to 20");
  }
  if (levels.smooth_levels < 0 || levels.smooth_levels > 100) {
    refuse(ErrorCode::kParam,
           "smooth_levels: " + std::to_string(levels.smooth_levels) + " is not within 0 to 100");
  }
  if (!(levels.d_max >= 1.0 && levels.d_max <= 65535.0 &&
        std::floor(levels.d_max) == levels.d_max)) {
    refuse(ErrorCode::kParam,
           "d_max: " + to_text(levels.d_max) + " is not a whole number within 1 to 65535");
  }
  if (!(options.spacing >= 0.0 && std::isfinite(options.spacing))) {
    refuse(ErrorCode::kParam, "spacing: " + to_text(options.spacing) + " m is not positive");
  }
  if (options.spacing == 0.0 && options.initial_tetrahedra < kFewestTets) {
    refuse(ErrorCode::kNTinit, "initial_tetrahedra: " + std::to_string(options.initial_tetrahedra) +
                                   " is below " + std::to_string(kFewestTets));
  }
  if (options.spacing == 0.0 && options.initial_tetrahedra > options.max_tetrahedra) {
    refuse(ErrorCode::kTooManyTets,
           "initial_tetrahedra: " + std::to_string(options.initial_tetrahedra) +
               " is over the limit of " + std::to_string(options.max_tetrahedra));
  }
  if (options.window) {
    const auto& [low, high] = *options.window;
    if (!std::isfinite(low) || !std::isfinite(high) || !(high > low)) {
      refuse(ErrorCode::kParam,
             "window: " + to_text(low) + " to " + to_text(high) + " is not a finite, rising range");
    }
  }
}

ImplicitSurface surface_for(const std::shared_ptr<const Volume>& volume,
                            const std::shared_ptr<const Volume>& mask, const MeshOptions& options) {
  if (mask == nullptr) return surface_at_iso(volume, options.iso_value);
  if (!same_grid(volume->grid, mask->grid)) {
    refuse(ErrorCode::kSizeMismatch, "mask: its grid of " + std::to_string(mask->grid.size[0]) +
                                         " x " + std::to_string(mask->grid.size[1]) + " x " +
                                         std::to_string(mask->grid.size[2]) +
                                         " voxels is not the volume's");
  }
  return surface_of_mask(mask);
}

// The lattice at the spacing asked for, or at the spacing that comes within 2 % of the wished
// number of tets: the number falls with the cube of the spacing, so a few rounds of that rule
// suffice.
LatticeMesh stuffed(const ImplicitSurface& surface, const MeshOptions& options) {
  StuffingOptions stuffing;
  stuffing.all_components = options.all_components;
  // An organ fills at least a twelfth of its lattice, or is cropped first.
  stuffing.max_points = 2.0 * static_cast<double>(options.max_tetrahedra);
  stuffing.spacing = options.spacing;
  // A lattice tet has a volume of spacing³/12.
  const double volume_of_twelve = 12.0 * voxel_volume_inside(surface);
  if (options.spacing > 0.0) {
    const double expected = volume_of_twelve / std::pow(options.spacing, 3);
    if (expected > static_cast<double>(options.max_tetrahedra)) {
      refuse(ErrorCode::kTooManyTets,
             "spacing: " + to_text(options.spacing) + " m would make about " + to_text(expected) +
                 " initial tets, the limit is " + std::to_string(options.max_tetrahedra));
    }
    return stuff(surface, stuffing);
  }
  const double wished = options.initial_tetrahedra;
  stuffing.spacing = std::cbrt(volume_of_twelve / wished);
  LatticeMesh nearest;
  double smallest_gap = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 6 && smallest_gap > 0.02; ++round) {
    LatticeMesh mesh = stuff(surface, stuffing);
    const double ratio = static_cast<double>(mesh.tets.size()) / wished;
    stuffing.spacing *= std::cbrt(ratio);
    if (std::abs(ratio - 1.0) >= smallest_gap) continue;
    smallest_gap = std::abs(ratio - 1.0);
    nearest = std::move(mesh);
  }
  return nearest;
}

DensityWindow window_for(const Volume& volume, const ImplicitSurface& surface,
                         const MeshOptions& options) {
  const double d_max = options.levels.d_max;
  if (options.window) return {(*options.window)[0], (*options.window)[1], d_max};
  return default_window(volume, surface, d_max);
}

template <class Position>
std::vector<float> sampled_densities(const Volume& volume, const DensityWindow& window,
                                     const std::vector<Position>& places, std::size_t begin,
                                     std::vector<float> densities, int threads) {
  densities.resize(places.size());
  with_sampler(volume, [&](const auto& value) {
    parallel_ranges(places.size() - begin, threads, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = begin + from; i < begin + to; ++i) {
        densities[i] = static_cast<float>(window.density(value(places[i].template cast<double>())));
      }
    });
  });
  return densities;
}

std::vector<float> sampled_tet_densities(const Volume& volume, const DensityWindow& window,
                                         const TetMesh& mesh, double spacing, int threads) {
  std::vector<TetSampling> sampling;
  for (int level = 0; level < 256; ++level) {
    sampling.emplace_back(std::ldexp(spacing, -level), volume.grid.spacing);
  }
  std::vector<float> densities(mesh.tets.size());
  with_sampler(volume, [&](const auto& value) {
    const auto density = [&](const Vec3& place) { return window.density(value(place)); };
    parallel_ranges(mesh.tets.size(), threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        const auto corner = [&](int i) -> Vec3 {
          return mesh.vertices[mesh.tets[t][i]].cast<double>();
        };
        densities[t] = static_cast<float>(
            sampling[mesh.levels[t]].mean(corner(0), corner(1), corner(2), corner(3), density));
      }
    });
  });
  return densities;
}

double volume_of(const TetMesh& mesh) {
  double sum = 0.0;
  for (const Tet& tet : mesh.tets) {
    sum += determinant(mesh.vertices[tet[0]], mesh.vertices[tet[1]], mesh.vertices[tet[2]],
                       mesh.vertices[tet[3]]);
  }
  return sum / 6.0;
}

DihedralRange lattice_dihedral(const LatticeMesh& mesh) {
  DihedralRange range;
  for (const Tet& tet : mesh.tets) {
    range.include(dihedral_range(mesh.vertices[tet[0]], mesh.vertices[tet[1]],
                                 mesh.vertices[tet[2]], mesh.vertices[tet[3]]));
  }
  return range;
}

std::vector<std::uint64_t> level_counts(const std::vector<std::uint8_t>& levels) {
  std::vector<std::uint64_t> counts;
  for (const std::uint8_t level : levels) {
    if (level >= counts.size()) counts.resize(level + 1u, 0);
    ++counts[level];
  }
  return counts;
}

TetMesh as_uniform(const LatticeMesh& lattice, std::vector<std::uint8_t> levels) {
  TetMesh mesh;
  for (const Vec3& vertex : lattice.vertices) mesh.vertices.push_back(vertex.cast<float>());
  mesh.tets = lattice.tets;
  mesh.levels = std::move(levels);
  mesh.surface = boundary_of(mesh.tets, mesh.vertices.size());
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

}  // namespace

BuiltMesh build_mesh(const std::shared_ptr<const Volume>& volume,
                     const std::shared_ptr<const Volume>& mask, const MeshOptions& options) {
  check(options);
  StageClock clock;
  clock.start("lattice");
  const ImplicitSurface surface = surface_for(volume, mask, options);
  LatticeMesh stuffed_mesh = stuffed(surface, options);

  MeshStatistics statistics;
  statistics.initial = stuffed_mesh.tets.size();
  statistics.border_touched = stuffed_mesh.border_touched;
  statistics.components_dropped = stuffed_mesh.components_dropped;
  statistics.vertices_copied = stuffed_mesh.vertices_copied;
  statistics.tets_dropped = stuffed_mesh.tets_dropped;

  clock.start("levels");
  const DensityWindow window = window_for(*volume, surface, options);
  RefinableLattice lattice = refinable(std::move(stuffed_mesh));
  const std::vector<Vec3>& places = lattice.mesh.vertices;
  std::vector<float> densities = sampled_densities(*volume, window, places, 0, {}, options.threads);
  std::vector<double> tet_density =
      smoothed(tet_means(lattice.mesh.tets, densities), lattice.mesh.tets, places.size(),
               options.levels.smooth_levels);
  statistics.distinct_densities = distinct_densities(tet_density);
  statistics.thresholds = density_thresholds(tet_density, options.levels);
  const std::vector<std::uint8_t> wishes =
      wished_levels(tet_density, statistics.thresholds, options.levels.base_level);
  std::vector<std::uint8_t> levels = wishes;
  raise_levels(levels, lattice.edges.tet_edges, lattice.edges.edges.size());
  const std::uint64_t predicted = predicted_tets(levels);
  if (predicted > options.max_tetrahedra) {
    refuse(ErrorCode::kTooManyTets, "level_sections: " + std::to_string(options.levels.sections) +
                                        " on " + std::to_string(levels.size()) +
                                        " initial tets would make " + std::to_string(predicted) +
                                        " tets or more, the limit is " +
                                        std::to_string(options.max_tetrahedra));
  }

  clock.start("refinement");
  BuiltMesh built;
  TetMesh& mesh = built.mesh;
  DihedralRange dihedral;
  if (options.lattice_only) {
    statistics.levels = level_counts(levels);
    mesh = as_uniform(lattice.mesh, std::move(levels));
    dihedral = lattice_dihedral(lattice.mesh);
  } else {
    RefinedMesh refined =
        refine(lattice, std::move(levels), options.max_tetrahedra, options.threads);
    statistics.levels = level_counts(refined.lattice_levels);
    statistics.tets_promoted = refined.tets_promoted;
    dihedral = refined.dihedral;
    mesh = as_refined(std::move(refined));
  }
  mesh.lattice_vertices = static_cast<std::uint32_t>(places.size());

  clock.start("densities");
  mesh.densities = sampled_densities(*volume, window, mesh.vertices, places.size(),
                                     std::move(densities), options.threads);
  mesh.tet_densities =
      sampled_tet_densities(*volume, window, mesh, lattice.mesh.spacing, options.threads);
  statistics.surface_error =
      surface_distance(surface, mesh.vertices, mesh.surface, lattice.mesh.spacing, options.threads);
  for (Vec3f& vertex : mesh.vertices) {
    vertex = volume->grid.to_world(vertex.cast<double>()).cast<float>();
  }
  mesh.frame_id = volume->frame_id;
  mesh.uuid = mesh_uuid(mesh);
  clock.stop();

  statistics.tetrahedra = mesh.tets.size();
  statistics.vertices = mesh.vertices.size();
  statistics.closure = options.lattice_only ? 0
                                            : static_cast<std::int64_t>(statistics.tetrahedra) -
                                                  static_cast<std::int64_t>(predicted_tets(wishes));
  statistics.dihedral = {dihedral.min_angle(), dihedral.max_angle()};
  statistics.volume = volume_of(mesh);
  statistics.stages = clock.stages();
  statistics.peak_bytes = clock.peak_bytes();
  mesh.statistics = std::move(statistics);
  if (options.lattice_only) {
    built.lattice_densities = std::move(tet_density);
    built.level_wishes = wishes;
  }
  return built;
}

}  // namespace tissue
