#pragma once

#include "tissue/simulate/assembled_hessian.h"
#include "tissue/simulate/elastic_energy.h"
#include "tissue/simulate/equilibrium.h"
#include "tissue/simulate/gravity.h"
#include "tissue/simulate/material.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace tissue_test {

using namespace tissue;

inline const Material kSoft = {{{0.0, 5e4}}, 0.45, 1000.0};

/// A body of one constitution whose held nodes and loads a test sets.
struct Problem {
  Problem(Body b, int order, Constitution constitution, const Material& material, int threads = 1)
      : body(std::move(b)),
        elements(body, order),
        lame(lame_of(material, body)),
        energy(elements, lame, constitution, with_threads(threads)),
        positions(rest_positions(elements)) {}

  static Run with_threads(int threads) {
    Run run;
    run.threads = threads;
    return run;
  }

  Vec3 displacement(std::size_t node) const {
    return positions.segment<3>(static_cast<Eigen::Index>(3 * node)) - elements.rest()[node];
  }
  void move(std::size_t node, const Vec3& by) {
    positions.segment<3>(static_cast<Eigen::Index>(3 * node)) += by;
  }

  EquilibriumReport solve(const std::vector<std::uint8_t>& held, const Energy* load = nullptr,
                          double tolerance = 1e-10) {
    std::vector<const Energy*> energies = {tissue};
    if (load != nullptr) energies.push_back(load);
    Equilibrium equilibrium(energies, direct_system(elements));
    equilibrium.hold(held);
    Eigen::VectorXd motion = positions - rest_positions(elements);
    for (std::size_t node = 0; node < held.size(); ++node) {
      if (held[node] == 0) motion.segment<3>(static_cast<Eigen::Index>(3 * node)).setZero();
    }
    positions -= motion;
    equilibrium.follow(positions, motion);
    return equilibrium.solve(positions, {tolerance, 1000});
  }

  Body body;
  FiniteElements elements;
  std::vector<Lame> lame;
  ElasticEnergy energy;
  // What is solved for: the elastic energy, unless a test puts something else in its place.
  const Energy* tissue = &energy;
  Eigen::VectorXd positions;
};

inline std::vector<std::uint8_t> boundary_nodes(const Problem& problem) {
  std::vector<std::uint8_t> on(problem.elements.node_count(), 0);
  std::set<Edge> edges;
  for (const Triangle& triangle : problem.body.surface) {
    for (int i = 0; i < 3; ++i) {
      on[triangle[i]] = 1;
      const auto [low, high] = std::minmax(triangle[i], triangle[(i + 1) % 3]);
      edges.insert({low, high});
    }
  }
  const std::vector<Edge>& midpoints = problem.elements.midpoints();
  for (std::size_t i = 0; i < midpoints.size(); ++i) {
    if (edges.count(midpoints[i]) != 0) on[problem.body.rest.size() + i] = 1;
  }
  return on;
}

}  // namespace tissue_test
