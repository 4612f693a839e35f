#pragma once

#include "tissue/study/row_result.h"

namespace tissue {

/// Keeps the result of a row of a study in a folder, one file of figures and one of displacements
/// for each row. A result is there as a whole or not at all. Throws InputError E_IO if it cannot be
/// written.
void write_row(const Study& study, std::size_t row, const RowResult& result,
               const std::string& folder);

/// The result of a row, if it is there, whole, and of the study as it reads now.
std::optional<RowResult> read_row(const Study& study, std::size_t row, const std::string& folder);

}  // namespace tissue
