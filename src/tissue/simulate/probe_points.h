#pragma once

#include "tissue/simulate/scene_description.h"

namespace tissue {

/// Follows a scene's probes as the body moves: each is a weighted mean of vertices.
class ProbePoints {
 public:
  /// A place outside the tissue and a density that nothing exceeds have no vertices.
  ProbePoints(const std::map<std::string, Probe>& probes, const Body& body);

  std::map<std::string, std::optional<Vec3>> places(const State& state) const;

 private:
  struct Weight {
    std::uint32_t vertex;
    double weight;
  };
  std::map<std::string, std::vector<Weight>> weights_;
};

}  // namespace tissue
