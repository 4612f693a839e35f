#pragma once

#include <string>

namespace tissue_test {

/// Writes one DICOM slice of 6 x 5 pixels, 0.5 x 0.7 mm, whose values are 10·z + x (z [mm]), at
/// height z, as part of a series.
void write_dicom_slice(const std::string& path, const std::string& series, int number, double z);

}  // namespace tissue_test
