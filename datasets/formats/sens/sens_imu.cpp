#include "datasets/formats/sens/sens_imu.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

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
  for (std::size_t k = 1; k < frames.size(); ++k) {
    if (frames[k].timestamp <= frames[k - 1].timestamp) return "their stamps do not rise";
  }
  return {};
}

}  // namespace

Result<void> take_imu_frames(const std::filesystem::path& file,
                             std::span<const image_logs::SensImuFrame> frames,
                             std::int64_t nanoseconds_per_unit, recording::Recording& recording) {
  if (frames.empty()) return {};
  if (const std::string reason = reason_not_to_use(frames); !reason.empty()) {
    recording.warnings.push_back(
        fmt::format("{}: {} inertial frames are not used: {}", file.string(), frames.size(), reason));
    return {};
  }
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
