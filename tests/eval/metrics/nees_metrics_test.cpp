#include "eval/metrics/nees_metrics.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

#include "core/base/types.hpp"

namespace fusebench {

using namespace filter;
using namespace metrics;

namespace {

constexpr std::int64_t kStep_ns = 5'000'000;

/// A hand-like motion: 0.3 m and 1 rad at up to 3 Hz.
FilterState smooth_state(double t) {
  FilterState state;
  state.T_world_imu = {so3_exp({std::sin(5 * t), 0.5 * std::cos(9 * t), 0.2 * t}),
                       {0.3 * std::sin(19 * t), 0.1 * std::cos(7 * t), 0.2 * t}};
  state.velocity_world_mps = {5.7 * std::cos(19 * t), -0.7 * std::sin(7 * t), 0.2};
  state.gyroscope_bias_radps = {0.01 * t, 0.02, -0.01};
  state.accelerometer_bias_mps2 = {0.1, 0.2 * t, -0.3};
  return state;
}

std::vector<StampedState> smooth_truth(int count) {
  std::vector<StampedState> states;
  for (int i = 0; i < count; ++i) states.push_back({i * kStep_ns, smooth_state(5e-3 * i)});
  return states;
}

StateVector normal_vector(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  StateVector v;
  for (double& x : v) x = normal(random);
  return v;
}

/// A covariance with strong correlations between all parts and very different units.
StateMatrix correlated_covariance() {
  std::mt19937_64 random(7);
  StateMatrix factor;
  for (int i = 0; i < kStateSize; ++i) factor.col(i) = normal_vector(random);
  StateVector scale;
  for (int i = 0; i < kStateSize; ++i) scale[i] = std::pow(10.0, -1.0 - i % 4);
  const StateMatrix scaled = scale.asDiagonal() * factor;
  return scaled * scaled.transpose();
}

struct Scenario {
  std::vector<StampedState> truth;
  std::vector<StampedEstimate> estimates;
  SE3 T_imu_camera{so3_exp({0.3, -1.2, 0.5}), {0.05, -0.02, 0.1}};
};

/// Estimates in the frame of the first camera whose errors are drawn from `covariance`, reported as
/// `reported` times it.
Scenario scenario(int frames, double reported) {
  Scenario s;
  s.truth = smooth_truth(frames);
  const SE3 T_world_truth = (s.truth[0].state.T_world_imu * s.T_imu_camera).inverse();
  const StateMatrix covariance = correlated_covariance();
  const StateMatrix root = covariance.llt().matrixL();
  std::mt19937_64 random(11);
  for (const StampedState& at : s.truth) {
    FilterState seen = at.state;
    seen.T_world_imu = T_world_truth * seen.T_world_imu;
    seen.velocity_world_mps = T_world_truth.rotation * seen.velocity_world_mps;
    // truth = mean (+) error, so the error drawn is taken off the right of the truth.
    const StateVector error = root * normal_vector(random);
    s.estimates.push_back(stamped_estimate(at.timestamp_ns, {plus(seen, -error), reported * covariance}));
  }
  s.estimates[0].covariance.setZero();  // the first frame is known by definition
  return s;
}

TEST(Consistency, ErrorsDrawnFromTheCovarianceHaveNeesOne) {
  const int frames = 4001;
  const Scenario s = scenario(frames, 1.0);
  const auto result = consistency(s.truth, s.estimates, s.T_imu_camera);
  ASSERT_TRUE(result.has_value()) << result.error().message;
  for (const NeesResult& part : *result) {
    ASSERT_EQ(part.stats.count, 4000U) << part.part.name;
    // Independent draws, so their average obeys the bounds of as many runs.
    const NeesBounds bounds = nees_bounds_95(part.stats.count, part.part.dof);
    EXPECT_GE(part.stats.mean, bounds.lower) << part.part.name;
    EXPECT_LE(part.stats.mean, bounds.upper) << part.part.name;
    EXPECT_NEAR(bounds.upper - bounds.lower, 4 * std::sqrt(2.0 / (4000 * part.part.dof)), 0.003);
    // Chi-square with 3 and 6 degrees of freedom: medians 2.366 and 5.348.
    EXPECT_NEAR(part.stats.median, part.part.dof == 3 ? 2.366 / 3 : 5.348 / 6, 0.04) << part.part.name;
    EXPECT_EQ(part.last, part.nees_per_dof.back());
  }
}

TEST(Consistency, AnOverconfidentFilterIsFoundOut) {
  const auto honest =
      consistency(scenario(400, 1.0).truth, scenario(400, 1.0).estimates, scenario(1, 1).T_imu_camera);
  const Scenario s = scenario(400, 0.25);  // claims half the sigma
  const auto bold = consistency(s.truth, s.estimates, s.T_imu_camera);
  ASSERT_TRUE(honest && bold);
  for (std::size_t i = 0; i < bold->size(); ++i) {
    EXPECT_NEAR((*bold)[i].stats.mean / (*honest)[i].stats.mean, 4, 1e-9);
    EXPECT_GT((*bold)[i].stats.mean, nees_bounds_95((*bold)[i].stats.count, (*bold)[i].part.dof).upper);
  }
}

TEST(Consistency, TheWorldOfTheTruthDoesNotMatter) {
  Scenario s = scenario(50, 1.0);
  const auto before = consistency(s.truth, s.estimates, s.T_imu_camera);
  const SE3 T_other_truth{so3_exp({1, 2, -0.5}), {10, -20, 3}};
  for (StampedState& at : s.truth) {
    at.state.T_world_imu = T_other_truth * at.state.T_world_imu;
    at.state.velocity_world_mps = T_other_truth.rotation * at.state.velocity_world_mps;
  }
  const auto after = consistency(s.truth, s.estimates, s.T_imu_camera);
  ASSERT_TRUE(before && after);
  for (std::size_t i = 0; i < after->size(); ++i) {
    EXPECT_NEAR((*after)[i].stats.mean, (*before)[i].stats.mean, 1e-7 * (*before)[i].stats.mean);
  }
}

TEST(Consistency, TheCamerasStatesAreThoseOfItsOwnMotion) {
  const std::vector<StampedState> truth = smooth_truth(400);
  const SE3 T_imu_camera{so3_exp({0.3, -1.2, 0.5}), {0.05, -0.02, 0.1}};
  const std::vector<StampedState> camera = states_of_camera(truth, T_imu_camera);
  ASSERT_EQ(camera.size(), truth.size());
  constexpr double kStep_s = 1e-6;
  const auto position = [&](double t) { return smooth_state(t).T_world_imu * T_imu_camera.translation; };
  for (std::size_t i = 1; i + 1 < camera.size(); ++i) {
    const double t = 5e-3 * static_cast<double>(i);
    const Vector3d velocity = (position(t + kStep_s) - position(t - kStep_s)) / (2 * kStep_s);
    EXPECT_LT((camera[i].state.velocity_world_mps - velocity).norm(), 0.015) << t;  // h^2 / 6 times the jerk
    const SE3 pose = truth[i].state.T_world_imu * T_imu_camera;
    EXPECT_LT((camera[i].state.T_world_imu.translation - pose.translation).norm(), 1e-12);
    EXPECT_LT(rotation_angle_rad(camera[i].state.T_world_imu.rotation, pose.rotation), 1e-7);
  }
}

TEST(Consistency, APartThatIsNotEstimatedHasNoFrames) {
  Scenario s = scenario(20, 1.0);
  for (StampedEstimate& at : s.estimates) {
    at.covariance.middleRows<3>(kGyroscopeBias).setZero();
    at.covariance.middleCols<3>(kGyroscopeBias).setZero();
    // Rank two: one direction of the position is known exactly.
    const Vector3d a(1, 0.5, 0.2), b(0, 1, 1);
    at.covariance.block<3, 3>(kPosition, kPosition) = a * a.transpose() + b * b.transpose();
  }
  const auto result = consistency(s.truth, s.estimates, s.T_imu_camera);
  ASSERT_TRUE(result.has_value());
  for (const NeesResult& part : *result) {
    EXPECT_EQ(part.possible, 19U);
    const bool estimated =
        part.part.name != "position" && part.part.name != "gyroscope_bias" && part.part.name != "pose";
    EXPECT_EQ(part.stats.count, estimated ? 19U : 0U) << part.part.name;
  }
}

TEST(Consistency, WithoutTruthThereIsAReason) {
  const Scenario s = scenario(20, 1.0);
  EXPECT_EQ(consistency({}, s.estimates, s.T_imu_camera).error().code, ErrorCode::data_corrupt);
  EXPECT_EQ(consistency(s.truth, {}, s.T_imu_camera).error().code, ErrorCode::data_corrupt);
  const std::vector<StampedState> late(s.truth.begin() + 3, s.truth.end());
  EXPECT_NE(consistency(late, s.estimates, s.T_imu_camera).error().message.find("first frame"),
            std::string::npos);
  const std::vector<StampedState> only_first(s.truth.begin(), s.truth.begin() + 1);
  EXPECT_FALSE(consistency(only_first, s.estimates, s.T_imu_camera).has_value());
}

TEST(InterpolateState, FollowsASmoothMotion) {
  const auto states = smooth_truth(200);
  double worst = 0;
  double worst_linear = 0;
  for (std::int64_t t_ns = 2 * kStep_ns; t_ns < 197 * kStep_ns; t_ns += 777'777) {
    const auto state = interpolate_state(states, t_ns);
    ASSERT_TRUE(state.has_value());
    const FilterState exact = smooth_state(1e-9 * static_cast<double>(t_ns));
    worst = std::max(worst, minus(*state, exact).norm());
    const auto base = static_cast<std::size_t>(t_ns / kStep_ns);
    const double fraction = static_cast<double>(t_ns % kStep_ns) / static_cast<double>(kStep_ns);
    const SE3 linear =
        interpolate(states[base].state.T_world_imu, states[base + 1].state.T_world_imu, fraction);
    worst_linear = std::max(worst_linear, (linear.translation - exact.T_world_imu.translation).norm());
  }
  EXPECT_LT(worst, 2e-5);         // of all parts, the velocity of 5.7 m/s at 3 Hz among them
  EXPECT_GT(worst_linear, 3e-4);  // what a straight line would make of the position alone
}

TEST(InterpolateState, StopsAtEndsAndGaps) {
  auto states = smooth_truth(40);
  EXPECT_FALSE(interpolate_state(states, -1));
  EXPECT_FALSE(interpolate_state(states, 39 * kStep_ns + 1));
  EXPECT_TRUE(interpolate_state(states, 39 * kStep_ns));
  EXPECT_LT(minus(*interpolate_state(states, kStep_ns / 2), smooth_state(2.5e-3)).norm(), 1e-3);
  EXPECT_LT(minus(*interpolate_state(states, 7 * kStep_ns), states[7].state).norm(), 1e-15);
  states.erase(states.begin() + 5, states.begin() + 26);  // 110 ms between two
  EXPECT_FALSE(interpolate_state(states, 10 * kStep_ns));
  EXPECT_TRUE(interpolate_state(states, 4 * kStep_ns - 1));
}

TEST(ChiSquare, QuantilesInvertTheDistribution) {
  // For an even number of degrees of freedom the distribution is a finite sum.
  for (const int dof : {2, 6, 30, 300, 3000}) {
    for (const double probability : {0.025, 0.5, 0.975}) {
      const double half = chi_square_quantile(probability, dof) / 2;
      double above = 0;
      for (int k = 0; k < dof / 2; ++k) above += std::exp(k * std::log(half) - half - std::lgamma(k + 1.0));
      EXPECT_NEAR(1 - above, probability, 1e-10) << dof;
    }
  }
  // And printed tables for odd ones.
  EXPECT_NEAR(chi_square_quantile(0.95, 1), 3.841458820694124, 1e-9);
  EXPECT_NEAR(chi_square_quantile(0.025, 3), 0.215795282623898, 1e-9);
  EXPECT_NEAR(chi_square_quantile(0.975, 3), 9.348403604496148, 1e-9);
}

TEST(ChiSquare, BoundsNarrowWithTheNumberOfRuns) {
  const NeesBounds one = nees_bounds_95(1, 3);
  EXPECT_NEAR(one.lower, 0.0719, 1e-4);
  EXPECT_NEAR(one.upper, 3.1161, 1e-4);
  EXPECT_NEAR(nees_bounds_95(10, 3).lower, 16.791 / 30, 1e-4);
  EXPECT_NEAR(nees_bounds_95(10, 3).upper, 46.979 / 30, 1e-4);
  const NeesBounds many = nees_bounds_95(50, 3);  // the classical example: 150 degrees of freedom
  EXPECT_NEAR(many.lower, 117.985 / 150, 1e-4);
  EXPECT_NEAR(many.upper, 185.800 / 150, 1e-4);
}

/// The protocol of docs/metrics.md: runs of correlated errors, the mean over the frames of each, and the
/// average of these against the bounds of as many instants. A consistent filter leaves them in one study of
/// twenty at most; one that claims half its standard deviation leaves them always.
TEST(Consistency, MeansOverRunsKeepTheBoundsOfTheirNumber) {
  constexpr int kStudies = 400;
  constexpr std::size_t kRuns = 10;
  constexpr int kFrames = 60;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (const double correlation : {0.0, 0.9, 0.999}) {
    const NeesBounds bounds = nees_bounds_95(kRuns, 3);
    int outside = 0;
    int bold_outside = 0;
    for (int study = 0; study < kStudies; ++study) {
      double sum = 0;
      for (std::size_t run = 0; run < kRuns; ++run) {
        Vector3d error(normal(random), normal(random), normal(random));
        for (int frame = 0; frame < kFrames; ++frame) {
          const Vector3d fresh(normal(random), normal(random), normal(random));
          error = correlation * error + std::sqrt(1 - correlation * correlation) * fresh;
          sum += error.squaredNorm() / 3 / kFrames;
        }
      }
      const double mean = sum / kRuns;
      outside += mean < bounds.lower || mean > bounds.upper ? 1 : 0;
      bold_outside += 4 * mean > bounds.upper ? 1 : 0;
    }
    EXPECT_LE(outside, kStudies * 0.08) << correlation;  // 0.05 within three standard deviations
    EXPECT_EQ(bold_outside, kStudies) << correlation;
    if (correlation > 0) continue;
    EXPECT_EQ(outside, 0);  // as careful as it gets
  }
}

}  // namespace
}  // namespace fusebench
