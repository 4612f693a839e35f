#include "tissue/simulate/model.h"

namespace tissue {

const char* name(Model model) {
  switch (model) {
    case Model::kClosedForm: return "closed_form";
    case Model::kMassSpring: return "mass_spring";
    case Model::kLinear: return "linear";
    case Model::kCorotational: return "corotational";
    case Model::kNeoHookean: return "neo_hookean";
  }
  return "";
}

const std::vector<Model>& all_models() {
  static const std::vector<Model> models = {Model::kClosedForm, Model::kMassSpring, Model::kLinear,
                                            Model::kCorotational, Model::kNeoHookean};
  return models;
}

}  // namespace tissue
