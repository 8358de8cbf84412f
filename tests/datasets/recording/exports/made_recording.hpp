// A recording in memory for tests of exports: every pixel differs, and depth has values that formats cannot
// hold.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "datasets/recording/recording.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench::testing {

inline constexpr std::int64_t kMadeFirst_ns = 1'000'000'000'000;
inline constexpr std::int64_t kMadePeriod_ns = 40'000'000;
inline constexpr std::int64_t kMadeDepthLater_ns = 2'000'000;

/// Depth in whole millimetres, which 1000 and 5000 units a metre hold exactly; in the first row 40 m, 70 m
/// and 0.05 mm at pixels 1 to 3, in the second 20 m at pixel 1; no measurement at every fifth pixel.
inline RgbdFrame made_frame(int width_px, int height_px, int k) {
  RgbdFrame frame;
  frame.timestamp_ns = kMadeFirst_ns + k * kMadePeriod_ns;
  frame.depth_offset_ns = kMadeDepthLater_ns;
  frame.color = ColorImage(width_px, height_px);
  frame.depth_m = DepthImage(width_px, height_px);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      frame.color(x, y) = {static_cast<std::uint8_t>(2 * x + 9 * k), static_cast<std::uint8_t>(3 * y),
                           static_cast<std::uint8_t>(x + y)};
      const int millimetres = (x + y) % 5 == 0 ? 0 : 500 + (31 * x + 17 * y + 13 * k) % 4000;
      frame.depth_m(x, y) = static_cast<float>(millimetres) / 1000.0F;
    }
  }
  frame.depth_m(1, 0) = 40;
  frame.depth_m(2, 0) = 70;
  frame.depth_m(3, 0) = 0.00005F;
  frame.depth_m(1, 1) = 20;
  frame.grey = to_grey(frame.color);
  return frame;
}

/// `count` frames of made_frame(), and their truth: the camera moves along x.
inline recording::Recording made_recording(int width_px, int height_px, int count) {
  recording::Recording recording = recording::named_recording("made", "made");
  recording.rig.camera = {width_px, height_px, 525, 524.5, 3.5, 2.25};
  for (int k = 0; k < count; ++k) {
    recording::FrameEntry entry;
    entry.timestamp_ns = entry.capture_ns = kMadeFirst_ns + k * kMadePeriod_ns;
    entry.depth_timestamp_ns = entry.depth_capture_ns = entry.timestamp_ns + kMadeDepthLater_ns;
    recording.frames.push_back(entry);
    recording.ground_truth.push_back({entry.timestamp_ns, {Quaterniond::Identity(), {0.25 * k, -0.5, 2}}});
  }
  recording.load_frame = [=](std::size_t k) -> Result<RgbdFrame> {
    return made_frame(width_px, height_px, static_cast<int>(k));
  };
  return recording;
}

/// Adds inertial samples at 100 Hz around the frames; the IMU's axes are x forward, y left, z up.
inline void add_made_imu(recording::Recording& recording) {
  recording.imu_source = recording::ImuSource::recorded;
  Matrix3d R_imu_camera;
  R_imu_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  recording.rig.T_imu_camera = {Quaterniond(R_imu_camera), {0.125, -0.25, 0.5}};
  recording.rig.imu_noise = {0.001, 0.02, 0.00005, 0.0006};
  for (int i = 0; i <= 40; ++i) {
    recording.imu.push_back(
        {kMadeFirst_ns - 100'000'000 + i * 10'000'000, {0.5, -0.25, 0.125 * i}, {0, 0, 9.75}});
  }
}

/// Every file below a folder, by its relative name.
inline std::map<std::string, std::string> files_below(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file())
      files[std::filesystem::relative(entry.path(), folder).string()] = read_bytes(entry.path());
  }
  return files;
}

/// The depth of a made frame as 16-bit values; what is farther than `most` or rounds to 0 is 0.
inline Image<std::uint16_t> stored_depth(const RgbdFrame& frame, double units_per_metre, double most) {
  Image<std::uint16_t> values(frame.depth_m.width, frame.depth_m.height);
  for (std::size_t i = 0; i < values.data.size(); ++i) {
    const double value = std::round(static_cast<double>(frame.depth_m.data[i]) * units_per_metre);
    values.data[i] = static_cast<std::uint16_t>(value <= most ? value : 0);
  }
  return values;
}

}  // namespace fusebench::testing
