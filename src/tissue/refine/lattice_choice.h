#pragma once

#include "mesh_design.h"

namespace tissue {

/// Spacing and offset at which the mesh, or else the lattice, has as many tets as asked for. Searching
/// is a stage of `clock`. Throws InputError as build_mesh().
StuffingOptions lattice_for(const Organ& organ, const MeshOptions& options,
                            TemplateLibrary& library, StageClock& clock, const Run& run);

}  // namespace tissue
