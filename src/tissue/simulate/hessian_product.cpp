#include "hessian_product.h"

#include "element_lanes.h"
#include "material_tensor.h"
#include "tissue/simulate/mass_matrix.h"

namespace tissue {

void HessianProduct::add(std::uint32_t a, std::uint32_t b, const Mat3& block) {
  const Eigen::Index i = 3 * Eigen::Index{a}, j = 3 * Eigen::Index{b};
  result_.segment<3>(i) += block * x_.segment<3>(j);
  if (a != b) result_.segment<3>(j) += block.transpose() * x_.segment<3>(i);
}

void HessianProduct::add_mass(const MassMatrix& mass, double factor) {
  result_ += factor * mass.times(x_);
}

void HessianProduct::add_elements(std::size_t first_pack,
                                  const std::vector<MaterialTensor>& tensors) {
  elements_.order() == 1 ? add_elements_of_order<1>(first_pack, tensors)
                         : add_elements_of_order<2>(first_pack, tensors);
}

template <int order>
void HessianProduct::add_elements_of_order(std::size_t first_pack,
                                           const std::vector<MaterialTensor>& tensors) {
  const std::vector<QuadraturePoint>& points = elements_.quadrature();
  for (std::size_t i = 0; i < tensors.size() / points.size(); ++i) {
    const FiniteElements::Pack& pack = elements_.pack(first_pack + i);
    Lanes nodes[kNodes<order>][3], forces[kNodes<order>][3] = {};
    gather<order>(elements_, first_pack + i, x_, nodes);
    for (std::size_t q = 0; q < points.size(); ++q) {
      const LaneMatrix<Lanes> change = gradient_at<order>(points[q], pack.gradients, nodes);
      add_forces<order>(points[q], pack.gradients, product(tensors[i * points.size() + q], change),
                        forces);
    }
    scatter<order>(elements_, first_pack + i, forces, result_);
  }
}

void ScaledHessian::add_elements(std::size_t first_pack,
                                 const std::vector<MaterialTensor>& tensors) {
  std::vector<MaterialTensor> scaled = tensors;
  for (MaterialTensor& tensor : scaled) scale(tensor, all_lanes(factor_));
  to_.add_elements(first_pack, scaled);
}

}  // namespace tissue
