#include "core/prediction/timing_prior.hpp"

namespace fusebench::prediction {

std::array<TimingPrior, 4> timing_priors(const SensorTiming& timing, const config::Config& config) {
  // Where motion is not compensated, nothing is learnt of the shutters and nothing depends on them.
  const config::SelfCalibrationConfig& estimated = config.self_calibration;
  const auto shutter = [&](bool is_estimated, double sigma_s) {
    return config.terms.motion_compensation && is_estimated ? sigma_s : 0.0;
  };
  const bool inertial = config.terms.prior == config::Prior::imu;
  return {{{filter::kImuTimeOffset, inertial ? config.initialisation.imu_time_offset_sigma_s : 0.0},
           {filter::kColorReadout, shutter(estimated.color_readout, timing.color_readout_sigma_s)},
           {filter::kDepthReadout, shutter(estimated.depth_readout, timing.depth_readout_sigma_s)},
           {filter::kDepthDelay, shutter(estimated.depth_delay, timing.depth_delay_sigma_s)}}};
}

void add_timing_walk(filter::StateMatrix& covariance, const SensorTiming& timing, double duration_s,
                     const config::Config& config) {
  for (const TimingPrior& prior : timing_priors(timing, config)) {
    const double density = config.self_calibration.timing_walk * prior.sigma_s;
    covariance(prior.at, prior.at) += density * density * duration_s;
  }
}

}  // namespace fusebench::prediction
