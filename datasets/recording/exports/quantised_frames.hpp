// The frames of a recording with depth as a format stores it.
#pragma once

#include <cstddef>
#include <functional>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "datasets/recording/exports/export_summary.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::exports {

/// Colour and depth are of one size and one camera (recording.rig.camera, without distortion).
struct QuantisedFrame {
  std::size_t index = 0;  ///< within the recording
  recording::FrameEntry entry;
  ColorImage color;
  GreyImage grey;
  Image<std::uint16_t> depth;  ///< in units of the format, 0 = no measurement
};

/// Depth in metres to the nearest value of the format. What lies beyond its range, or rounds to 0, becomes 0
/// and is counted.
[[nodiscard]] Image<std::uint16_t> quantise_depth(const DepthImage& depth_m, const DepthStorage& storage,
                                                  DepthCounts& counts);

/// Loads all frames in their order, up to the first error. Errors: those of load_frame and of visit.
[[nodiscard]] Result<DepthCounts> for_each_frame(
    const recording::Recording& recording, const DepthStorage& storage,
    const std::function<Result<void>(const QuantisedFrame& frame)>& visit);

}  // namespace fusebench::exports
