#include "tissue/simulate/material.h"

#include "tissue/base/error.h"

#include <algorithm>

namespace tissue {

double Material::young_at(double density) const {
  const auto above =
      std::find_if(young.begin(), young.end(), [&](const auto& row) { return density < row[0]; });
  if (above == young.begin()) return young.front()[1];
  if (above == young.end()) return young.back()[1];
  const auto& low = *(above - 1);
  const double part = (density - low[0]) / ((*above)[0] - low[0]);
  return low[1] + part * ((*above)[1] - low[1]);
}

std::vector<double> young_of(const Material& material, const Body& body) {
  if (material.young.size() == 1) {
    return std::vector<double>(body.tets.size(), material.young.front()[1]);
  }
  if (body.tet_densities.size() != body.tets.size()) {
    throw InputError(ErrorCode::kParam,
                     "mesh: has no densities of its tets, from which material.young is taken");
  }
  std::vector<double> result;
  result.reserve(body.tets.size());
  for (const float density : body.tet_densities) result.push_back(material.young_at(density));
  return result;
}

std::vector<Lame> lame_of(const Material& material, const Body& body) {
  std::vector<Lame> result;
  result.reserve(body.tets.size());
  for (const double young : young_of(material, body)) {
    result.push_back(lame_of(young, material.poisson));
  }
  return result;
}

}  // namespace tissue
