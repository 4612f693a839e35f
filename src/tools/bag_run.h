#pragma once

#include "tissue/base/tet_mesh.h"
#include "tissue/simulate/scene_run.h"

namespace tissue_ros {

struct BagRunOptions {
  /// Bag with what the scene's tools said, on the topics that the scene names.
  std::string bag;
  /// Bag for `deformed_cloud`, one message for each cloud that is due; empty: none.
  std::string cloud_bag;
  /// [Hz]
  double cloud_rate = 30.0;
};

/// Moves a scene as a bag says, as deformer_node does that replays it: the same clouds, bit for
/// bit. `after_part` hears how much of the bag is done, from 0 to 1. Throws tissue::InputError
/// E_FILE for a bag that cannot be read or has no pose of any tool, E_IO for one that cannot be
/// written, and what DeviceReader throws.
tissue::RunRecord run_bag(tissue::Scene& scene, const tissue::TetMesh& mesh,
                          const BagRunOptions& options,
                          const std::function<void(double)>& after_part = {});

}  // namespace tissue_ros
