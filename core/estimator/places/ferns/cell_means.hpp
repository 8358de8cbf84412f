// Small images for ferns: means over the cells of a frame.
#pragma once

#include <algorithm>

#include "core/base/image.hpp"

namespace fusebench::ferns {

inline constexpr int kWidth = 80;
inline constexpr int kHeight = 60;
// Thresholds of the depth tests: the depth range of rooms.
inline constexpr double kNearest_m = 0.4;
inline constexpr double kReach_m = 3.6;  ///< range from kNearest_m on

/// The pixels of a cell, at least one: begin and end (exclusive).
struct Cells {
  int begin;
  int end;
};
[[nodiscard]] inline Cells cells_of(int index, int count, int size) {
  const int begin = index * size / count;
  return {begin, std::max(begin + 1, (index + 1) * size / count)};
}

/// Mean of the pixels of each cell that have depth; 0 if none has.
[[nodiscard]] Image<float> mean_depth_m(const DepthImage& depth_m);

}  // namespace fusebench::ferns
