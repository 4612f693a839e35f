#pragma once

#include <array>
#include <cstdint>

namespace tissue {

/// Points inside an edge, a face or a tet whose edges are divided into n equal parts, numbered from
/// 0 by arithmetic.

constexpr std::uint32_t edge_points(std::uint32_t n) { return n - 1; }
constexpr std::uint32_t face_points(std::uint32_t n) { return (n - 1) * (n - 2) / 2; }
constexpr std::uint32_t interior_points_count(std::uint32_t n) {
  return n < 4 ? 0 : (n - 1) * (n - 2) / 2 * (n - 3) / 3;
}

/// The point of a face with weights (n − p − q, p, q) on its corners; p, q >= 1 and p + q < n.
constexpr std::uint32_t face_index(std::uint32_t p, std::uint32_t q, std::uint32_t n) {
  return (p - 1) * (n - 1) - (p - 1) * p / 2 + (q - 1);
}

/// The point of a tet with weights (n − p − q − r, p, q, r) on its corners, all at least 1.
constexpr std::uint32_t interior_index(std::uint32_t p, std::uint32_t q, std::uint32_t r,
                                       std::uint32_t n) {
  // Layers of equal p are faces divided into n − p parts.
  return interior_points_count(n) - interior_points_count(n - p + 1) + face_index(q, r, n - p);
}

}  // namespace tissue
