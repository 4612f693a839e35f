#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstdint>

namespace tissue {

using Vec3 = Eigen::Vector3d;
using Vec3f = Eigen::Vector3f;
using Mat3 = Eigen::Matrix3d;

/// Indices of the four vertices. The volume det(b − a, c − a, d − a)/6 is positive.
using Tet = std::array<std::uint32_t, 4>;

/// Indices of the three vertices; seen from outside the body they run counter-clockwise.
using Triangle = std::array<std::uint32_t, 3>;

/// Indices of the two ends.
using Edge = std::array<std::uint32_t, 2>;

/// The six edges of a tet by its corners: edge e joins corners kTetEdges[e][0] < kTetEdges[e][1].
constexpr std::array<std::array<int, 2>, 6> kTetEdges = {
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

/// The four faces of a tet: face f lies opposite corner f; its corners ascend.
constexpr std::array<std::array<int, 3>, 4> kTetFaces = {
    {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}}};

/// The same faces, each counter-clockwise seen from outside a tet of positive volume.
constexpr std::array<std::array<int, 3>, 4> kOutwardFaces = {
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// The edge that joins two different corners of a tet.
constexpr int tet_edge(int a, int b) {
  constexpr int table[4][4] = {{-1, 0, 1, 2}, {0, -1, 3, 4}, {1, 3, -1, 5}, {2, 4, 5, -1}};
  return table[a][b];
}

}  // namespace tissue
