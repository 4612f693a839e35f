#include "fold_watch.h"

#include "tissue/base/tet_mesh.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <limits>
#include <utility>

namespace tissue {
namespace {

// Amounts are superposed in single precision.
constexpr double kMargin = 0.99;
// Below this, what a tet's F is at the base says nothing about where it folds.
constexpr double kSingular = 1e-6;

// The edges that leave a tet's first corner, where `place_of` says its corners are.
template <class PlaceOf>
Mat3 edges(const Tet& tet, const PlaceOf& place_of) {
  Mat3 result;
  const Vec3 first = place_of(tet[0]);
  for (int i = 0; i < 3; ++i) result.col(i) = place_of(tet[i + 1]) - first;
  return result;
}

double least_singular_value(const Mat3& f) {
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  solver.computeDirect(f.transpose() * f, Eigen::EigenvaluesOnly);
  return f.determinant() > 0.0 ? std::sqrt(std::max(0.0, solver.eigenvalues()[0])) : 0.0;
}

}  // namespace

bool is_folded(const Tet& tet, const std::vector<Vec3>& vertices) {
  return !(determinant(vertices, tet) > 0.0);
}

FoldWatch::FoldWatch(const Body& body, const Eigen::VectorXd& base,
                     const std::vector<std::vector<float>>& columns,
                     std::vector<Eigen::Index> groups)
    : body_(&body), groups_(std::move(groups)), largest_(groups_.size(), 0.0) {
  std::vector<double> gradients(groups_.size() * body.tets.size());
  for (std::size_t t = 0; t < body.tets.size(); ++t) {
    const Tet& tet = body.tets[t];
    const Mat3 to_rest =
        edges(tet, [&](std::uint32_t v) -> Vec3 { return body.rest[v].cast<double>(); }).inverse();
    const double least = least_singular_value(
        edges(tet, [&](std::uint32_t v) -> Vec3 { return base.segment<3>(3 * v); }) * to_rest);
    std::size_t column = 0;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      double squares = 0.0;
      for (Eigen::Index k = 0; k < groups_[g]; ++k, ++column) {
        const float* const moved = columns[column].data();
        squares += (edges(tet,
                          [&](std::uint32_t v) -> Vec3 {
                            return Eigen::Map<const Vec3f>(moved + 3 * v).cast<double>();
                          }) *
                    to_rest)
                       .squaredNorm();
      }
      double& gradient = gradients[t * groups_.size() + g];
      gradient =
          least > kSingular ? std::sqrt(squares) / least : std::numeric_limits<double>::infinity();
      if (std::isfinite(gradient)) largest_[g] = std::max(largest_[g], gradient);
    }
  }
  for (std::size_t t = 0; t < body.tets.size(); ++t) {
    double part = 0.0;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const double gradient = gradients[t * groups_.size() + g];
      if (gradient > 0.0) part = std::max(part, gradient / largest_[g]);
    }
    tets_.push_back({static_cast<float>(part), static_cast<std::uint32_t>(t)});
  }
  std::stable_sort(tets_.begin(), tets_.end(),
                   [](const Watched& a, const Watched& b) { return a.part > b.part; });
}

bool FoldWatch::any_folded(const Eigen::VectorXd& amounts,
                           const std::vector<Vec3>& vertices) const {
  // What is added to F is at most this much of its least singular value, in any tet.
  double most = 0.0;
  Eigen::Index first = 0;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    most += amounts.segment(first, groups_[g]).norm() * largest_[g];
    first += groups_[g];
  }
  const double enough = kMargin / most;
  for (const Watched& watched : tets_) {
    if (static_cast<double>(watched.part) < enough) break;
    if (is_folded(body_->tets[watched.tet], vertices)) return true;
  }
  return false;
}

}  // namespace tissue
