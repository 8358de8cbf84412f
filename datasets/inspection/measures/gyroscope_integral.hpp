// Turns of the IMU over any interval: the integral of its gyroscope.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/types.hpp"

namespace fusebench::inspection::measures {

class GyroscopeIntegral {
 public:
  /// Samples sorted by time, stamps unique.
  explicit GyroscopeIntegral(std::span<const ImuSample> samples);

  /// Rotation vector of R_begin_end in the IMU's axes (rad). Between samples the rate is interpolated
  /// linearly. Nothing if the interval leaves the samples, or holds a pause of more than 50 ms.
  [[nodiscard]] std::optional<Vector3d> turn_rad(double begin_s, double end_s) const;

  /// Seconds since the first sample.
  [[nodiscard]] double seconds(std::int64_t timestamp_ns) const {
    return seconds_between(origin_ns_, timestamp_ns);
  }

 private:
  [[nodiscard]] Quaterniond orientation(std::size_t sample, double time_s) const;
  [[nodiscard]] std::size_t sample_before(double time_s) const;

  std::int64_t origin_ns_ = 0;
  std::vector<double> time_s_;
  std::vector<Vector3d> rate_radps_;
  std::vector<Quaterniond> orientation_;  ///< R_first_sample
  std::vector<std::size_t> pauses_;       ///< up to and including the sample
};

}  // namespace fusebench::inspection::measures
