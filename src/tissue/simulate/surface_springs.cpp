#include "surface_springs.h"

#include <algorithm>
#include <map>

namespace tissue {
namespace {

// Parts into which the edges of triangles are cut to sum up stiffness over them.
constexpr int kParts = 4;

Vec3 node(const Eigen::VectorXd& all, std::size_t i) {
  return all.segment<3>(static_cast<Eigen::Index>(3 * i));
}

// Calls body(w) for barycentric coordinates of places that stand for equal parts of a triangle.
template <class Body>
void for_each_part(const Body& body) {
  for (int i = 0; i < kParts; ++i) {
    for (int j = 0; i + j < kParts; ++j) {
      for (const double third : {1.0 / 3.0, 2.0 / 3.0}) {
        if (third > 0.5 && i + j + 1 >= kParts) continue;
        const double u = (i + third) / kParts, v = (j + third) / kParts;
        body(std::array<double, 3>{1.0 - u - v, u, v});
      }
    }
  }
}

}  // namespace

SurfaceSprings::SurfaceSprings(const FiniteElements& elements, const Body& body)
    : surface_(elements, body) {}

void SurfaceSprings::attach(std::size_t holder, const Eigen::VectorXd& positions,
                            const std::function<double(const Vec3&)>& stiffness_at) {
  std::map<std::uint32_t, double> stiffness;
  for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
    std::array<Vec3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = node(positions, surface_.triangles[t][k]);
    std::array<double, 3> sums{};
    for_each_part([&](const std::array<double, 3>& w) {
      const double here = stiffness_at(w[0] * corners[0] + w[1] * corners[1] + w[2] * corners[2]);
      for (std::size_t k = 0; k < 3; ++k) sums[k] += w[k] * here;
    });
    for (std::size_t k = 0; k < 3; ++k) {
      if (sums[k] > 0.0)
        stiffness[surface_.triangles[t][k]] += surface_.areas[t] / (kParts * kParts) * sums[k];
    }
  }
  for (const auto& [i, k] : stiffness) springs_.push_back({holder, i, k, node(positions, i)});
}

void SurfaceSprings::detach(std::size_t holder) {
  springs_.erase(std::remove_if(springs_.begin(), springs_.end(),
                                [&](const Spring& spring) { return spring.holder == holder; }),
                 springs_.end());
}

bool SurfaceSprings::is_attached(std::size_t holder) const {
  return std::any_of(springs_.begin(), springs_.end(),
                     [&](const Spring& spring) { return spring.holder == holder; });
}

void SurfaceSprings::move(const Eigen::VectorXd& motion) {
  for (std::size_t i = 0; i < springs_.size(); ++i) springs_[i].target += node(motion, i);
}

double SurfaceSprings::evaluate(const Eigen::VectorXd& positions, Eigen::VectorXd* gradient,
                                Hessian* hessian) const {
  double sum = 0.0;
  for (const Spring& spring : springs_) {
    const Vec3 off = node(positions, spring.node) - spring.target;
    sum += 0.5 * spring.stiffness * off.squaredNorm();
    if (gradient != nullptr) {
      gradient->segment<3>(3 * Eigen::Index{spring.node}) += spring.stiffness * off;
    }
    if (hessian != nullptr) {
      hessian->add(spring.node, spring.node, spring.stiffness * Mat3::Identity());
    }
  }
  return sum;
}

Vec3 SurfaceSprings::force(std::size_t holder, const Eigen::VectorXd& positions) const {
  Vec3 sum = Vec3::Zero();
  for (const Spring& spring : springs_) {
    if (spring.holder != holder) continue;
    sum += spring.stiffness * (node(positions, spring.node) - spring.target);
  }
  return sum;
}

}  // namespace tissue
