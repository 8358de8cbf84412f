// The constants of the sensors, one by one, as outputs name them.
#pragma once

#include <string>
#include <vector>

#include "core/base/types.hpp"
#include "core/filter/filter_state.hpp"

namespace fusebench::filter {

/// A scalar of the state that does not change during a recording.
struct SensorConstant {
  std::string name;  ///< with its unit, as "color_readout_s"
  double value = 0;
  double sigma = 0;  ///< standard deviation; 0: held
};

/// From kImuTimeOffset on, in the order of the error state. Times are the whole ones: what the rig says, and
/// the error that was found.
[[nodiscard]] std::vector<SensorConstant> sensor_constants(const GaussianState& state,
                                                           const SensorTiming& timing);

}  // namespace fusebench::filter
