#include "core/estimator/prediction/smoothed_sample.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"

namespace fusebench::prediction {

namespace {

/// The earlier one if both are equally near.
ImuSample nearest_sample(std::span<const ImuSample> samples, std::int64_t instant_ns) {
  const auto after = std::ranges::lower_bound(samples, instant_ns, {}, &ImuSample::timestamp_ns);
  if (after == samples.begin()) return *after;
  const auto before = after - 1;
  const bool is_before =
      after == samples.end() || instant_ns - before->timestamp_ns <= after->timestamp_ns - instant_ns;
  return is_before ? *before : *after;
}

}  // namespace

std::span<const ImuSample> samples_around(std::span<const ImuSample> samples, std::int64_t instant_ns,
                                          double half_window_s) {
  const auto half_window_ns = static_cast<std::int64_t>(std::llround(1e9 * half_window_s));
  const auto begin =
      std::ranges::lower_bound(samples, instant_ns - half_window_ns, {}, &ImuSample::timestamp_ns);
  const auto end = std::ranges::upper_bound(begin, samples.end(), instant_ns + half_window_ns, {},
                                            &ImuSample::timestamp_ns);
  return {begin, end};
}

ImuSample smoothed_sample(std::span<const ImuSample> samples, std::int64_t instant_ns, double half_window_s) {
  check(!samples.empty(), "there are samples");
  const std::span<const ImuSample> window = samples_around(samples, instant_ns, half_window_s);
  // Outside its points or across a gap, a parabola amplifies the noise.
  constexpr std::ptrdiff_t kMinOnASide = 2;
  const auto middle = std::ranges::lower_bound(window, instant_ns, {}, &ImuSample::timestamp_ns);
  if (middle - window.begin() < kMinOnASide || window.end() - middle < kMinOnASide)
    return nearest_sample(samples, instant_ns);
  Matrix3d information = Matrix3d::Zero();
  Eigen::Matrix<double, 3, 6> sum = Eigen::Matrix<double, 3, 6>::Zero();
  for (const ImuSample& sample : window) {
    const double t = seconds_between(instant_ns, sample.timestamp_ns) / half_window_s;
    const Vector3d powers(1, t, t * t);
    Vector6d value;
    value << sample.angular_velocity_radps, sample.specific_force_mps2;
    information += powers * powers.transpose();
    sum += powers * value.transpose();
  }
  const Eigen::Matrix<double, 3, 6> parabola = information.ldlt().solve(sum);
  return {instant_ns, parabola.row(0).head<3>(), parabola.row(0).tail<3>()};
}

}  // namespace fusebench::prediction
