#include "datasets/formats/icl/icl_conventions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "datasets/calibration/recording_catalogue.hpp"

namespace fusebench::formats::icl {

std::optional<std::int64_t> icl_index(std::string_view text) {
  const bool digits = !text.empty() && text.size() <= 9 &&
                      std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
  std::int64_t index = 0;
  if (!digits || std::from_chars(text.data(), text.data() + text.size(), index).ec != std::errc())
    return std::nullopt;
  return index;
}

std::int64_t icl_time_ns(std::int64_t index, double rate_hz) {
  return std::llround(1e9 * static_cast<double>(index) / rate_hz);
}

SE3 icl_reflect(const SE3& T_world_camera) {
  const Quaterniond& q = T_world_camera.rotation;
  const Vector3d& t = T_world_camera.translation;
  return {Quaterniond(q.w(), -q.x(), q.y(), -q.z()), {t.x(), -t.y(), t.z()}};
}

calibration::RigCalibration icl_calibration() {
  auto calibration = calibration::catalogue_calibration("icl_nuim");
  check(calibration.has_value(), "the catalogue holds the calibration of ICL-NUIM");
  calibration->depth_units_per_metre.reset();  // that of the PNGs; .depth files have another
  return *std::move(calibration);
}

void add_icl_frames(const std::vector<IclFrame>& frames, const recording::ReadOptions& options,
                    recording::Recording& recording) {
  for (const IclFrame& frame : frames) {
    const std::int64_t time_ns = icl_time_ns(frame.index, options.frame_rate_hz);
    recording.frames.push_back({time_ns, time_ns, time_ns, time_ns, frame.color_file, frame.depth_file});
  }
  recording.notes.push_back(
      fmt::format("time: ICL-NUIM has no stamps; frame k is taken to be at k / {} s", options.frame_rate_hz));
  const std::int64_t span = frames.back().index - frames.front().index + 1;
  const std::int64_t missing = span - static_cast<std::int64_t>(frames.size());
  if (missing > 0) {
    recording.warnings.push_back(fmt::format("{}: {} of the {} frames from {} to {} are not there",
                                             recording.name, missing, span, frames.front().index,
                                             frames.back().index));
  }
}

}  // namespace fusebench::formats::icl
