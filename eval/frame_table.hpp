// frames.csv: a row per frame.
//
// Columns: frame, timestamp, status, health and reason, patches (projected, tracked, accepted, shrunk,
// extended), pixels (photometric, geometric), aie_grey and aie_pixels of the frame, iterations, converged,
// chi2 (photometric, geometric), speed_mps, angular_speed_radps, blur_px (predicted), patch_motion_px (median
// since the last frame), position_sigma_m and rotation_sigma_rad (the filter's, longest axis),
// imu_time_offset_s, model_blocks; then milliseconds per stage. All but the milliseconds are the same when
// the run is repeated.
#pragma once

#include <string>

#include "core/pipeline.hpp"
#include "core/types.hpp"

namespace fusebench {

[[nodiscard]] std::string frame_table_header();

/// One line, with its line break. decode_ms: reading and undistorting the images.
[[nodiscard]] std::string frame_table_row(std::size_t frame, const FrameReport& report, double decode_ms);

}  // namespace fusebench
