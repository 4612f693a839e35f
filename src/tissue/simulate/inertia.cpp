#include "tissue/simulate/inertia.h"

namespace tissue {
namespace {

// ∫ N_a N_b over a tet of 10 nodes by 420 / V (Zienkiewicz and Taylor).
double consistent_share(int a, int b) {
  const bool corner_a = a < 4, corner_b = b < 4;
  if (corner_a && corner_b) return a == b ? 6.0 : 1.0;
  const auto touches = [](const auto& edge, int corner) {
    return edge[0] == corner || edge[1] == corner;
  };
  if (corner_a || corner_b) {
    const int corner = corner_a ? a : b, middle = corner_a ? b : a;
    return touches(kTetEdges[middle - 4], corner) ? -4.0 : -6.0;
  }
  if (a == b) return 32.0;
  const auto& edge = kTetEdges[b - 4];
  return touches(kTetEdges[a - 4], edge[0]) || touches(kTetEdges[a - 4], edge[1]) ? 16.0 : 8.0;
}

}  // namespace

Eigen::SparseMatrix<double> mass_matrix(const FiniteElements& elements, double mass_density) {
  std::vector<Eigen::Triplet<double>> entries;
  const int n = elements.nodes_per_element();
  for (std::size_t e = 0; e < elements.element_count(); ++e) {
    const double mass = mass_density * elements.volume(e);
    const std::uint32_t* nodes = elements.nodes(e);
    for (int a = 0; a < n; ++a) {
      if (elements.order() == 1) {
        entries.emplace_back(nodes[a], nodes[a], 0.25 * mass);
        continue;
      }
      for (int b = 0; b < n; ++b) {
        entries.emplace_back(nodes[a], nodes[b], mass * consistent_share(a, b) / 420.0);
      }
    }
  }
  const auto size = static_cast<Eigen::Index>(elements.node_count());
  Eigen::SparseMatrix<double> result(size, size);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

Eigen::VectorXd times_mass(const Eigen::SparseMatrix<double>& mass, const Eigen::VectorXd& x) {
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>> rows(
      x.data(), x.size() / 3, 3);
  Eigen::VectorXd result(x.size());
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>> products(result.data(),
                                                                                 x.size() / 3, 3);
  products.noalias() = mass * rows;
  return result;
}

void InertiaEnergy::begin_step(const Eigen::VectorXd& positions, const Eigen::VectorXd& velocities,
                               double h) {
  free_flight_ = positions + h * velocities;
  h_ = h;
}

double InertiaEnergy::value(const Eigen::VectorXd& positions) const {
  const Eigen::VectorXd off = positions - free_flight_;
  return 0.5 / (h_ * h_) * off.dot(times_mass(mass_, off));
}

void InertiaEnergy::add_gradient(const Eigen::VectorXd& positions,
                                 Eigen::VectorXd& gradient) const {
  gradient += times_mass(mass_, positions - free_flight_) / (h_ * h_);
}

void InertiaEnergy::add_hessian(const Eigen::VectorXd&, BlockMatrix& hessian) const {
  add_scaled_mass(mass_, 1.0 / (h_ * h_), hessian);
}

std::size_t InertiaEnergy::bytes() const {
  return static_cast<std::size_t>(mass_.nonZeros()) * (sizeof(double) + sizeof(int)) +
         static_cast<std::size_t>(free_flight_.size()) * sizeof(double);
}

void add_scaled_mass(const Eigen::SparseMatrix<double>& mass, double factor, BlockMatrix& matrix) {
  for (int column = 0; column < mass.outerSize(); ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(mass, column); entry; ++entry) {
      if (entry.row() < column) continue;
      matrix.add(static_cast<std::uint32_t>(entry.row()), static_cast<std::uint32_t>(column),
                 factor * entry.value() * Mat3::Identity());
    }
  }
}

}  // namespace tissue
