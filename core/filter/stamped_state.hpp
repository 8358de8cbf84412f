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

/// Estimate of a filter at an instant.
struct StampedEstimate {
  std::int64_t timestamp_ns = 0;
  GaussianState estimate;
};

}  // namespace fusebench::filter
