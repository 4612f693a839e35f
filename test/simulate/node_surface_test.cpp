// Where tools are nearest to surfaces.
#include "support/bodies.h"
#include "tissue/simulate/closest_points.h"
#include "tissue/simulate/node_surface.h"

#include <gtest/gtest.h>

#include <random>

namespace {

using namespace tissue;

TEST(ClosestPoints, OfTrianglesAndSegmentsAreNoFartherThanAnyOther) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  const auto place = [&] {
    return Vec3(coordinate(random), coordinate(random), coordinate(random));
  };
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = place(), a = place(), b = place(), c = i % 7 == 0 ? Vec3(2.0 * b - a) : place();
    const std::array<double, 3> w = closest_in_triangle(p, a, b, c);
    EXPECT_NEAR(w[0] + w[1] + w[2], 1.0, 1e-12);
    EXPECT_GE(std::min({w[0], w[1], w[2]}), 0.0);
    const double distance = (p - w[0] * a - w[1] * b - w[2] * c).norm();
    const AlongSegments along = closest_of_segments(p, a, b, c);
    const double apart = (p + along.first * (a - p) - b - along.second * (c - b)).norm();
    for (int k = 0; k < 20; ++k) {
      const double u = std::abs(coordinate(random)), v = std::abs(coordinate(random)) * (1.0 - u);
      EXPECT_LE(distance, (p - (1.0 - u - v) * a - u * b - v * c).norm() + 1e-12);
      const double t = std::abs(coordinate(random));
      EXPECT_LE(apart, (p + u * (a - p) - b - t * (c - b)).norm() + 1e-9);
    }
  }
}

TEST(NodeSurface, KnowsInsideFromOutside) {
  const auto body = std::make_shared<Body>(body_of(tissue_test::refined_ball(0.024)));
  const FiniteElements elements(*body, 2);
  const NodeSurface surface(elements, *body);
  const Eigen::VectorXd rest = rest_positions(elements);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-0.04, 0.04);
  for (int i = 0; i < 500; ++i) {
    const Vec3 place(coordinate(random), coordinate(random), coordinate(random));
    const double r = place.norm();
    if (r > 0.026 && r < 0.0305) continue;
    EXPECT_EQ(surface.contains(place, rest), r < 0.03) << place.transpose();
    const double away = surface.distance({place, place, 0.0}, rest, 1.0);
    EXPECT_NEAR(away, std::abs(r - 0.03), 0.004);
  }
  // Through vertices and edges.
  for (const Vec3f& vertex : body->rest) {
    if (vertex.norm() > 0.02f) continue;
    EXPECT_TRUE(surface.contains(vertex.cast<double>(), rest));
    EXPECT_FALSE(surface.contains(vertex.cast<double>() - Vec3(0.1, 0.0, 0.0), rest));
  }
}

}  // namespace
