// Smooth random field over an image.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "datasets/simulator/random/random_numbers.hpp"

namespace fusebench::simulator::random {

/// Standard normal at each pixel, smooth over spacing_px (at least 1): bilinear interpolation of independent
/// values, divided by the root of the sum of squared weights.
class SmoothNoise {
 public:
  SmoothNoise(std::uint64_t key, int spacing_px) : key_(key), spacing_px_(spacing_px) {
    for (int i = 0; i < spacing_px; ++i) {
      const float fraction = static_cast<float>(i) / static_cast<float>(spacing_px);
      const float squares = (1 - fraction) * (1 - fraction) + fraction * fraction;
      weights_.push_back({(1 - fraction) / std::sqrt(squares), fraction / std::sqrt(squares)});
    }
  }

  /// Values of row v (from 0 on), columns 0 to size - 1.
  void row(int v, std::span<float> values) const {
    const int knot_row = v / spacing_px_;
    const Weights down = weights_[static_cast<std::size_t>(v % spacing_px_)];
    const auto between_rows = [&](int column) {
      return down.first * knot(column, knot_row) + down.second * knot(column, knot_row + 1);
    };
    float left = between_rows(0);
    float right = 0;
    for (std::size_t begin = 0, column = 1; begin < values.size(); begin += weights_.size(), ++column) {
      right = between_rows(static_cast<int>(column));
      const std::size_t count = std::min(weights_.size(), values.size() - begin);
      for (std::size_t i = 0; i < count; ++i)
        values[begin + i] = weights_[i].first * left + weights_[i].second * right;
      left = right;
    }
  }

 private:
  struct Weights {
    float first, second;
  };
  [[nodiscard]] float knot(int column, int row) const {
    const auto counter = (static_cast<std::uint64_t>(row) << 32) | static_cast<std::uint64_t>(column);
    return NormalTable::instance()(mix_key(key_, counter));
  }
  std::uint64_t key_;
  int spacing_px_;
  std::vector<Weights> weights_;  // by pixel between two knots
};

}  // namespace fusebench::simulator::random
