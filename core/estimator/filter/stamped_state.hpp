// Time-stamped states, estimated or of a reference.
#pragma once

#include <cstdint>

#include "core/estimator/filter/filter_state.hpp"

namespace fusebench::filter {

/// A state without uncertainty. For a reference, the world frame is that of the reference, and gravity
/// direction, body rate and clock offset are not given.
struct StampedState {
  std::int64_t timestamp_ns = 0;
  FilterState state;
};

/// Rotation, position, velocity and biases: the first entries of the error state.
inline constexpr int kNavigationSize = kGravity;

/// State of the filter at an instant, with the covariance of the navigation state only. The full covariance
/// is ten times as large, and a recording has tens of thousands of states.
struct StampedEstimate {
  std::int64_t timestamp_ns = 0;
  FilterState mean;
  Eigen::Matrix<double, kNavigationSize, kNavigationSize> covariance =
      Eigen::Matrix<double, kNavigationSize, kNavigationSize>::Zero();
};
[[nodiscard]] inline StampedEstimate stamped_estimate(std::int64_t timestamp_ns,
                                                      const GaussianState& estimate) {
  return {timestamp_ns, estimate.mean, estimate.covariance.topLeftCorner<kNavigationSize, kNavigationSize>()};
}

}  // namespace fusebench::filter
