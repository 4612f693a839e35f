#pragma once

#include "tissue/refine/build_mesh.h"

namespace tissue {

/// Meshes made to find out what is to blame where a rule of levels errs: they know where the tumour
/// is, and nothing else. `above` is the density from which on tissue is tumour; `volume` must
/// outlive the wishes.

/// Level `finest` for tets that straddle the tumour's border, 0 for all others.
LevelWishes border_wishes(const Volume& volume, const ImplicitSurface& surface, double above,
                          int finest);

/// Level `finest` for tets with any tissue in them that is no tumour, 0 within the tumour: what a
/// rule by density would do if tissue had one density.
LevelWishes tissue_wishes(const Volume& volume, const ImplicitSurface& surface, double above,
                          int finest);

}  // namespace tissue
