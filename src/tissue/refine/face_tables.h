#pragma once

#include "numbering.h"

#include <array>
#include <vector>

namespace tissue {

/// The place in a face's block of the point with weight w[i] on the face's corner i, by which of
/// the corners have the lowest, middle and highest vertex. Read off tables: one for each way the
/// corners can be ordered.
class FaceTables {
 public:
  const std::vector<std::uint32_t>& table(std::uint32_t parts, const std::array<int, 3>& ranks) {
    std::vector<std::uint32_t>& table = tables_[parts_log(parts)][ranks[0] * 3 + ranks[1]];
    if (!table.empty()) return table;
    for (std::uint32_t p = 1; p + 1 < parts; ++p) {
      for (std::uint32_t q = 1; p + q < parts; ++q) {
        const std::array<std::uint32_t, 3> weights = {parts - p - q, p, q};
        std::array<std::uint32_t, 3> by_rank{};
        for (int i = 0; i < 3; ++i) by_rank[ranks[i]] = weights[i];
        table.push_back(face_index(by_rank[1], by_rank[2], parts));
      }
    }
    return table;
  }
  void prepare(std::uint32_t parts) {
    for (const auto& ranks :
         {std::array<int, 3>{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}) {
      table(parts, ranks);
    }
  }

 private:
  static int parts_log(std::uint32_t parts) { return __builtin_ctz(parts); }
  std::array<std::array<std::vector<std::uint32_t>, 9>, 32> tables_;
};

}  // namespace tissue
