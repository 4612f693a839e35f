#include "support/subjects.h"

#include "support/bodies.h"
#include "tissue/base/quality.h"

#include <algorithm>
#include <sstream>

namespace tissue_test {
namespace {

using namespace tissue;

constexpr double kBlock = 0.04;

Body block() {
  return with_core(kuhn_block({4, 4, 4}, Vec3::Constant(kBlock)), Vec3::Constant(0.5 * kBlock),
                   0.3 * kBlock, 2.0f, 1.0f);
}

Subject block_subject(Body body, const char* name) {
  return {name, std::make_shared<const Body>(std::move(body)), kBlock, kBlock, 1e-7};
}

}  // namespace

const std::vector<Subject>& subjects() {
  static const std::vector<Subject> all = {
      block_subject(block(), "block"),
      {"refined ball",
       std::make_shared<const Body>(ball_body(refined_ball(0.015, 2), 0.010, 2.0f, 1.0f)), 0.06,
       0.03, -0.018}};
  return all;
}

Vec3 top_of(const Subject& subject) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3f& place : subject.body->rest) {
    middle += place.cast<double>() / static_cast<double>(subject.body->rest.size());
  }
  middle.z() = subject.top;
  return middle;
}

Subject block_with_a_sliver() {
  Body body = block();
  // A vertex in the middle goes almost onto the opposite face of one of its tets; all others around
  // it grow.
  const auto middle = static_cast<std::uint32_t>(
      std::find_if(
          body.rest.begin(), body.rest.end(),
          [](const Vec3f& p) { return (p.cast<double>() - Vec3::Constant(0.02)).norm() < 1e-6; }) -
      body.rest.begin());
  const Tet tet = *std::find_if(body.tets.begin(), body.tets.end(), [&](const Tet& t) {
    return std::find(t.begin(), t.end(), middle) != t.end();
  });
  Vec3 face = Vec3::Zero();
  for (const std::uint32_t v : tet) {
    if (v != middle) face += body.rest[v].cast<double>() / 3.0;
  }
  const Vec3 before = body.rest[middle].cast<double>();
  const auto smallest_angle = [&](double nearness) {
    body.rest[middle] = (before + nearness * (face - before)).cast<float>();
    std::array<Vec3, 4> corners;
    for (int i = 0; i < 4; ++i) corners[i] = body.rest[tet[i]].cast<double>();
    return dihedral_range(corners[0], corners[1], corners[2], corners[3]).min_angle();
  };
  double low = 0.0, high = 1.0;
  while (high - low > 1e-9) {
    const double between = 0.5 * (low + high);
    (smallest_angle(between) > 0.1 ? low : high) = between;
  }
  EXPECT_NEAR(smallest_angle(low), 0.1, 0.01);
  return block_subject(std::move(body), "block with a sliver");
}

Material Tissue::material() const { return {{{1.0, 1e4}, {2.0, 1e4 * contrast}}, poisson, 1000.0}; }

std::string Tissue::scene(const Subject& subject) const {
  std::ostringstream text;
  text << "material: {young: [[1, 1e4], [2, " << 1e4 * contrast << "]], poisson: " << poisson
       << "}\nanchors: [{plane: {axis: z, below: " << subject.held_below << "}}]\n";
  return text.str();
}

}  // namespace tissue_test
