#pragma once

#include <array>
#include <cstdint>
#include <variant>
#include <vector>

namespace tissue {

/// One value per voxel, x fastest, in the type in which it came.
using Voxels =
    std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>, std::vector<std::int16_t>,
                 std::vector<std::int32_t>, std::vector<float>, std::vector<double>>;

/// Voxels along each axis.
using GridSize = std::array<std::uint32_t, 3>;

}  // namespace tissue
