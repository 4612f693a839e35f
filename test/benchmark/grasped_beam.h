#pragma once

#include "support/bodies.h"
#include "tissue/simulate/scene.h"

namespace tissue_test {

/// A beam of 0.2 × 0.1 × 0.1 m, halved twice from a coarser one, that is held at one end and
/// grasped at the other: what a step costs while the tool moves on.
class GraspedBeam {
 public:
  GraspedBeam(const std::array<int, 3>& cells, tissue::Model model, int order,
              const std::vector<tissue::Effect>& effects = {})
      : scene_(description(model, order, effects),
               std::make_shared<tissue::Body>(kuhn_block(cells, {0.2, 0.1, 0.1}, 2))) {
    scene_.step(pose(), 0.0);
  }

  /// The tool moves on by a millimetre, down and up again.
  tissue::StepReport step() {
    ++steps_;
    return scene_.step(pose(), 0.01);
  }
  const tissue::Scene& scene() const { return scene_; }

 private:
  static tissue::SceneDescription description(tissue::Model model, int order,
                                              const std::vector<tissue::Effect>& effects) {
    tissue::SceneDescription scene;
    scene.effects = effects;
    scene.model = model;
    scene.element_order = order;
    scene.material.young = {{0.0, 5e4}};
    tissue::PlaneAnchor end;
    end.axis = 0;
    end.below = tissue::Coordinate{1e-3, false};
    scene.anchors = {end};
    scene.tools[0].radius = 0.02;
    scene.tools[0].grasps = true;
    // All of the beam, for models that have a range.
    scene.push.range = 0.5;
    return scene;
  }
  tissue::ToolPose pose() const {
    const int phase = steps_ % 20;
    return {tissue::Vec3(0.2, 0.05, 0.05 - 1e-3 * (phase < 10 ? phase : 20 - phase))};
  }

  tissue::Scene scene_;
  int steps_ = 0;
};

}  // namespace tissue_test
