#pragma once

#include "tissue/base/types.h"
#include "tissue/simulate/model.h"

#include <any>
#include <string>
#include <type_traits>
#include <typeinfo>
#include <vector>

namespace tissue {

struct EffectKind;

/// What a scene adds to its model: an effect and its parameters, which are a struct of the effect's
/// own. Those that others than the effect itself look at are declared below.
class Effect {
 public:
  Effect(const EffectKind& kind, std::any options) : kind_(&kind), options_(std::move(options)) {}
  /// The effect whose parameters these are.
  template <class Options, class = std::enable_if_t<!std::is_same_v<Options, Effect>>>
  Effect(Options options) : kind_(&kind_of(typeid(Options))), options_(std::move(options)) {}

  const EffectKind& kind() const { return *kind_; }
  const char* name() const;
  /// Nothing if this is another effect.
  template <class Options>
  const Options* options() const {
    return std::any_cast<Options>(&options_);
  }

 private:
  static const EffectKind& kind_of(const std::type_info& options);

  const EffectKind* kind_;
  std::any options_;
};

/// The words by which scenes name effects.
std::vector<std::string> effect_names();
/// Whether a model can have the effect of that name.
bool can_have(Model model, const std::string& effect);
/// Effects by models as a table in Markdown, for the README.
std::string effects_table();

/// `density_response`: tissue answers by its density. For closed_form, what is as dense as
/// `reference` goes along as the distance says; 0: the median of what is in range.
struct DensityResponseOptions {
  double reference = 0.0;
};

/// `recovery`: released tissue is back at rest after `time` [s]. Without it, it stays.
struct RecoveryOptions {
  double time = 0.2;
};

/// `fold_guard`: no tet is ever folded; the target then stays behind the tool.
struct FoldGuardOptions {};

/// `inertia`: implicit Euler in substeps of at most so many seconds, each of so many of Newton's
/// iterations (1: a linearised step; more: to the solver's tolerance).
struct InertiaOptions {
  double substep = 0.02;
  int iterations = 1;
};

/// `damping`, Rayleigh's: what resists velocities is α times the mass and β times the stiffness.
struct DampingOptions {
  /// α [1/s]
  double mass = 5.0;
  /// β [s]
  double stiffness = 0.0;
};

/// `rigid_inclusions`: connected tissue denser than this moves as a rigid body. One that an anchor
/// or a tool holds anywhere is held by it as a whole.
struct RigidInclusionsOptions {
  double density_above = 200.0;
};

}  // namespace tissue
