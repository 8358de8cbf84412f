#include "datasets/recording/recording.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "core/base/io/fingerprint.hpp"

namespace fusebench::recording {

std::string_view to_string(ImuSource source) {
  switch (source) {
    case ImuSource::none:
      return "none";
    case ImuSource::recorded:
      return "recorded";
    case ImuSource::synthetic:
      return "synthetic IMU";
  }
  return "unknown";
}

Recording named_recording(const std::filesystem::path& folder, std::string_view format) {
  const std::filesystem::path whole = std::filesystem::absolute(folder).lexically_normal();
  Recording recording;
  recording.name = (whole.has_filename() ? whole : whole.parent_path()).filename().string();
  recording.format = format;
  return recording;
}

Vector3d ground_truth_offset_m(const Recording& recording) {
  const bool of_camera = !recording.calibration || recording.simulated || !recording.truth_label.empty();
  return of_camera ? Vector3d::Zero() : recording.calibration->color.ground_truth_offset_m;
}

void set_timing(Recording& recording, const SensorTiming& timing) {
  const double later_s = timing.depth_delay_s - recording.rig.timing.depth_delay_s;
  const auto later_ns = static_cast<std::int64_t>(std::llround(1e9 * later_s));
  recording.rig.timing = timing;
  if (recording.calibration) recording.calibration->color.timing = timing;
  for (FrameEntry& frame : recording.frames) frame.depth_capture_ns += later_ns;
  recording.load_frame = [load = std::move(recording.load_frame), later_ns](std::size_t k) {
    auto frame = load(k);
    if (frame) frame->depth_offset_ns += later_ns;
    return frame;
  };
}

Result<void> select_frames(Recording& recording, std::size_t begin, std::size_t end) {
  const std::size_t count = recording.frames.size();
  if (begin >= end || end > count) {
    return fail(ErrorCode::usage,
                fmt::format("frames = {}:{} (allowed A:B with 0 <= A < B <= {})", begin, end, count),
                fmt::format("'{}' has {} frames; A:B takes frames A to B-1", recording.name, count));
  }
  if (begin == 0 && end == count) return {};
  if (recording.whole_frames == 0) recording.whole_frames = count;
  const auto first = recording.frames.begin();
  recording.frames = {first + static_cast<std::ptrdiff_t>(begin), first + static_cast<std::ptrdiff_t>(end)};
  recording.load_frame = [load_whole = std::move(recording.load_frame), begin](std::size_t frame) {
    return load_whole(begin + frame);
  };
  io::Fingerprint part;
  part.add(recording.fingerprint);
  part.add(fmt::format("frames {}:{}", begin, end));
  recording.fingerprint = part.hex();
  return {};
}

}  // namespace fusebench::recording
