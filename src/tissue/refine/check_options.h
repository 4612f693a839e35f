#pragma once

#include "tissue/refine/build_mesh.h"

namespace tissue {

/// Throws InputError E_PARAM, E_N, E_NTINIT or E_TOO_MANY_TETS, naming the field and the value.
void check_options(const MeshOptions& options);

/// Throws InputError E_TOO_MANY_TETS if there would be more tets than the options allow, and
/// E_NOMEM if the machine has not the memory for them. `what` begins the sentence.
void check_total(const MeshOptions& options, double tetrahedra, const std::string& what);

}  // namespace tissue
