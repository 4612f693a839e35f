#pragma once

#include "tissue/field/volume.h"

#include <map>

namespace tissue {

/// A volume of labels in which each stands for its density; label 0 may be left out of the table.
/// Throws InputError E_PARAM for another label that is not in it.
Volume relabelled(const Volume& volume, const std::map<std::int64_t, double>& densities);

}  // namespace tissue
