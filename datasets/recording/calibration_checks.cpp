#include "datasets/recording/calibration_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/upper_median.hpp"

namespace fusebench::recording {

namespace {

constexpr double kLeastFocal = 0.3;  // of the width: 118 degrees
constexpr double kMostFocal = 5;     // 11 degrees
constexpr double kMostUsualDelay_s = 0.1;
constexpr double kIntervalTolerance = 1.05;  // stamps jitter

/// (0, 0) is the centre of the first pixel.
Result<void> check_centre(std::string_view key, double centre_px, int size_px, const std::string& name) {
  if (centre_px >= -0.5 && centre_px <= size_px - 0.5) return {};
  return fail(
      ErrorCode::data_corrupt,
      fmt::format("{}: {} = {} is outside of the image (allowed -0.5 to {} for {} pixels)", name, key,
                  centre_px, size_px - 0.5, size_px),
      "the intrinsics are of images of another size: scale fx, fy, cx and cy by the ratio of the sizes");
}

Result<void> check_camera(std::string_view table, const PinholeCamera& camera, Recording& recording) {
  const std::string name = fmt::format("{}: camera of {}", recording.name, table);
  if (auto inside = check_centre("cx_px", camera.cx_px, camera.width_px, name); !inside) return inside;
  if (auto inside = check_centre("cy_px", camera.cy_px, camera.height_px, name); !inside) return inside;
  const double share = std::abs(camera.fx_px) / camera.width_px;
  if (share < kLeastFocal || share > kMostFocal)
    recording.warnings.push_back(
        fmt::format("{}: fx_px = {} is {:.2f} times the width of {} pixels (usual are {} to {}): are the "
                    "intrinsics those of "
                    "images of this size?",
                    name, camera.fx_px, share, camera.width_px, kLeastFocal, kMostFocal));
  return {};
}

double median_interval_s(const std::vector<FrameEntry>& frames, std::int64_t FrameEntry::*time_ns) {
  std::vector<std::int64_t> intervals_ns;
  for (std::size_t k = 1; k < frames.size(); ++k) {
    const std::int64_t interval_ns = frames[k].*time_ns - frames[k - 1].*time_ns;
    if (interval_ns > 0) intervals_ns.push_back(interval_ns);  // a depth image may belong to two frames
  }
  if (intervals_ns.empty()) return calibration::kMostReadout_s;
  return 1e-9 * static_cast<double>(upper_median(std::move(intervals_ns)));
}

/// A read-out that is not given is not checked.
Result<void> check_readout(std::string_view table, double readout_s, double sigma_s, double interval_s,
                           const Recording& recording) {
  const bool unknown =
      readout_s == calibration::kUnknownReadout_s && sigma_s == calibration::kUnknownReadoutSigma_s;
  if (unknown || readout_s <= kIntervalTolerance * interval_s) return {};
  return fail(
      ErrorCode::data_corrupt,
      fmt::format("{}: readout_s = {} in [{}] is longer than the interval of the images (allowed 0 to "
                  "{:.4g} s)",
                  recording.name, readout_s, table, interval_s),
      "readout_s is in seconds, from the first to the last row: 0 for a global shutter, at most the "
      "time of a frame");
}

}  // namespace

Result<void> check_calibration(const calibration::RigCalibration& calibration, Recording& recording) {
  if (auto sane = check_camera("colour", calibration.color.pinhole, recording); !sane) return sane;
  if (calibration.depth) {
    if (auto sane = check_camera("depth", calibration.depth->pinhole, recording); !sane) return sane;
  }
  const SensorTiming& timing = calibration.color.timing;
  const double color_s = median_interval_s(recording.frames, &FrameEntry::timestamp_ns);
  const double depth_s = median_interval_s(recording.frames, &FrameEntry::depth_timestamp_ns);
  if (auto sane =
          check_readout("color", timing.color_readout_s, timing.color_readout_sigma_s, color_s, recording);
      !sane)
    return sane;
  if (auto sane =
          check_readout("depth", timing.depth_readout_s, timing.depth_readout_sigma_s, depth_s, recording);
      !sane)
    return sane;
  if (std::abs(timing.depth_delay_s) > kMostUsualDelay_s)
    recording.warnings.push_back(fmt::format(
        "{}: delay_s = {} in [depth]: depth is usually taken within {} s of colour; is the value in seconds?",
        recording.name, timing.depth_delay_s, kMostUsualDelay_s));
  return {};
}

}  // namespace fusebench::recording
