#include "core/smoothed_sample.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/error.hpp"

namespace fusebench {

namespace {

bool earlier(const ImuSample& sample, std::int64_t timestamp_ns) {
  return sample.timestamp_ns < timestamp_ns;
}

}  // namespace

ImuSample smoothed_sample(std::span<const ImuSample> samples, std::int64_t instant_ns, double half_window_s) {
  check(!samples.empty(), "there are samples");
  const auto half_window_ns = static_cast<std::int64_t>(std::llround(1e9 * half_window_s));
  const auto begin = std::lower_bound(samples.begin(), samples.end(), instant_ns - half_window_ns, earlier);
  const auto end = std::lower_bound(begin, samples.end(), instant_ns + half_window_ns + 1, earlier);
  // A parabola beyond its points, or across a gap, makes noise much larger.
  constexpr std::ptrdiff_t kLeastOnASide = 2;
  const auto middle = std::lower_bound(begin, end, instant_ns, earlier);
  if (middle - begin < kLeastOnASide || end - middle < kLeastOnASide) {
    return *std::ranges::min_element(
        samples, {}, [&](const ImuSample& sample) { return std::abs(sample.timestamp_ns - instant_ns); });
  }
  Matrix3d information = Matrix3d::Zero();
  Eigen::Matrix<double, 3, 6> sum = Eigen::Matrix<double, 3, 6>::Zero();
  for (auto sample = begin; sample != end; ++sample) {
    const double t = seconds_between(instant_ns, sample->timestamp_ns) / half_window_s;
    const Vector3d powers(1, t, t * t);
    Vector6d value;
    value << sample->angular_velocity_radps, sample->specific_force_mps2;
    information += powers * powers.transpose();
    sum += powers * value.transpose();
  }
  const Eigen::Matrix<double, 3, 6> parabola = information.ldlt().solve(sum);
  return {instant_ns, parabola.row(0).head<3>(), parabola.row(0).tail<3>()};
}

}  // namespace fusebench
