#include "eval/frame_table.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/trajectory_file.hpp"
#include "eval/intensity_metrics.hpp"

namespace fusebench {

namespace {

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
      "frame,timestamp,status,health,reason,patches,patches_tracked,patches_accepted,patches_shrunk,patches_"
      "extended,"
      "pixels_photometric,pixels_geometric,aie_grey,aie_pixels,iterations,converged,chi2_photometric,chi2_"
      "geometric,variance_photometric,variance_geometric,"
      "speed_mps,angular_speed_radps,blur_px,patch_motion_px,position_sigma_m,rotation_sigma_rad,"
      "imu_time_offset_s,model_blocks,decode_ms";
  for (const std::string_view stage : kStageNames) header += fmt::format(",{}_ms", stage);
  return header + "\n";
}

std::string frame_table_row(std::size_t frame, const FrameReport& report, double decode_ms) {
  const double angular_speed = report.angular_velocity_radps.norm();
  // Of the longest axis: what a reader wants to know of an ellipsoid.
  const auto sigma = [&](int offset) {
    const Matrix3d block = report.estimate.covariance.block<3, 3>(offset, offset);
    return std::sqrt(Eigen::SelfAdjointEigenSolver<Matrix3d>(block).eigenvalues().maxCoeff());
  };
  std::string row = fmt::format(
      "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{:.3f}", frame,
      stamp_text(report.timestamp_ns), to_string(report.status), to_string(report.health),
      text_cell(report.reason), report.patches, report.patches_tracked, report.patches_accepted,
      report.patches_shrunk, report.patches_extended, report.pixels_photometric, report.pixels_geometric,
      number_cell(frame_intensity_error(report.intensity)), report.intensity.size(), report.iterations,
      report.converged ? 1 : 0, number_cell(report.chi2_photometric), number_cell(report.chi2_geometric),
      number_cell(report.variance_photometric), number_cell(report.variance_geometric),
      number_cell(report.velocity_world_mps.norm()), number_cell(angular_speed), number_cell(report.blur_px),
      number_cell(report.patch_motion_px), number_cell(sigma(kPosition)), number_cell(sigma(kRotation)),
      number_cell(report.estimate.mean.imu_time_offset_s), report.model_blocks, decode_ms);
  for (const double milliseconds : report.stage_ms) row += fmt::format(",{:.3f}", milliseconds);
  return row + "\n";
}

}  // namespace fusebench
