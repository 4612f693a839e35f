#include "tissue/study/leave_out.h"

#include "tissue/base/error.h"
#include "tissue/base/tet_mesh.h"

#include <algorithm>

namespace tissue {
namespace {

double mean_young(const Material& material, const Body& body) {
  const std::vector<double> young = young_of(material, body);
  double sum = 0.0, volume = 0.0;
  for (std::size_t t = 0; t < young.size(); ++t) {
    const Tet& tet = body.tets[t];
    const double six = determinant(body.rest, tet);
    sum += six * young[t];
    volume += six;
  }
  return sum / volume;
}

template <class Which>
void erase_if(std::vector<Effect>& effects, const Which& which) {
  effects.erase(std::remove_if(effects.begin(), effects.end(), which), effects.end());
}

}  // namespace

SceneDescription leave_out(SceneDescription scene, const std::string& effect, const Body& body) {
  if (!scene.has(effect)) {
    throw InputError(ErrorCode::kParam,
                     "without: scene " + scene.name + " does not name " + effect);
  }
  const bool responds = scene.has<DensityResponseOptions>();
  erase_if(scene.effects, [&](const Effect& one) { return effect == one.name(); });
  // What makes no sense without it goes with it.
  erase_if(scene.effects, [&](const Effect& one) { return !objection_to(one, scene).empty(); });
  if (responds && !scene.has<DensityResponseOptions>() && scene.model != Model::kClosedForm) {
    scene.material.young = {{0.0, mean_young(scene.material, body)}};
  }
  return scene;
}

}  // namespace tissue
