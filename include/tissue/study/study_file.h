#pragma once

#include "tissue/study/study.h"

namespace tissue {

/// Reads a study, strictly: an unknown word or a value out of range is an InputError (E_PARAM,
/// E_FILE, or what the scene's reader says) whose sentence names the line and the key. Files are
/// named relative to the study's own. The rows come with references, their checks and repeats first
/// among them.
Study read_study(const std::string& path);

}  // namespace tissue
