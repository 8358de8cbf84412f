// Images at the size that ferns ask about: means of cells of the frame's.
#pragma once

#include <algorithm>

#include "core/base/image.hpp"

namespace fusebench::ferns {

inline constexpr int kWidth = 80;
inline constexpr int kHeight = 60;
// Thresholds of tests on depth: what cameras see in rooms.
inline constexpr double kNearest_m = 0.4;
inline constexpr double kReach_m = 3.6;  ///< beyond the nearest

/// The pixels of a cell, at least one: first and one past the last.
struct Cells {
  int begin;
  int end;
};
[[nodiscard]] inline Cells cells_of(int index, int count, int size) {
  const int begin = index * size / count;
  return {begin, std::max(begin + 1, (index + 1) * size / count)};
}

/// Of the pixels of a cell that have depth; 0 where none has.
[[nodiscard]] Image<float> mean_depth_m(const DepthImage& depth_m);

}  // namespace fusebench::ferns
