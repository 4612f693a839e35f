#pragma once

#include "tissue/field/volume.h"

#include <string>

namespace tissue {

/// Reads NIfTI, NRRD, MetaImage or a folder with one DICOM series. Files are in millimetres and, as
/// ITK delivers them, in LPS; the volume is in metres and in RAS. The first axis of a left-handed
/// grid is reversed, so that its axes are a rotation. Throws InputError: E_FILE (also for several
/// series, which it lists), E_NONUNIFORM for slices that are not evenly spaced, E_DIRECTION, and
/// what decode_volume throws.
Volume read_volume(const std::string& path);

}  // namespace tissue
