#include "core/estimator/prediction/timing_prior.hpp"

#include <gtest/gtest.h>

#include "core/config/groups/prediction_config.hpp"
#include "core/config/groups/terms_config.hpp"

namespace fusebench {

using namespace prediction;

namespace {

/// The groups of options that these tests need.
struct TimingOptions {
  config::TermsConfig terms;
  config::InitialisationConfig initialisation;
  config::SelfCalibrationConfig self_calibration;
};

constexpr SensorTiming kTiming{0.02, 0.03, -0.01, 0.002, 0.003, 0.004};

TEST(TimingPrior, SigmasAreThoseOfCalibrationAndOptions) {
  TimingOptions config;
  config.initialisation.imu_time_offset_sigma_s = 0.005;
  config.self_calibration.depth_readout = false;
  const auto priors = timing_priors(kTiming, config.terms, config.initialisation, config.self_calibration);
  EXPECT_EQ(priors[0].at, filter::kImuTimeOffset);
  EXPECT_EQ(priors[0].sigma_s, 0.005);
  EXPECT_EQ(priors[1].sigma_s, 0.002);
  EXPECT_EQ(priors[2].sigma_s, 0.0);  // held
  EXPECT_EQ(priors[3].at, filter::kDepthDelay);
  EXPECT_EQ(priors[3].sigma_s, 0.004);
}

TEST(TimingPrior, WithoutCompensationOrAnImuTheyAreHeld) {
  TimingOptions config;
  config.terms.motion_compensation = false;
  config.terms.prior = config::Prior::constant_velocity;
  for (const TimingPrior& prior :
       timing_priors(kTiming, config.terms, config.initialisation, config.self_calibration))
    EXPECT_EQ(prior.sigma_s, 0.0);
}

TEST(TimingPrior, TheyWanderByAShareOfTheirPriorsInASecond) {
  TimingOptions config;
  config.self_calibration.timing_walk = 0.5;
  filter::StateMatrix covariance = filter::StateMatrix::Zero();
  for (int i = 0; i < 40; ++i)
    add_timing_walk(covariance, kTiming, 0.1, config.terms, config.initialisation,
                    config.self_calibration);  // 4 s: twice that of one
  EXPECT_NEAR(covariance(filter::kColorReadout, filter::kColorReadout), 0.002 * 0.002, 1e-15);
  EXPECT_NEAR(covariance(filter::kDepthDelay, filter::kDepthDelay), 0.004 * 0.004, 1e-15);
  EXPECT_EQ(covariance(filter::kImuRotation, filter::kImuRotation), 0.0);
  config.self_calibration.timing_walk = 0;
  const filter::StateMatrix before = covariance;
  add_timing_walk(covariance, kTiming, 1, config.terms, config.initialisation, config.self_calibration);
  EXPECT_EQ(covariance, before);
}

}  // namespace
}  // namespace fusebench
