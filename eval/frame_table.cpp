#include "eval/frame_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/trajectory_file.hpp"
#include "eval/intensity_metrics.hpp"

namespace fusebench {

namespace {

constexpr double kExposure_s = 0.01;

/// A cell cannot hold a separator, and no number is an empty cell.
std::string text_cell(std::string text) {
  std::replace(text.begin(), text.end(), ',', ';');
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

std::string number_cell(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

}  // namespace

std::string frame_table_header() {
  std::string header =
      "frame,timestamp,status,reason,patches,patches_tracked,patches_accepted,patches_shrunk,patches_"
      "extended,"
      "pixels_photometric,pixels_geometric,aie_grey,aie_pixels,iterations,converged,chi2_photometric,chi2_"
      "geometric,"
      "speed_mps,angular_speed_radps,blur_px,model_blocks,decode_ms";
  for (const std::string_view stage : kStageNames) header += fmt::format(",{}_ms", stage);
  return header + "\n";
}

std::string frame_table_row(std::size_t frame, const FrameReport& report, const PinholeCamera& camera,
                            double decode_ms) {
  const double angular_speed = report.angular_velocity_radps.norm();
  std::string row = fmt::format(
      "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{:.3f}", frame,
      stamp_text(report.timestamp_ns), to_string(report.status), text_cell(report.reason), report.patches,
      report.patches_tracked, report.patches_accepted, report.patches_shrunk, report.patches_extended,
      report.pixels_photometric, report.pixels_geometric,
      number_cell(frame_intensity_error(report.intensity)), report.intensity.size(), report.iterations,
      report.converged ? 1 : 0, number_cell(report.chi2_photometric), number_cell(report.chi2_geometric),
      number_cell(report.velocity_world_mps.norm()), number_cell(angular_speed),
      number_cell(camera.fx_px * angular_speed * kExposure_s), report.model_blocks, decode_ms);
  for (const double milliseconds : report.stage_ms) row += fmt::format(",{:.3f}", milliseconds);
  return row + "\n";
}

}  // namespace fusebench
