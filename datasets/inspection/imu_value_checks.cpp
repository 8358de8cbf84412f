// The IMU's values on their own: range, repeated values, units, and what it reads at rest.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/geometry.hpp"
#include "datasets/inspection/checks.hpp"
#include "datasets/inspection/measures/imu_faults.hpp"
#include "datasets/inspection/measures/order_statistics.hpp"

namespace fusebench::inspection {

namespace {

// A sensor at the end of its range repeats that value. No sensor's range ends below these, so repeated
// extremes there are not looked at.
constexpr double kMinGyroscopeRange_radps = radians(120);
constexpr double kMinAccelerometerRange_mps2 = 15;
constexpr std::size_t kPlateau = 3;
constexpr std::size_t kWindowBlocks = 6;
constexpr double kBlock_s = 0.125;

using SampleVector = Vector3d ImuSample::*;

/// Longest run of samples of one axis that lie within 0.1 % of its extreme.
std::size_t longest_plateau(const std::vector<ImuSample>& samples, SampleVector member, Eigen::Index axis,
                            double extreme) {
  std::size_t longest = 0, current = 0;
  for (const ImuSample& sample : samples) {
    const double value = (sample.*member)[axis];
    current = std::abs(value - extreme) <= 1e-3 * std::abs(extreme) ? current + 1 : 0;
    longest = std::max(longest, current);
  }
  return longest;
}

void check_range(const std::vector<ImuSample>& samples, SampleVector member, double min_range,
                 std::string_view code, std::string_view unit, double per_unit, Inspection& out) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      double extreme = 0;
      for (const ImuSample& sample : samples) extreme = std::max(extreme, sign * (sample.*member)[axis]);
      if (extreme < min_range) continue;
      const std::size_t plateau = longest_plateau(samples, member, axis, sign * extreme);
      if (plateau < kPlateau) continue;
      out.add(code, Severity::warning,
              fmt::format("axis {} stays at its extreme of {:.4g} {} for {} samples: the end of its range",
                          "xyz"[axis], sign * extreme * per_unit, unit, plateau),
              "motion is underestimated there; use --frames A:B to keep out of it");
      return;
    }
  }
}

std::size_t longest_repeat(const std::vector<ImuSample>& samples) {
  std::size_t longest = 1, current = 1;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const bool equal = samples[i].angular_velocity_radps == samples[i - 1].angular_velocity_radps &&
                       samples[i].specific_force_mps2 == samples[i - 1].specific_force_mps2;
    current = equal ? current + 1 : 1;
    longest = std::max(longest, current);
  }
  return longest;
}

struct Block {
  Vector3d angular_velocity_radps = Vector3d::Zero();
  Vector3d specific_force_mps2 = Vector3d::Zero();
};

/// Means over consecutive eighths of a second.
std::vector<Block> blocks_of(const std::vector<ImuSample>& samples) {
  std::vector<Block> blocks;
  std::size_t i = 0;
  while (i < samples.size()) {
    const std::int64_t end_ns = samples[i].timestamp_ns + std::llround(1e9 * kBlock_s);
    Block block;
    int count = 0;
    for (; i < samples.size() && samples[i].timestamp_ns < end_ns; ++i, ++count) {
      block.angular_velocity_radps += samples[i].angular_velocity_radps;
      block.specific_force_mps2 += samples[i].specific_force_mps2;
    }
    blocks.push_back({block.angular_velocity_radps / count, block.specific_force_mps2 / count});
  }
  return blocks;
}

struct Rest {
  Vector3d angular_velocity_radps = Vector3d::Zero();
  Vector3d specific_force_mps2 = Vector3d::Zero();
  int windows = 0;
};

/// Mean over all windows of 0.75 s in which nothing moves beyond the sensor's noise.
std::optional<Rest> find_rest(const std::vector<Block>& blocks, const ImuNoise& noise) {
  const double gyroscope_limit = 0.008 + 2 * noise.gyroscope_radps_sqrthz / std::sqrt(kBlock_s);
  const double accelerometer_limit = 0.05 + 2 * noise.accelerometer_mps2_sqrthz / std::sqrt(kBlock_s);
  Rest rest;
  for (std::size_t first = 0; first + kWindowBlocks <= blocks.size(); ++first) {
    Block mean;
    for (std::size_t i = first; i < first + kWindowBlocks; ++i) {
      mean.angular_velocity_radps += blocks[i].angular_velocity_radps / kWindowBlocks;
      mean.specific_force_mps2 += blocks[i].specific_force_mps2 / kWindowBlocks;
    }
    bool still = mean.angular_velocity_radps.norm() < 0.1;
    for (std::size_t i = first; i < first + kWindowBlocks; ++i) {
      still = still &&
              (blocks[i].angular_velocity_radps - mean.angular_velocity_radps).norm() < gyroscope_limit &&
              (blocks[i].specific_force_mps2 - mean.specific_force_mps2).norm() < accelerometer_limit;
    }
    if (!still) continue;
    rest.angular_velocity_radps += mean.angular_velocity_radps;
    rest.specific_force_mps2 += mean.specific_force_mps2;
    ++rest.windows;
  }
  if (rest.windows == 0) return std::nullopt;
  rest.angular_velocity_radps /= rest.windows;
  rest.specific_force_mps2 /= rest.windows;
  return rest;
}

/// A unit that an accelerometer's values may be in.
struct AccelerometerUnit {
  double mps2;  ///< of 1
  std::string_view text;
};
constexpr std::array<AccelerometerUnit, 3> kAccelerometerUnits = {
    AccelerometerUnit{9.80665, "units of gravity"}, AccelerometerUnit{0.3048, "ft/s^2"},
    // cm/s^2 differ from it by 2 %, which is less than the acceleration of a hand.
    AccelerometerUnit{0.00980665, "thousandths of gravity (or cm/s^2)"}};

/// Units by the median magnitude of the specific force, which in a hand is that of gravity.
void check_accelerometer_unit(ImuMeasurement& imu, Inspection& out) {
  const double force = imu.specific_force_median_mps2;
  for (const AccelerometerUnit& unit : kAccelerometerUnits) {
    if (force * unit.mps2 < 0.8 * kGravity_mps2 || force * unit.mps2 > 1.25 * kGravity_mps2) continue;
    imu.accelerometer_unit = unit.mps2;
    out.add("accelerometer-unit", Severity::error,
            fmt::format("the median specific force is {:.4g}: the values are in {}", force, unit.text),
            fmt::format("multiply them by {:.7g}", unit.mps2));
    return;
  }
  if (force < 6) {
    imu.accelerometer_unit = 0;
    out.add(
        "accelerometer-without-gravity", Severity::error,
        fmt::format(
            "the median specific force is {:.2f} m/s^2: gravity has been taken out, or the unit is another",
            force),
        "the estimator needs the raw specific force, which is 9.81 m/s^2 upwards at rest");
  } else if (force > 16) {
    imu.accelerometer_unit = 0;
    out.add("accelerometer-unit", Severity::error,
            fmt::format("the median specific force is {:.3g} m/s^2, far from gravity's 9.81", force),
            "check the unit of the accelerometer");
  }
}

}  // namespace

std::optional<recording::Recording> leave_out_imu_faults(const recording::Recording& recording,
                                                         Inspection& out) {
  if (!out.imu || out.has("imu-out-of-order")) return std::nullopt;
  const std::vector<measures::ImuFault> faults = measures::find_imu_faults(recording.imu);
  if (faults.empty()) return std::nullopt;
  constexpr std::size_t kMaxListed = 3;
  std::string told;
  for (std::size_t i = 0; i < std::min(kMaxListed, faults.size()); ++i)
    told += (i == 0 ? "" : ", ") + measures::describe(faults[i], recording.imu);
  if (faults.size() > kMaxListed) told += fmt::format(", and {} more", faults.size() - kMaxListed);
  out.add("imu-spike", Severity::warning,
          fmt::format("{} of {} samples are no measurement: {}", faults.size(), recording.imu.size(), told),
          "remove their rows from the IMU's file; the other checks of the IMU exclude them");
  recording::Recording sound = recording;
  sound.imu = measures::without_faults(recording.imu, faults);
  return sound;
}

void check_imu_values(const recording::Recording& recording, Inspection& out) {
  if (!out.imu) return;
  ImuMeasurement& imu = *out.imu;
  const auto& samples = recording.imu;
  std::vector<double> forces;
  for (const ImuSample& sample : samples) {
    imu.gyroscope_max_radps =
        std::max(imu.gyroscope_max_radps, sample.angular_velocity_radps.cwiseAbs().maxCoeff());
    imu.accelerometer_max_mps2 =
        std::max(imu.accelerometer_max_mps2, sample.specific_force_mps2.cwiseAbs().maxCoeff());
    forces.push_back(sample.specific_force_mps2.norm());
  }
  imu.specific_force_median_mps2 = measures::median(std::move(forces));
  imu.longest_repeat = longest_repeat(samples);
  check_accelerometer_unit(imu, out);
  check_range(samples, &ImuSample::angular_velocity_radps, kMinGyroscopeRange_radps, "gyroscope-saturated",
              "deg/s", kDegreesPerRadian, out);
  check_range(samples, &ImuSample::specific_force_mps2, kMinAccelerometerRange_mps2,
              "accelerometer-saturated", "m/s^2", 1, out);
  if (static_cast<double>(imu.longest_repeat) * imu.stamps.median_interval_s > 0.1 &&
      imu.longest_repeat > 5) {
    out.add("imu-stuck", Severity::warning,
            fmt::format("{} samples in a row ({:.2f} s) are equal", imu.longest_repeat,
                        static_cast<double>(imu.longest_repeat) * imu.stamps.median_interval_s),
            "the sensor, or its driver, stopped; use --frames A:B to keep out of it");
  }
  if (out.has("imu-time-unit") || out.has("imu-out-of-order")) return;
  const auto rest = find_rest(blocks_of(samples), recording.rig.imu_noise);
  if (!rest) return;
  imu.gyroscope_bias_radps = rest->angular_velocity_radps;
  imu.bias_source = "at rest";
  if (imu.accelerometer_unit == 0) return;
  imu.gravity_mps2 = imu.accelerometer_unit * rest->specific_force_mps2.norm();
  imu.gravity_source = "at rest";
}

}  // namespace fusebench::inspection
