#pragma once

#include "support/bodies.h"
#include "tissue/simulate/scene_file.h"

#include <algorithm>

namespace tissue_test {

using namespace tissue;

/// A kind of solid, and effects besides contact.
struct Case {
  std::string model;
  int order = 1;
  std::string effects = {};

  std::string name() const { return model + " " + std::to_string(order) + effects; }
};

/// All solids, at rest and with inertia.
inline std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const char* model : {"mass_spring", "linear", "corotational", "neo_hookean"}) {
    for (const int order : {1, 2}) {
      if (order == 2 && std::string(model) == "mass_spring") continue;
      for (const char* more : {"", ", inertia, damping"}) cases.push_back({model, order, more});
    }
  }
  return cases;
}

inline std::string scene_text(const Case& which, const std::string& tools,
                              const std::string& more = "") {
  return "model: " + which.model + "\nelement_order: " + std::to_string(which.order) +
         "\nmaterial: {young: [[60, 3e3], [255, 60e3]], poisson: 0.45}\n"
         "anchors: [{plane: {axis: z, below: 20%}}]\n"
         "tools: " +
         tools + "\neffects: [density_response, contact" + which.effects + "]\n" + more;
}

inline const std::string kFinger = "[{name: finger, shape: {sphere: 0.006}, mode: press}]";
constexpr double kRadius = 0.006;

/// A ball of 30 mm radius with a tumour of a third of that in it, in 672 tets of three levels:
/// densities from 56 to 84.
inline std::shared_ptr<const Body> organ() {
  static const auto body = std::make_shared<Body>(body_of(tissue_test::refined_ball(0.024)));
  return body;
}

/// A slab of 60 x 60 x 20 mm.
inline std::shared_ptr<const Body> slab(int cells = 12) {
  return std::make_shared<Body>(
      tissue_test::kuhn_block({cells, cells, cells / 3}, {0.06, 0.06, 0.02}));
}

/// The ball's tip is so far above the organ's north pole, beside it by a little.
inline ToolPose above(double height, double radius = kRadius) {
  return {Vec3(0.0013, 0.0007, 0.030 + radius + height)};
}

inline double farthest_from_rest(const Scene& scene) {
  double farthest = 0.0;
  for (std::size_t v = 0; v < scene.body().rest.size(); ++v) {
    const Vec3 rest = scene.body().rest[v].cast<double>();
    farthest = std::max(farthest, (scene.state().positions[v] - rest).norm());
  }
  return farthest;
}

}  // namespace tissue_test
