#include "../effect_kind.h"

namespace tissue::effects {

extern const EffectKind fold_guard = {"fold_guard", typeid(FoldGuardOptions), is_closed_form,
                                      read_nothing<FoldGuardOptions>};

}  // namespace tissue::effects
