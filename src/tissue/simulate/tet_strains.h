#pragma once

#include "tissue/simulate/elastic_energy.h"
#include "tissue/simulate/scene.h"

namespace tissue {

/// How every tet is strained where the nodes are at `positions`, three after three [m].
std::vector<TetStrain> tet_strains(const FiniteElements& elements, const ElasticEnergy& tissue,
                                   const Eigen::VectorXd& positions);

}  // namespace tissue
