#include "datasets/inspection/measures/imu_faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/base/trajectory/trajectory_file.hpp"
#include "datasets/inspection/measures/order_statistics.hpp"

namespace fusebench::inspection::measures {

namespace {

using SampleVector = Vector3d ImuSample::*;

constexpr std::size_t kNeighbours = 5;  // on each side: their median bears two that are spikes themselves
constexpr double kRatio = 10;           // of a sinus of any frequency, a peak has less than 4
constexpr double kFewShare = 0.01;
constexpr std::size_t kFew = 10;

struct SensorLimits {
  SampleVector member;
  std::string_view name;
  std::string_view unit;
  double least_spike;  ///< impossible for a hand-held rig from one sample to the next and back
  double range;        ///< where the sensors of hand-held rigs end (4000 deg/s; 100 g)
};
constexpr std::array<SensorLimits, 2> kSensors = {
    SensorLimits{&ImuSample::angular_velocity_radps, "gyroscope", "rad/s", 5, 70},
    SensorLimits{&ImuSample::specific_force_mps2, "accelerometer", "m/s^2", 50, 1000}};

/// One component of all samples.
class Signal {
 public:
  Signal(std::span<const ImuSample> samples, SampleVector member, Eigen::Index axis)
      : samples_(samples), member_(member), axis_(axis) {}

  [[nodiscard]] double at(std::size_t i) const { return (samples_[i].*member_)[axis_]; }

  /// How far a sample lies beyond the medians of both sides, if that is a spike; else 0.
  [[nodiscard]] double spike(std::size_t i, double least) const {
    const std::size_t first = i - std::min(i, kNeighbours);
    const std::size_t end = std::min(samples_.size(), i + kNeighbours + 1);
    if (!differs(first, end, i, least)) return 0;
    std::vector<double> before, after, steps_before, steps_after;
    for (std::size_t k = first; k < end; ++k) {
      if (k == i) continue;
      (k < i ? before : after).push_back(at(k));
      if (k + 1 == end || k + 1 == i) continue;
      (k < i ? steps_before : steps_after).push_back(std::abs(at(k + 1) - at(k)));
    }
    if (before.empty()) before = after;
    if (after.empty()) after = before;
    const auto [low, high] = std::minmax({median(before), median(after)});
    const double excess = std::max(at(i) - high, low - at(i));
    const double step = std::max(median(steps_before), median(steps_after));  // rest may be on one side
    return excess > least && excess > kRatio * step ? excess : 0;
  }

 private:
  /// Whether any sample around differs by so much: nearly none does, and the rest is not looked at further.
  [[nodiscard]] bool differs(std::size_t first, std::size_t end, std::size_t i, double least) const {
    for (std::size_t k = first; k < end; ++k) {
      if (std::abs(at(k) - at(i)) > least) return true;
    }
    return false;
  }

  std::span<const ImuSample> samples_;
  SampleVector member_;
  Eigen::Index axis_;
};

bool beyond_range(const ImuSample& sample, const SensorLimits& sensor) {
  return (sample.*sensor.member).cwiseAbs().maxCoeff() > sensor.range;
}

/// For each sensor, whether values beyond its range are few.
std::array<bool, 2> range_faults_are_few(std::span<const ImuSample> samples) {
  const auto most = std::max(kFew, static_cast<std::size_t>(kFewShare * static_cast<double>(samples.size())));
  std::array<bool, 2> few{};
  for (std::size_t s = 0; s < kSensors.size(); ++s) {
    const auto beyond = std::ranges::count_if(
        samples, [&](const ImuSample& sample) { return beyond_range(sample, kSensors[s]); });
    few[s] = static_cast<std::size_t>(beyond) <= most;
  }
  return few;
}

}  // namespace

std::vector<ImuFault> find_imu_faults(std::span<const ImuSample> samples) {
  const std::array<bool, 2> few = range_faults_are_few(samples);
  std::vector<ImuFault> faults;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    std::optional<ImuFault> worst;
    double worst_excess = 0;  // in units of the least spike, so that both sensors compare
    for (std::size_t s = 0; s < kSensors.size(); ++s) {
      const SensorLimits& sensor = kSensors[s];
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const Signal signal(samples, sensor.member, axis);
        const double value = signal.at(i);
        const double beyond = few[s] && std::abs(value) > sensor.range ? std::abs(value) : 0;
        const double excess = std::max(beyond, signal.spike(i, sensor.least_spike)) / sensor.least_spike;
        if (excess <= worst_excess) continue;
        worst_excess = excess;
        worst = {i, sensor.member, axis, value};
      }
    }
    if (worst) faults.push_back(*worst);
  }
  return faults;
}

std::string describe(const ImuFault& fault, std::span<const ImuSample> samples) {
  const SensorLimits& sensor = *std::ranges::find(kSensors, fault.sensor, &SensorLimits::member);
  return fmt::format("the {}'s {} reads {:.4g} {} at {} (sample {})", sensor.name,
                     "xyz"[static_cast<std::size_t>(fault.axis)], fault.value, sensor.unit,
                     trajectory::stamp_text(samples[fault.sample].timestamp_ns), fault.sample);
}

std::vector<ImuSample> without_faults(std::span<const ImuSample> samples, std::span<const ImuFault> faults) {
  std::vector<ImuSample> sound;
  sound.reserve(samples.size());
  auto fault = faults.begin();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (fault != faults.end() && fault->sample == i) {
      ++fault;
    } else {
      sound.push_back(samples[i]);
    }
  }
  return sound;
}

}  // namespace fusebench::inspection::measures
