// A depth image in half the memory, for those that are kept and seldom read.
#pragma once

#include <cstdint>

#include "core/base/image.hpp"

namespace fusebench::relocalisation {

/// Depth in steps of 1/65535 of the image's greatest one: of 5 m, to 0.04 mm, a thirtieth of the least noise
/// of a depth sensor. No measurement stays none, and a measurement stays one.
class PackedDepth {
 public:
  PackedDepth() = default;
  /// Depth is finite and not negative.
  explicit PackedDepth(const DepthImage& depth_m);

  [[nodiscard]] DepthImage unpacked_m() const;

 private:
  Image<std::uint16_t> steps_;
  float step_m_ = 0;
};

}  // namespace fusebench::relocalisation
