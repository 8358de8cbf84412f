#include "eval/metrics/reference_clock/time_offset.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/eval/metrics/reference_clock/moving_bodies.hpp"

namespace fusebench {

using namespace reference_clock;
using testing::Motion;
using testing::on_clock;
using testing::PoseErrors;
using testing::random_motion;
using testing::sampled;
using testing::seen_by;
using testing::with_errors;

namespace {

constexpr double kOffsets_s[] = {-0.15, -0.02, 0.0, 0.02, 0.066, 0.15};
const PoseErrors kTrackerErrors{.white = 0.001, .correlated = 0.003, .correlation_s = 0.3, .walk = 0.004};

/// The reference at 100 Hz, a second more at either end.
Trajectory reference_of(const Motion& motion, double duration_s, double white = 0.0005, unsigned seed = 99) {
  return with_errors(sampled(motion, -1, duration_s + 1, 100), {.white = white}, seed);
}

/// A camera at 30 Hz on the other clock.
Trajectory camera_of(const Motion& motion, double duration_s, double offset_s) {
  return on_clock(sampled(motion, 0.005, duration_s, 30), offset_s);
}

TEST(TimeOffset, IsExactWithoutErrors) {
  const Motion motion = random_motion(1, 0.5, 0.3);
  for (const double offset_s : kOffsets_s) {
    const auto found = fitted_time_offset(reference_of(motion, 20, 0), camera_of(motion, 20, offset_s));
    ASSERT_TRUE(found) << offset_s << ": " << found.error().message;
    EXPECT_NEAR(found->offset_s, offset_s, 2e-5);  // the reference is interpolated between 10 ms
    EXPECT_GT(found->sigma_s, 1e-6) << "files have decimals";
    EXPECT_LT(found->sigma_s, 1e-3);
    EXPECT_GT(found->motions, 500U);
  }
}

TEST(TimeOffset, WithErrorsItIsWithinThreeSigmas) {
  unsigned seed = 1;
  for (const double offset_s : kOffsets_s) {
    const Motion motion = random_motion(++seed, 0.5, 0.3);
    const auto found = fitted_time_offset(reference_of(motion, 20),
                                          with_errors(camera_of(motion, 20, offset_s), kTrackerErrors, seed));
    ASSERT_TRUE(found) << offset_s << ": " << found.error().message;
    EXPECT_LT(std::abs(found->offset_s - offset_s), 3 * found->sigma_s) << offset_s;
    EXPECT_LT(found->sigma_s, 1e-3);
  }
}

TEST(TimeOffset, RotationAndLeverArmOfTheBodiesAndTheScaleDoNotBias) {
  const SE3 T_body_camera(so3_exp({0.9, 0.7, -1.8}), {0.2, -0.17, 0.14});  // a lever arm of 30 cm
  for (const double scale : {0.95, 1.0, 1.05}) {
    const Motion motion = random_motion(5, 0.5, 0.3);
    const Trajectory exact = seen_by(camera_of(motion, 20, 0.066), T_body_camera, scale);
    const auto found = fitted_time_offset(reference_of(motion, 20, 0), exact);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_NEAR(found->offset_s, 0.066, 2e-5) << scale;
    const auto rough = fitted_time_offset(reference_of(motion, 20), with_errors(exact, kTrackerErrors, 3));
    ASSERT_TRUE(rough) << rough.error().message;
    EXPECT_LT(std::abs(rough->offset_s - 0.066), 3 * rough->sigma_s) << scale;
  }
}

TEST(TimeOffset, IsObservableFromTranslationOrRotationAlone) {
  for (const auto& [rotation_rad, translation_m] : {std::pair(0.0, 0.3), std::pair(0.5, 0.0)}) {
    const Motion motion = random_motion(8, rotation_rad, translation_m);
    const auto found = fitted_time_offset(reference_of(motion, 30),
                                          with_errors(camera_of(motion, 30, -0.15), kTrackerErrors, 4));
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_LT(std::abs(found->offset_s + 0.15), 3 * found->sigma_s);
    EXPECT_LT(found->sigma_s, 0.002);
  }
}

/// Mean squared error over variance, and mean error over its own standard deviation, of estimates by the
/// seed.
struct Calibration {
  double nees = 0;
  double bias_sigmas = 0;
};
Calibration calibration_of(const PoseErrors& errors, double duration_s) {
  constexpr int kSeeds = 30;
  Calibration result;
  double sum = 0;
  double squares = 0;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const Motion motion = random_motion(seed, 0.5, 0.3);
    const Trajectory reference = reference_of(motion, duration_s, 0.0005, 500 + seed);
    const auto found =
        fitted_time_offset(reference, with_errors(camera_of(motion, duration_s, 0.066), errors, 1000 + seed));
    if (!found) {
      ADD_FAILURE() << "seed " << seed << ": " << found.error().message;
      continue;
    }
    const double sigmas = (found->offset_s - 0.066) / found->sigma_s;
    sum += sigmas;
    squares += sigmas * sigmas;
  }
  return {squares / kSeeds, sum / std::sqrt(squares)};
}

TEST(TimeOffsetCalibration, SigmaIsThatOfTheErrorsWhateverTheirCorrelation) {
  for (const PoseErrors& errors :
       {PoseErrors{.white = 0.003}, PoseErrors{.correlated = 0.003, .correlation_s = 0.3},
        PoseErrors{.correlated = 0.005, .correlation_s = 1.0}, PoseErrors{.walk = 0.005}}) {
    for (const double duration_s : {10.0, 30.0}) {
      const Calibration found = calibration_of(errors, duration_s);
      EXPECT_GT(found.nees, 0.5) << duration_s << " s, walk " << errors.walk << " white " << errors.white;
      EXPECT_LT(found.nees, 2.0) << duration_s << " s, walk " << errors.walk << " white " << errors.white;
      EXPECT_LT(std::abs(found.bias_sigmas), 3.0);
    }
  }
}

TEST(TimeOffset, JumpsOfTheEstimateDoNotMoveIt) {
  const Motion motion = random_motion(3, 0.5, 0.3);
  Trajectory estimate = with_errors(camera_of(motion, 30, 0.066), kTrackerErrors, 5);
  const SE3 jump(so3_exp({0.4, -0.3, 0.2}), {0.5, -0.8, 0.3});
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    for (std::size_t at = 200; at <= i; at += 200)
      estimate[i].T_world_camera = jump * estimate[i].T_world_camera;
  }
  const auto found = fitted_time_offset(reference_of(motion, 30), estimate);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_LT(std::abs(found->offset_s - 0.066), 3 * found->sigma_s);
  EXPECT_LT(found->sigma_s, 0.002);
}

TEST(TimeOffset, GapsOfBothSidesAreLeftOut) {
  const Motion motion = random_motion(4, 0.5, 0.3);
  Trajectory reference = reference_of(motion, 30);
  Trajectory estimate = with_errors(camera_of(motion, 30, -0.02), kTrackerErrors, 6);
  std::erase_if(reference, [](const StampedPose& pose) {
    return pose.timestamp_ns > 4'000'000'000 && pose.timestamp_ns < 7'000'000'000;
  });
  std::erase_if(estimate, [](const StampedPose& pose) {
    return pose.timestamp_ns > 12'000'000'000 && pose.timestamp_ns < 14'000'000'000;
  });
  const auto found = fitted_time_offset(reference, estimate);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_LT(std::abs(found->offset_s + 0.02), 3 * found->sigma_s);
  EXPECT_LT(found->motions, estimate.size() - 100);
}

TEST(TimeOffset, TheSameTrajectoriesGiveTheSameBits) {
  const Motion motion = random_motion(6, 0.5, 0.3);
  const Trajectory reference = reference_of(motion, 10);
  const Trajectory estimate = with_errors(camera_of(motion, 10, 0.02), kTrackerErrors, 7);
  const auto once = fitted_time_offset(reference, estimate);
  const auto again = fitted_time_offset(reference, estimate);
  ASSERT_TRUE(once && again);
  EXPECT_EQ(once->offset_s, again->offset_s);
  EXPECT_EQ(once->sigma_s, again->sigma_s);
}

TEST(TimeOffset, OnlyLargeAndCertainOffsetsAreSignificant) {
  EXPECT_TRUE((TimeOffset{0.066, 0.002, 100}.significant()));
  EXPECT_TRUE((TimeOffset{-0.066, 0.002, 100}.significant()));
  EXPECT_FALSE((TimeOffset{0.066, 0.014, 100}.significant()));
  EXPECT_FALSE((TimeOffset{0.009, 0.0001, 100}.significant()));
}

}  // namespace
}  // namespace fusebench
