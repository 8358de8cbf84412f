#include "eval/record/run_files/frame_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/base/trajectory/trajectory_file.hpp"
#include "eval/metrics/intensity_metrics.hpp"
#include "eval/record/run_files/named_rows.hpp"

namespace fusebench::run_files {

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
      "frame,timestamp,status,segment,health,reason,patches,patches_tracked,patches_accepted,patches_shrunk,"
      "patches_"
      "extended,"
      "pixels_photometric,pixels_geometric,aie_grey,aie_pixels,iterations,converged,chi2_photometric,chi2_"
      "geometric,variance_photometric,variance_geometric,"
      "speed_mps,angular_speed_radps,blur_px,patch_motion_px,position_sigma_m,rotation_sigma_rad,model_"
      "position_sigma_m,model_rotation_sigma_rad,"
      "imu_time_offset_s,correlation,model_blocks,decode_ms";
  for (const std::string_view stage : health::kStageNames) header += fmt::format(",{}_ms", stage);
  return header + "\n";
}

namespace {

/// The cells between reason and model_blocks, each with a comma before it.
std::string filter_cells(const health::FrameReport& report) {
  const auto sigma = [&](int offset) {
    return largest_sigma(report.estimate.covariance.block<3, 3>(offset, offset));
  };
  return fmt::format(
      ",{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}", report.patches,
      report.patches_tracked, report.patches_accepted, report.patches_shrunk, report.patches_extended,
      report.pixels_photometric, report.pixels_geometric,
      number_cell(metrics::frame_intensity_error(report.pixels.intensity)), report.pixels.intensity.size(),
      report.iterations, report.converged ? 1 : 0, number_cell(report.chi2_photometric),
      number_cell(report.chi2_geometric), number_cell(report.variance_photometric),
      number_cell(report.variance_geometric), number_cell(report.velocity_world_mps.norm()),
      number_cell(report.angular_velocity_radps.norm()), number_cell(report.blur_px),
      number_cell(report.patch_motion_px), number_cell(sigma(filter::kPosition)),
      number_cell(sigma(filter::kRotation)), number_cell(report.certainty.position_sigma_m),
      number_cell(report.certainty.rotation_sigma_rad), number_cell(report.estimate.mean.imu_time_offset_s),
      report.correlation ? number_cell(*report.correlation) : "");
}
constexpr std::size_t kFilterCells = 25;

}  // namespace

std::string frame_table_row(std::size_t frame, const health::FrameOutcome& outcome,
                            const health::FrameReport* filter, double decode_ms) {
  std::string row =
      fmt::format("{},{},{},{},{},{}", frame, trajectory::stamp_text(outcome.timestamp_ns),
                  health::to_string(outcome.status), outcome.segment,
                  filter != nullptr ? health::to_string(filter->health) : "", text_cell(outcome.reason));
  row += filter != nullptr ? filter_cells(*filter) : std::string(kFilterCells, ',');
  row += fmt::format(",{},{:.3f}", outcome.model_blocks, decode_ms);
  for (const double milliseconds : outcome.stages.sums_ms()) row += fmt::format(",{:.3f}", milliseconds);
  return row + "\n";
}

namespace {

Result<FrameTableRow> row_of(const NamedRow& cells) {
  FrameTableRow row;
  const auto stamp = cells.time_ns("timestamp");
  if (!stamp) return tl::unexpected(stamp.error());
  row.timestamp_ns = *stamp;
  for (const auto& [name, value] : {std::pair{"status", &row.status}, std::pair{"health", &row.health}}) {
    const auto text = cells.text(name);
    if (!text) return tl::unexpected(text.error());
    *value = *text;
  }
  const auto aie = cells.number("aie_grey");
  if (!aie) return tl::unexpected(aie.error());
  row.aie_grey = *aie;
  const std::array<std::pair<const char*, double*>, 6> numbers = {
      {{"patches_accepted", &row.patches_accepted},
       {"speed_mps", &row.speed_mps},
       {"angular_speed_radps", &row.angular_speed_radps},
       {"blur_px", &row.blur_px},
       {"patch_motion_px", &row.patch_motion_px},
       {"position_sigma_m", &row.position_sigma_m}}};
  for (const auto& [name, value] : numbers) {
    const auto number = cells.number(name);
    if (!number) return tl::unexpected(number.error());
    *value = number->value_or(std::nan(""));
  }
  return row;
}

}  // namespace

Result<std::vector<FrameTableRow>> read_frame_table(const std::filesystem::path& file) {
  return read_named_rows(file, row_of);
}

}  // namespace fusebench::run_files
