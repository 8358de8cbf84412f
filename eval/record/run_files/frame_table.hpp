// frames.csv: a row per frame.
//
// Columns: frame, timestamp, status, health and reason, patches (projected, tracked, accepted, shrunk,
// extended), pixels (photometric, geometric), aie_grey and aie_pixels of the frame, iterations, converged,
// chi2 (photometric, geometric), speed_mps, angular_speed_radps, blur_px (predicted), patch_motion_px (median
// since the last frame), position_sigma_m and rotation_sigma_rad (the filter's, longest axis; with model_ in
// front: against the model, which decides whether a pose is accepted),
// imu_time_offset_s, model_blocks; then milliseconds per stage. All but the milliseconds are the same when
// the run is repeated.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "core/estimator/health/frame_report.hpp"

namespace fusebench::run_files {

[[nodiscard]] std::string frame_table_header();

/// One line, with its line break. filter: what else a filter says of the frame; nullptr leaves these cells
/// empty. decode_ms: reading and undistorting the images.
[[nodiscard]] std::string frame_table_row(std::size_t frame, const health::FrameOutcome& outcome,
                                          const health::FrameReport* filter, double decode_ms);

/// A row, as far as reports need it. What the table leaves empty is absent.
struct FrameTableRow {
  /// False of a frame that is lost, or tracked apart from the map.
  [[nodiscard]] bool is_in_map() const { return status != "lost" && status != "other-segment"; }

  std::int64_t timestamp_ns = 0;
  std::string status;
  std::string health;
  double patches_accepted = 0;
  std::optional<double> aie_grey;
  double speed_mps = 0;
  double angular_speed_radps = 0;
  double blur_px = 0;
  double patch_motion_px = 0;
  double position_sigma_m = 0;
};

/// Reads a table; columns go by their names, and others are skipped. Errors: data_missing; data_corrupt (a
/// column that is not there, a row of another length, what is no number).
[[nodiscard]] Result<std::vector<FrameTableRow>> read_frame_table(const std::filesystem::path& file);

}  // namespace fusebench::run_files
