#pragma once

#include "deformation_model.h"
#include "tissue/simulate/scene_description.h"

namespace tissue {

/// Follows a scene's probes as the body moves: each is a weighted mean of nodes, by the shape
/// functions of the model's elements.
class ProbePoints {
 public:
  /// A place outside the tissue and a density that nothing exceeds have no nodes.
  ProbePoints(const std::map<std::string, Probe>& probes, const Body& body,
              const DeformationModel& model);

  std::map<std::string, std::optional<Vec3>> places(const DeformationModel& model) const;

 private:
  std::map<std::string, std::vector<NodeWeight>> weights_;
};

}  // namespace tissue
