// The sensor constants as scalars with their names in outputs.
#pragma once

#include <string>
#include <vector>

#include "core/base/types.hpp"
#include "core/estimator/filter/filter_state.hpp"

namespace fusebench::filter {

/// A scalar of the state that is constant during a recording.
struct SensorConstant {
  std::string name;  ///< with its unit, for example "color_readout_s"
  double value = 0;
  double sigma = 0;  ///< standard deviation; 0: fixed
};

/// The constants from kImuTimeOffset on, in the order of the error state. Times are totals: value of the rig
/// plus estimated error.
[[nodiscard]] std::vector<SensorConstant> sensor_constants(const GaussianState& state,
                                                           const SensorTiming& timing);

}  // namespace fusebench::filter
