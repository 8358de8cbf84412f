// Time-stamped states: estimated, or of a reference.
#pragma once

#include <cstdint>

#include "core/filter/filter_state.hpp"

namespace fusebench::filter {

/// A state that is known exactly. Of a reference, world is the reference's own (as in a ground truth), and
/// the direction of gravity, the body rate and the clocks' offset are not given.
struct StampedState {
  std::int64_t timestamp_ns = 0;
  FilterState state;
};

/// Rotation, position, velocity and biases lead the error state.
inline constexpr int kNavigationSize = kGravity;

/// What a filter estimated at an instant, with the covariance of the navigation state alone: of the whole
/// state it is ten times as large, and a recording has tens of thousands of them.
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
