// Smooth functions over an image, computed at grid nodes with linear interpolation between them: one or two
// operations a pixel instead of a hundred.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/base/simd/lanes.hpp"

namespace fusebench::preprocessing {

/// `kCount` numbers at every pixel of an image.
template <std::size_t kCount>
class NodeGrid {
 public:
  // Node spacing. A parabola y = c x^2 differs from its chords by at most c 8^2 between rows.
  static constexpr int kColumns = static_cast<int>(simd::kLanes);
  static constexpr int kRows = 16;

  /// solve(u, v): the numbers at eight pixels of a row. Nodes may be outside the image by less than 64
  /// columns and 16 rows.
  template <class Solve>
  NodeGrid(int width, int height, const Solve& solve)
      : nodes_(((width / kColumns + 1 + kColumns - 1) / kColumns) * kColumns),
        values_(static_cast<std::size_t>(nodes_) * static_cast<std::size_t>((height - 1) / kRows + 2) *
                kCount) {
    float* target = values_.data();
    for (int row = 0; row <= (height - 1) / kRows + 1; ++row) {
      for (int node = 0; node < nodes_; node += static_cast<int>(simd::kLanes)) {
        const simd::Float8 u = static_cast<float>(kColumns) * (static_cast<float>(node) + simd::kLaneNumber);
        const std::array<simd::Float8, kCount> solved = solve(u, static_cast<float>(row * kRows));
        for (std::size_t i = 0; i < kCount; ++i)
          simd::store(solved[i], target + static_cast<std::size_t>(nodes_) * i + node);
      }
      target += static_cast<std::size_t>(nodes_) * kCount;
    }
  }

  /// Numbers for eight columns between two rows of nodes.
  struct Cell {
    /// Values `rows` below the upper nodes.
    [[nodiscard]] simd::Float8 at(std::size_t i, float rows) const {
      return simd::multiply_add(rows, steps[i], values[i]);
    }

    std::array<simd::Float8, kCount> values;  ///< at the upper nodes
    std::array<simd::Float8, kCount> steps;   ///< from one row to the next
  };

  /// Cell of eight columns from `column` on and the pixel rows [kRows * cell, kRows * (cell + 1)). If
  /// `column` is not a multiple of eight, the last columns extrapolate from the nodes before them.
  [[nodiscard]] Cell cell(int column, int cell) const {
    const auto nodes = static_cast<std::size_t>(nodes_);
    const float* const upper =
        values_.data() + nodes * kCount * static_cast<std::size_t>(cell) + column / kColumns;
    const simd::Float8 share =
        (static_cast<float>(column % kColumns) + simd::kLaneNumber) * (1.0F / kColumns);
    const auto between = [&](const float* node) {
      return simd::multiply_add(share, simd::all_lanes(node[1] - node[0]), simd::all_lanes(node[0]));
    };
    Cell result;
    for (std::size_t i = 0; i < kCount; ++i) {
      result.values[i] = between(upper + nodes * i);
      result.steps[i] = (between(upper + nodes * (i + kCount)) - result.values[i]) * (1.0F / kRows);
    }
    return result;
  }

 private:
  int nodes_;  ///< of a row
  std::vector<float> values_;
};

}  // namespace fusebench::preprocessing
