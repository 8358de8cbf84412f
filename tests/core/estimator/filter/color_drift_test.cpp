#include "core/estimator/filter/color_drift.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/config/groups/filter_config.hpp"
#include "core/estimator/filter/iekf.hpp"
#include "core/estimator/filter/pose_clones.hpp"
#include "tests/support/known_measurement.hpp"

namespace fusebench {

using namespace config;
using namespace filter;

namespace {

Vector6d normal_vector(std::mt19937& random, double sigma) {
  std::normal_distribution<double> normal(0.0, sigma);
  Vector6d v;
  for (int i = 0; i < kPoseSize; ++i) v[i] = normal(random);
  return v;
}

TEST(ColorDrift, ConstantCorrectionsAreDriftOfTheirSize) {
  const ColorDriftConfig config;
  ColorDrift drift;
  Vector6d correction;
  correction << 1e-3, -2e-3, 2e-3, 4e-3, 0, -3e-3;
  for (int frame = 0; frame < 20 * config.memory_frames; ++frame) drift.observe(correction, config);
  EXPECT_NEAR(drift.noise(config).rotation_rad, 3e-3 / std::sqrt(3.0), 1e-8);
  EXPECT_NEAR(drift.noise(config).translation_m, 5e-3 / std::sqrt(3.0), 1e-8);
  ColorDriftConfig twice = config;
  twice.factor = 2;
  EXPECT_NEAR(drift.noise(twice).rotation_rad, 6e-3 / std::sqrt(3.0), 1e-8);
  twice.factor = 0;
  EXPECT_EQ(drift.noise(twice).translation_m, 0.0);
}

TEST(ColorDrift, NoiseAndASingleJoltAreNone) {
  const ColorDriftConfig config;
  std::mt19937 random(3);
  double sum = 0;
  constexpr int kRuns = 50;
  for (int run = 0; run < kRuns; ++run) {
    ColorDrift drift;
    for (int frame = 0; frame < 5 * config.memory_frames; ++frame)
      drift.observe(normal_vector(random, 1e-3), config);
    sum += drift.noise(config).rotation_rad / kRuns;
  }
  EXPECT_LT(sum, 0.25e-3);

  ColorDrift jolted;
  for (int frame = 0; frame < 50; ++frame)
    jolted.observe(Vector6d::Constant(frame == 25 ? 0.1 : 0.0), config);
  EXPECT_EQ(jolted.noise(config).rotation_rad, 0.0);
}

TEST(ColorDrift, IsZeroBeforeTheLag) {
  const ColorDriftConfig config;
  ColorDrift drift;
  for (int frame = 0; frame < config.lag_frames; ++frame) drift.observe(Vector6d::Constant(1.0), config);
  EXPECT_EQ(drift.noise(config).translation_m, 0.0);
  drift.observe(Vector6d::Constant(1.0), config);
  EXPECT_GT(drift.noise(config).translation_m, 0.0);
}

/// The largest position error of a camera that moves along x, after the start, where colour overestimates
/// each step by `excess_m`.
double drift_m(double excess_m, const ColorDriftConfig& config) {
  constexpr double kColor_m = 1e-4, kDepth_m = 2e-3, kStep_m = 0.01;
  std::mt19937 random(11);
  ColorDrift drift;
  GaussianState state;
  SE3 truth;
  SE3 cut_at;  // true pose of the reference
  double worst_m = 0;
  for (int frame = 0; frame < 600; ++frame) {
    truth.translation.x() += frame % 200 < 100 ? kStep_m : -kStep_m;  // there and back
    SE3 moved = cut_at.inverse() * truth;
    moved.translation *= (kStep_m + excess_m) / kStep_m;
    state.covariance.topLeftCorner<kPoseSize, kPoseSize>() += Matrix6d::Identity();  // it may have moved
    KnownMeasurement measurement(
        pose_plus(state.mean.T_world_imu_reference * moved, normal_vector(random, kColor_m)),
        pose_plus(truth, normal_vector(random, kDepth_m)), kColor_m, kDepth_m);
    const IekfResult update = iekf_update(state, measurement, IekfConfig{});
    drift.observe(correction_in_imu(update), config);
    state = with_reference_noise(cloned_as_reference(fused_into_model(update.posterior, {})),
                                 drift.noise(config));
    cut_at = truth;
    if (frame > 300)
      worst_m = std::max(worst_m, (state.mean.T_world_imu.translation - truth.translation).norm());
  }
  return worst_m;
}

/// Colour that is off by 5 % of the motion pulls the estimate away from the model as long as its scatter
/// alone counts.
TEST(ColorDrift, ColorThatDoesNotFitDepthLosesItsWeight) {
  ColorDriftConfig off;
  off.factor = 0;
  const double believed_m = drift_m(0.0005, off);
  const double weighed_m = drift_m(0.0005, {});
  EXPECT_GT(believed_m, 0.005);
  EXPECT_LT(weighed_m, 0.5 * believed_m);
  // Colour that fits keeps it.
  EXPECT_NEAR(drift_m(0, {}), drift_m(0, off), 0.3 * drift_m(0, off));
}

/// The estimate from two measurements of equal uncertainty is half-way between them.
TEST(ColorDrift, TheCorrectionIsTheWayFromWhereColorAloneWouldBe) {
  GaussianState state;
  state.mean.T_world_imu.rotation = Quaterniond(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitZ()));
  state.mean.T_world_imu_reference = state.mean.T_world_imu;
  state.covariance.topLeftCorner<kPoseSize, kPoseSize>() = 1e2 * Matrix6d::Identity();
  SE3 by_color = state.mean.T_world_imu, by_depth = by_color;
  by_color.translation = {0.01, 0, 0};
  by_depth.translation = {0.03, 0, 0};
  KnownMeasurement measurement(by_color, by_depth, 0.01, 0.01);
  const IekfResult update = iekf_update(state, measurement, IekfConfig{});
  EXPECT_NEAR(update.correction_by_model[3], 0.01, 1e-5);
  EXPECT_NEAR(correction_in_imu(update)[4], -0.01, 1e-5) << "the world's x is the IMU's -y";
}

}  // namespace
}  // namespace fusebench
