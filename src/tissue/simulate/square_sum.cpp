#include "tissue/simulate/hessian.h"

#include <stdexcept>

namespace tissue {

void SquareSum::multiply_add(const Eigen::VectorXd& x, Eigen::VectorXd& result) const {
  for (std::size_t row = 0; row + 1 < begin.size(); ++row) {
    double product = 0.0;
    for (std::uint32_t k = begin[row]; k < begin[row + 1]; ++k) {
      product += values[k].dot(x.segment<3>(3 * Eigen::Index{nodes[k]}));
    }
    for (std::uint32_t k = begin[row]; k < begin[row + 1]; ++k) {
      result.segment<3>(3 * Eigen::Index{nodes[k]}) += product * values[k];
    }
  }
}

void Hessian::add_squares(const SquareSum&) {
  throw std::logic_error("this Hessian takes no sums over more than elements");
}

}  // namespace tissue
