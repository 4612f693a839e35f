#pragma once

namespace tissue_ros {

/// config/parameters.yaml as it stands: every parameter with its default and what it means.
extern const char* const kParametersText;

}  // namespace tissue_ros
