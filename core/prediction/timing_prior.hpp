// How well the clocks and shutters of the sensors are known before a recording, and how that may change
// during it. They are constants to the eye, but what slow motion tells of them is as much an error of the
// images: they may wander a little, so that quicker motion later on corrects it.
#pragma once

#include <array>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/filter/filter_state.hpp"

namespace fusebench::prediction {

/// One of them: where it is in the error state, and the standard deviation of its prior (s); 0 holds it.
struct TimingPrior {
  filter::StateOffset at;
  double sigma_s = 0;
};

/// The offset of the IMU's clock (held without an IMU), the read-outs, and the delay of depth, as calibration
/// and options have them.
[[nodiscard]] std::array<TimingPrior, 4> timing_priors(const SensorTiming& timing,
                                                       const config::TermsConfig& terms,
                                                       const config::InitialisationConfig& initialisation,
                                                       const config::SelfCalibrationConfig& self_calibration);

/// Lets each wander by self_calibration.timing_walk times its sigma in a second (random walk).
void add_timing_walk(filter::StateMatrix& covariance, const SensorTiming& timing, double duration_s,
                     const config::TermsConfig& terms, const config::InitialisationConfig& initialisation,
                     const config::SelfCalibrationConfig& self_calibration);

}  // namespace fusebench::prediction
