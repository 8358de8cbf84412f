#include "datasets/inspection/measures/gyroscope_integral.hpp"

#include <algorithm>

namespace fusebench::inspection::measures {

namespace {
constexpr double kPause_s = 0.05;
}

GyroscopeIntegral::GyroscopeIntegral(std::span<const ImuSample> samples) {
  if (samples.empty()) return;
  origin_ns_ = samples.front().timestamp_ns;
  Quaterniond orientation = Quaterniond::Identity();
  std::size_t pauses = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double time_s = seconds(samples[i].timestamp_ns);
    if (i > 0) {
      const double dt_s = time_s - time_s_.back();
      const Vector3d mean_radps = 0.5 * (rate_radps_.back() + samples[i].angular_velocity_radps);
      orientation = (orientation * so3_exp(mean_radps * dt_s)).normalized();
      if (dt_s > kPause_s) ++pauses;
    }
    time_s_.push_back(time_s);
    rate_radps_.push_back(samples[i].angular_velocity_radps);
    orientation_.push_back(orientation);
    pauses_.push_back(pauses);
  }
}

std::size_t GyroscopeIntegral::sample_before(double time_s) const {
  const auto after = std::upper_bound(time_s_.begin(), time_s_.end(), time_s);
  const auto index = static_cast<std::size_t>(after - time_s_.begin());
  return std::min(index == 0 ? 0 : index - 1, time_s_.size() - 2);
}

Quaterniond GyroscopeIntegral::orientation(std::size_t sample, double time_s) const {
  const double dt_s = time_s - time_s_[sample];
  const double fraction = dt_s / (time_s_[sample + 1] - time_s_[sample]);
  const Vector3d mean_radps =
      rate_radps_[sample] + 0.5 * fraction * (rate_radps_[sample + 1] - rate_radps_[sample]);
  return orientation_[sample] * so3_exp(mean_radps * dt_s);
}

std::optional<Vector3d> GyroscopeIntegral::turn_rad(double begin_s, double end_s) const {
  if (time_s_.size() < 2 || begin_s < 0 || end_s > time_s_.back() || begin_s >= end_s) return std::nullopt;
  const std::size_t first = sample_before(begin_s);
  const std::size_t last = sample_before(end_s);
  if (pauses_[last + 1] != pauses_[first]) return std::nullopt;
  return so3_log((orientation(first, begin_s).conjugate() * orientation(last, end_s)).normalized());
}

}  // namespace fusebench::inspection::measures
