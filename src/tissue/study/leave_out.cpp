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
    const double six =
        determinant(body.rest[tet[0]], body.rest[tet[1]], body.rest[tet[2]], body.rest[tet[3]]);
    sum += six * young[t];
    volume += six;
  }
  return sum / volume;
}

void erase(std::vector<Effect>& effects, Effect effect) {
  effects.erase(std::remove(effects.begin(), effects.end(), effect), effects.end());
}

}  // namespace

SceneDescription leave_out(SceneDescription scene, Effect effect, const Body& body) {
  if (!scene.has(effect)) {
    throw InputError(ErrorCode::kParam,
                     "without: scene " + scene.name + " does not name " + name(effect));
  }
  erase(scene.effects, effect);
  switch (effect) {
    case Effect::kDensityResponse:
      scene.push.density_response = false;
      if (scene.model != Model::kClosedForm) {
        scene.material.young = {{0.0, mean_young(scene.material, body)}};
      }
      break;
    case Effect::kRecovery: scene.recovery_time.reset(); break;
    case Effect::kFoldGuard: scene.fold_guard = false; break;
    case Effect::kInertia: erase(scene.effects, Effect::kDamping); break;
    case Effect::kGravity:
    case Effect::kDamping:
    case Effect::kForceFeedback: break;
  }
  return scene;
}

}  // namespace tissue
