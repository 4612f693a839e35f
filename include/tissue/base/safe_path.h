#pragma once

#include <string>

namespace tissue {

/// A file below `folder` that somebody else has named: relative, without "..", no longer than 1024
/// characters, and led out of the folder by no link. `must_exist` asks for a regular file. Returns
/// its full path. Throws InputError E_PATH.
std::string confined_path(const std::string& folder, const std::string& name, bool must_exist);

}  // namespace tissue
