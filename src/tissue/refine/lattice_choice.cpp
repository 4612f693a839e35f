#include "lattice_choice.h"

#include "check_options.h"
#include "lattice_search.h"
#include "tissue/base/error.h"

#include <algorithm>
#include <cmath>

namespace tissue {

StuffingOptions lattice_for(const Organ& organ, const MeshOptions& options,
                            TemplateLibrary& library, StageClock& clock, const Run& run) {
  StuffingOptions stuffing;
  stuffing.component = options.component;
  stuffing.component.place = organ.volume.grid.to_grid(options.component.place);
  // An organ fills at least a twelfth of its lattice, or is cropped first.
  stuffing.max_points = 2.0 * static_cast<double>(options.max_tetrahedra);
  stuffing.spacing = options.spacing;
  if (options.spacing > 0.0) {
    // Voxels are counted only where the whole box would be too much.
    const Grid& grid = organ.volume.grid;
    const double box = static_cast<double>(grid.voxel_count()) * grid.spacing.prod();
    const double tets_per_volume = 12.0 / std::pow(options.spacing, 3);
    if (box * tets_per_volume > 1e6) {
      check_total(options, voxel_volume_inside(organ.surface) * tets_per_volume,
                  "spacing: " + to_text(options.spacing) + " m");
    }
    return stuffing;
  }
  const bool by_total = options.target_tetrahedra > 0;
  const bool by_design = by_total && options.method != Method::kUniform;
  const double wished = by_total ? static_cast<double>(options.target_tetrahedra)
                                 : static_cast<double>(options.initial_tetrahedra);
  check_total(options, wished, by_total ? "target_tetrahedra" : "initial_tetrahedra");
  // Sections of equal size have 1, 8, 64, … tets for each of the lattice's.
  double growth = 1.0;
  if (by_design) {
    growth = 0.0;
    for (int level = 0; level < options.levels.sections; ++level) {
      growth += std::pow(8.0, std::min(level + options.levels.base_level, 8));
    }
    growth /= options.levels.sections;
  }
  // A lattice tet has a volume of spacing³/12.
  stuffing.spacing = std::cbrt(12.0 * voxel_volume_inside(organ.surface) * growth / wished);
  // What a total costs to find is told apart from what the mesh costs.
  const char* stage = by_total ? "search" : "lattice";
  clock.start(stage);
  return search_lattice(stuffing, wished, by_total ? 0.002 : 0.02, [&](const StuffingOptions& at) {
    run.enter({stage, 0.0, 0});
    if (!by_design) return static_cast<double>(count_stuffed(organ.surface, at, run));
    StageClock unused;
    Run quiet = run;
    quiet.report = nullptr;
    // A guess may lie beyond a limit that the mesh to be found keeps; nothing is allocated for it.
    MeshOptions roomy = options;
    roomy.max_tetrahedra *= 2;
    return static_cast<double>(design_mesh(organ, at, roomy, library, unused, quiet).tetrahedra);
  });
}

}  // namespace tissue
