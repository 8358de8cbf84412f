#include "datasets/recording/formats/sens/sens_imu.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "datasets/recording/formats/sens/sens_stamps.hpp"
#include "datasets/recording/sensor_columns.hpp"

namespace fusebench::formats::sens {

namespace {

constexpr double kStandardGravity_mps2 = 9.80665;  // Core Motion's unit of acceleration
constexpr double kGravityTolerance = 0.05;

std::string reason_not_to_use(std::span<const image_logs::SensImuFrame> frames) {
  const auto has_unit_gravity = [](const image_logs::SensImuFrame& frame) {
    return std::abs(frame.gravity.norm() - 1) < kGravityTolerance;
  };
  const auto like_core_motion = std::ranges::count_if(frames, has_unit_gravity);
  if (2 * like_core_motion < std::ssize(frames))
    return "their gravity is not of unit length, so their units are not known";
  return {};
}

/// Those whose stamps rise, a warning about the others; empty if these are too many.
std::vector<image_logs::SensImuFrame> rising_frames(const std::filesystem::path& file,
                                                    std::span<const image_logs::SensImuFrame> frames,
                                                    recording::Recording& recording) {
  std::vector<std::uint64_t> stamps;
  for (const image_logs::SensImuFrame& frame : frames) stamps.push_back(frame.timestamp);
  const std::vector<std::size_t> rising = rising_stamps(stamps);
  const bool enough = enough_rise(rising.size(), stamps.size());
  if (rising.size() < stamps.size())
    recording.warnings.push_back(
        fmt::format("{}: {} of {} inertial frames are not used: their stamps do not rise", file.string(),
                    enough ? stamps.size() - rising.size() : stamps.size(), stamps.size()));
  std::vector<image_logs::SensImuFrame> kept;
  if (!enough) return kept;
  for (const std::size_t k : rising) kept.push_back(frames[k]);
  return kept;
}

}  // namespace

Result<void> take_imu_frames(const std::filesystem::path& file, std::span<const image_logs::SensImuFrame> all,
                             std::int64_t nanoseconds_per_unit, recording::Recording& recording) {
  if (all.empty()) return {};
  if (const std::string reason = reason_not_to_use(all); !reason.empty()) {
    recording.warnings.push_back(
        fmt::format("{}: {} inertial frames are not used: {}", file.string(), all.size(), reason));
    return {};
  }
  const auto frames = rising_frames(file, all, recording);
  if (frames.empty()) return {};
  constexpr double kMost_ns = static_cast<double>(std::numeric_limits<std::int64_t>::max()) / 4;
  std::vector<ImuSample> samples;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const double time_ns =
        static_cast<double>(frames[k].timestamp) * static_cast<double>(nanoseconds_per_unit);
    const Vector3d force_mps2 = -kStandardGravity_mps2 * (frames[k].acceleration + frames[k].gravity);
    const bool possible =
        frames[k].rotation_rate.cwiseAbs().maxCoeff() <= recording::kMaxAngularVelocity_radps &&
        force_mps2.cwiseAbs().maxCoeff() <= recording::kMaxSpecificForce_mps2 && time_ns <= kMost_ns;
    if (!possible)
      return fail(ErrorCode::data_corrupt,
                  fmt::format("{}: inertial frame {} has values that no sensor measures", file.string(), k));
    samples.push_back({static_cast<std::int64_t>(frames[k].timestamp) * nanoseconds_per_unit,
                       frames[k].rotation_rate, force_mps2});
  }
  recording.imu = std::move(samples);
  recording.imu_source = recording::ImuSource::recorded;
  return {};
}

}  // namespace fusebench::formats::sens
