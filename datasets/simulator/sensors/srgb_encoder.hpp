// Table for the conversion of light to grey levels.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "datasets/simulator/texture/texture.hpp"

namespace fusebench::simulator::sensors {

/// Grey levels (0 to 255, not rounded) of linear light by a table, with an error below 0.01 grey levels.
class SrgbEncoder {
 public:
  static const SrgbEncoder& instance() {
    static const SrgbEncoder encoder;
    return encoder;
  }

  struct Encoded {
    float grey = 0;
    float slope = 0;  ///< grey levels per unit of light
  };
  [[nodiscard]] Encoded operator()(float light) const {
    const float at = std::clamp(light, 0.0F, 1.0F) * kCells;
    const std::size_t cell = std::min(static_cast<std::size_t>(at), grey_.size() - 2);
    const float step = grey_[cell + 1] - grey_[cell];
    return {grey_[cell] + (at - static_cast<float>(cell)) * step, step * kCells};
  }

 private:
  SrgbEncoder() {
    for (std::size_t i = 0; i < grey_.size(); ++i) {
      grey_[i] = static_cast<float>(255.0 * texture::srgb_from_linear(static_cast<double>(i) / kCells));
    }
  }

  static constexpr int kCells = 4096;
  std::array<float, kCells + 1> grey_{};
};

}  // namespace fusebench::simulator::sensors
