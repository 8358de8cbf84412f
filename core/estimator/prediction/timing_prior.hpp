// Priors of the clocks and shutters of the sensors and their random walk. They are constant in reality, but
// in slow motion their estimates contain errors of the images. The random walk lets quicker motion correct
// them later.
#pragma once

#include <array>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/filter/filter_state.hpp"

namespace fusebench::prediction {

/// A timing parameter: its index in the error state and the standard deviation of its prior (s); 0 holds it.
struct TimingPrior {
  filter::StateOffset at;
  double sigma_s = 0;
};

/// Priors of the IMU clock offset (held without an IMU), the read-outs and the depth delay, from calibration
/// and options.
[[nodiscard]] std::array<TimingPrior, 4> timing_priors(const SensorTiming& timing,
                                                       const config::TermsConfig& terms,
                                                       const config::InitialisationConfig& initialisation,
                                                       const config::SelfCalibrationConfig& self_calibration);

/// Adds a random walk of self_calibration.timing_walk times sigma in a second to each parameter.
void add_timing_walk(filter::StateMatrix& covariance, const SensorTiming& timing, double duration_s,
                     const config::TermsConfig& terms, const config::InitialisationConfig& initialisation,
                     const config::SelfCalibrationConfig& self_calibration);

}  // namespace fusebench::prediction
