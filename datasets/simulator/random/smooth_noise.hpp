// A field of random numbers that is smooth over the image.
#pragma once

#include <cmath>
#include <cstdint>

#include "datasets/simulator/random/random_numbers.hpp"

namespace fusebench::simulator::random {

/// Standard normal at every pixel, and smooth over spacing_px (at least 1): bilinear between independent
/// values, scaled by the root of the sum of the squared weights.
class SmoothNoise {
 public:
  SmoothNoise(std::uint64_t key, int spacing_px) : key_(key), spacing_px_(spacing_px) {}

  [[nodiscard]] float at(int u, int v) const {
    const int column = u / spacing_px_;
    const int row = v / spacing_px_;
    const auto spacing = static_cast<float>(spacing_px_);
    const float fx = static_cast<float>(u % spacing_px_) / spacing;
    const float fy = static_cast<float>(v % spacing_px_) / spacing;
    const float top = (1 - fx) * knot(column, row) + fx * knot(column + 1, row);
    const float bottom = (1 - fx) * knot(column, row + 1) + fx * knot(column + 1, row + 1);
    const float squares = ((1 - fx) * (1 - fx) + fx * fx) * ((1 - fy) * (1 - fy) + fy * fy);
    return ((1 - fy) * top + fy * bottom) / std::sqrt(squares);
  }

 private:
  [[nodiscard]] float knot(int column, int row) const {
    const auto counter = (static_cast<std::uint64_t>(row) << 32) | static_cast<std::uint64_t>(column);
    return NormalTable::instance()(mix_key(key_, counter));
  }
  std::uint64_t key_;
  int spacing_px_;
};

}  // namespace fusebench::simulator::random
