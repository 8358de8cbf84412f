#include "core/estimator/prediction/timing_prior.hpp"

#include "core/config/groups/prediction_config.hpp"
#include "core/config/groups/terms_config.hpp"

namespace fusebench::prediction {

std::array<TimingPrior, 4> timing_priors(const SensorTiming& timing, const config::TermsConfig& terms,
                                         const config::InitialisationConfig& initialisation,
                                         const config::SelfCalibrationConfig& self_calibration) {
  // Without compensation of the motion, the shutters have no effect and are not estimated.
  const auto shutter = [&](bool is_estimated, double sigma_s) {
    return terms.motion_compensation && is_estimated ? sigma_s : 0.0;
  };
  const bool inertial = terms.prior == config::Prior::imu;
  return {{{filter::kImuTimeOffset, inertial ? initialisation.imu_time_offset_sigma_s : 0.0},
           {filter::kColorReadout, shutter(self_calibration.color_readout, timing.color_readout_sigma_s)},
           {filter::kDepthReadout, shutter(self_calibration.depth_readout, timing.depth_readout_sigma_s)},
           {filter::kDepthDelay, shutter(self_calibration.depth_delay, timing.depth_delay_sigma_s)}}};
}

void add_timing_walk(filter::StateMatrix& covariance, const SensorTiming& timing, double duration_s,
                     const config::TermsConfig& terms, const config::InitialisationConfig& initialisation,
                     const config::SelfCalibrationConfig& self_calibration) {
  for (const TimingPrior& prior : timing_priors(timing, terms, initialisation, self_calibration)) {
    const double density = self_calibration.timing_walk * prior.sigma_s;
    covariance(prior.at, prior.at) += density * density * duration_s;
  }
}

}  // namespace fusebench::prediction
