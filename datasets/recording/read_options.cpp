#include "datasets/recording/read_options.hpp"

#include <fmt/format.h>

namespace fusebench::recording {

Result<void> check_read_options(const ReadOptions& options) {
  if (const auto& units = options.depth_units_per_metre; units && !calibration::is_units_per_metre(*units))
    return calibration::no_units_per_metre(ErrorCode::configuration, "depth_units_per_metre (--depth-units)",
                                           *units);
  if (!(options.max_difference_s > 0 && options.max_difference_s <= 1)) {
    return fail(ErrorCode::configuration,
                fmt::format("max_difference_s = {} (allowed: above 0, up to 1)", options.max_difference_s));
  }
  if (const auto& rate_hz = options.frame_rate_hz; rate_hz && !is_frame_rate(*rate_hz))
    return fail(ErrorCode::configuration, fmt::format("frame_rate_hz = {} (allowed: 1 to 1000)", *rate_hz));
  return {};
}

Result<calibration::RigCalibration> choose_calibration(
    const std::filesystem::path& folder, const ReadOptions& options,
    const std::function<Result<calibration::RigCalibration>()>& published, Recording& recording) {
  Result<std::optional<calibration::RigCalibration>> beside;
  if (!options.calibration) beside = calibration::read_calibration_beside(folder);
  if (!beside) return tl::unexpected(beside.error());
  calibration::RigCalibration calibration;
  if (options.calibration) {
    calibration = *options.calibration;
    recording.notes.push_back(
        fmt::format("calibration: as given by the user ({})",
                    calibration.source.empty() ? "no source given" : calibration.source));
  } else if (*beside) {
    calibration = std::move(**beside);
    recording.notes.push_back(
        fmt::format("calibration: calibration.toml in the recording's folder ({})",
                    calibration.source.empty() ? "no source given" : calibration.source));
  } else if (auto known = published()) {
    calibration = std::move(*known);
    if (!calibration.source.empty())
      recording.notes.push_back(fmt::format("calibration: {}", calibration.source));
  } else if (!options.camera || known.error().code != ErrorCode::configuration) {
    return known;  // the user's camera replaces an unknown one, but does not hide an invalid file
  }
  if (options.camera) {
    calibration.color = *options.camera;
    recording.notes.push_back("calibration: the colour camera as given by the user");
  }
  if (options.depth_units_per_metre) calibration.depth_units_per_metre = options.depth_units_per_metre;
  return calibration;
}

}  // namespace fusebench::recording
