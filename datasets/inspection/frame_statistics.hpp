// Statistics of a single frame: exposure, sharpness and depth.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/types.hpp"
#include "datasets/inspection/inspection.hpp"

namespace fusebench::inspection {

struct MeasuredFrame {
  FrameStatistics statistics;  ///< frame and time_s are left to the caller
  std::array<std::uint64_t, kDepthBins> histogram{};
  std::uint64_t measured = 0;  ///< pixels with depth
  std::uint64_t beyond_10m = 0;
  std::uint64_t below_quarter_metre = 0;
  float depth_min_m = 0;  ///< of measured pixels
};

[[nodiscard]] MeasuredFrame measure_frame(const RgbdFrame& frame);

}  // namespace fusebench::inspection
