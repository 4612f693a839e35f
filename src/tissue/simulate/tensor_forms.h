#pragma once

#include "material_tensor.h"

#include <Eigen/Geometry>

namespace tissue {

/// What is kept of a material's tensor at a quadrature point of eight elements, in single
/// precision, and how it answers a change of F. Rotations are quaternions (x, y, z, w), symmetric
/// matrices come without their lower half.

inline LaneMatrix<FloatLanes> rotation_of(const FloatLanes (&q)[4]) {
  const FloatLanes x = q[0] + q[0], y = q[1] + q[1], z = q[2] + q[2];
  const FloatLanes xx = x * q[0], yy = y * q[1], zz = z * q[2];
  const FloatLanes xy = x * q[1], xz = x * q[2], yz = y * q[2];
  const FloatLanes wx = x * q[3], wy = y * q[3], wz = z * q[3];
  return {{{1.0f - (yy + zz), xy - wz, xz + wy},
           {xy + wz, 1.0f - (xx + zz), yz - wx},
           {xz - wy, yz + wx, 1.0f - (xx + yy)}}};
}

/// From one lane to another.
inline void store_rotation(const LaneMatrix<Lanes>& rotation, std::size_t from, std::size_t to,
                           FloatLanes (&q)[4]) {
  Mat3 one;
  for_entries([&](int i, int j) { one(i, j) = rotation[i][j][from]; });
  const Eigen::Quaterniond quaternion(one);
  for (int k = 0; k < 4; ++k) q[k][to] = static_cast<float>(quaternion.coeffs()[k]);
}

/// What is kept of a material's tensor at a quadrature point of eight elements, in single
/// precision, and how it answers a change of F, for any isotropic energy. Rotations are quaternions
/// (x, y, z, w), symmetric matrices come without their lower half.
struct StretchForm {
  FloatLanes u[4], v[4], scaling[6], own[3], crossed[3];

  /// In the lanes from `first` on.
  void store(const MaterialTensor& tensor, std::size_t first) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t to = first + lane;
      store_rotation(tensor.u, lane, to, u);
      store_rotation(tensor.v, lane, to, v);
      int next = 0;
      for (int k = 0; k < 3; ++k) {
        own[k][to] = static_cast<float>(tensor.own[k][lane]);
        crossed[k][to] = static_cast<float>(tensor.crossed[k][lane]);
        for (int j = k; j < 3; ++j) {
          scaling[next++][to] = static_cast<float>(tensor.scaling[k][j][lane]);
        }
      }
    }
  }

  LaneMatrix<FloatLanes> stress(const LaneMatrix<FloatLanes>& change) const {
    MaterialTensorOf<FloatLanes> tensor;
    tensor.u = rotation_of(u);
    tensor.v = rotation_of(v);
    int next = 0;
    for (int k = 0; k < 3; ++k) {
      tensor.own[k] = own[k];
      tensor.crossed[k] = crossed[k];
      for (int j = k; j < 3; ++j) tensor.scaling[k][j] = tensor.scaling[j][k] = scaling[next++];
    }
    return product(tensor, change);
  }
};

/// The same for energies whose answer to a strain is the same in all directions, and which only
/// turns make different: small strain, as it is or turned along. With D = Rᵀ dF it is R (2μ sym D +
/// λ tr D I + [T ω]×), where ω is the axis of the skew part of D and T what resists turning.
struct TurnedForm {
  FloatLanes rotation[4], turning[6], double_mu, lambda;

  void store(const MaterialTensor& tensor, std::size_t first) {
    const LaneMatrix<Lanes> turn = product_transpose(tensor.u, tensor.v);
    LaneMatrix<Lanes> scaled;
    for_entries(
        [&](int i, int k) { scaled[i][k] = (tensor.own[k] - tensor.crossed[k]) * tensor.v[i][k]; });
    const LaneMatrix<Lanes> resists = product_transpose(scaled, tensor.v);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t to = first + lane;
      store_rotation(turn, lane, to, rotation);
      int next = 0;
      for (int k = 0; k < 3; ++k) {
        for (int j = k; j < 3; ++j) turning[next++][to] = static_cast<float>(resists[k][j][lane]);
      }
      lambda[to] = static_cast<float>(tensor.scaling[0][1][lane]);
      double_mu[to] = static_cast<float>(tensor.scaling[0][0][lane] - tensor.scaling[0][1][lane]);
    }
  }

  LaneMatrix<FloatLanes> stress(const LaneMatrix<FloatLanes>& change) const {
    const LaneMatrix<FloatLanes> r = rotation_of(rotation);
    const LaneMatrix<FloatLanes> d = transpose_product(r, change);
    // Halves of the skew part's axis.
    const FloatLanes x = 0.5f * (d[2][1] - d[1][2]), y = 0.5f * (d[0][2] - d[2][0]),
                     z = 0.5f * (d[1][0] - d[0][1]);
    const FloatLanes tx = turning[0] * x + turning[1] * y + turning[2] * z,
                     ty = turning[1] * x + turning[3] * y + turning[4] * z,
                     tz = turning[2] * x + turning[4] * y + turning[5] * z;
    const FloatLanes pressure = lambda * (d[0][0] + d[1][1] + d[2][2]), mu = 0.5f * double_mu;
    const FloatLanes xy = mu * (d[0][1] + d[1][0]), xz = mu * (d[0][2] + d[2][0]),
                     yz = mu * (d[1][2] + d[2][1]);
    const LaneMatrix<FloatLanes> answer = {{{double_mu * d[0][0] + pressure, xy - tz, xz + ty},
                                            {xy + tz, double_mu * d[1][1] + pressure, yz - tx},
                                            {xz - ty, yz + tx, double_mu * d[2][2] + pressure}}};
    return product(r, answer);
  }
};

}  // namespace tissue
