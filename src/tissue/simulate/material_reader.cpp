#include "material_reader.h"

namespace tissue {
namespace {

constexpr double kHuge = 1e12;

}  // namespace

std::vector<std::array<double, 2>> young_from(const YamlReader& reader, bool by_density) {
  std::vector<std::array<double, 2>> young;
  for (const YamlReader& row : reader.entries()) {
    const std::vector<YamlReader> pair = row.entries();
    if (pair.size() != 2) row.refuse("is not a pair [density, Pa]");
    const double density = pair[0].number(0.0, kHuge);
    if (!young.empty() && !(density > young.back()[0])) {
      pair[0].refuse(ErrorCode::kParam, "densities do not rise");
    }
    young.push_back({density, pair[1].number(0.0, kHuge, true)});
  }
  if (young.empty()) reader.refuse("has no rows");
  if (!by_density && young.size() > 1) {
    reader.refuse("has several rows, which needs the effect density_response");
  }
  return young;
}

Material material_from(const YamlReader& reader, bool by_density) {
  reader.require_keys({"young", "poisson", "mass_density"});
  Material material;
  if (reader.has("young")) material.young = young_from(reader.at("young"), by_density);
  if (reader.has("poisson")) material.poisson = reader.at("poisson").number(-1.0, 0.5, true);
  if (reader.has("mass_density")) {
    material.mass_density = reader.at("mass_density").number(0.0, kHuge, true);
  }
  return material;
}

}  // namespace tissue
