#pragma once

#include <vector>

namespace tissue {

/// What moves a body: the paper's formula, springs on its edges, or tissue as a solid.
enum class Model { kClosedForm, kMassSpring, kLinear, kCorotational, kNeoHookean };

const char* name(Model model);
const std::vector<Model>& all_models();

}  // namespace tissue
