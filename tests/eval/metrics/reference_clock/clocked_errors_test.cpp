#include "eval/metrics/reference_clock/clocked_errors.hpp"

#include <gtest/gtest.h>

#include "eval/metrics/reference_clock/clock_json.hpp"
#include "eval/metrics/trajectory_error/ate_rpe.hpp"
#include "eval/metrics/trajectory_error/silent_failures.hpp"
#include "tests/eval/metrics/reference_clock/moving_bodies.hpp"

namespace fusebench {

using namespace reference_clock;
using testing::on_clock;
using testing::random_motion;
using testing::sampled;

namespace {

TEST(ClockedErrors, AShiftedCopyHasNoneWithItsOffset) {
  const testing::Motion motion = random_motion(7, 1.5, 0.5);
  const Trajectory reference = sampled(motion, -1, 21, 100);
  const Trajectory estimate = on_clock(sampled(motion, 0, 20, 20), 0.1);
  const auto clock = fitted_reference_clock(reference, estimate);
  ASSERT_TRUE(clock) << clock.error().message;
  EXPECT_NEAR(clock->offset.offset_s, 0.1, 1e-4);
  EXPECT_TRUE(clock->offset.significant());
  EXPECT_FALSE(clock->applied);
  EXPECT_GT(*clock->as_read.ate_rmse_m, 0.01);
  EXPECT_GT(*clock->as_read.silent, 0U);
  EXPECT_LT(*clock->fitted.ate_rmse_m, 1e-4);
  EXPECT_LT(*clock->fitted.rpe_1s_m, 1e-4);
  EXPECT_LT(*clock->fitted.rpe_1s_rad, 1e-3);
  EXPECT_EQ(*clock->fitted.silent, 0U);
}

TEST(ClockedErrors, AreThoseOfTheMetrics) {
  const testing::Motion motion = random_motion(7, 1.5, 0.5);
  const Trajectory reference = sampled(motion, -1, 21, 100);
  const Trajectory estimate = on_clock(sampled(motion, 0, 20, 20), 0.1);
  const ClockedErrors errors = clocked_errors(reference, estimate);
  EXPECT_EQ(errors.ate_rmse_m, trajectory_error::absolute_trajectory_error(reference, estimate)->stats.rmse);
  const auto rpe = trajectory_error::relative_pose_error(reference, estimate);
  EXPECT_EQ(errors.rpe_1s_m, rpe->translation.rmse);
  EXPECT_EQ(errors.rpe_1s_rad, rpe->rotation.rmse);
  EXPECT_EQ(errors.silent, trajectory_error::silent_failures(reference, estimate)->silent);
  const ClockedErrors none = clocked_errors(reference, {});
  EXPECT_FALSE(none.ate_rmse_m || none.rpe_1s_m || none.rpe_1s_rad || none.silent);
  EXPECT_TRUE(json_of(none).at("ate_rmse_m").is_null());
}

TEST(ClockedErrors, TheOffsetIsSubtractedFromTheReference) {
  const Trajectory reference = {{5'000'000'000, {}}};
  EXPECT_EQ(on_estimate_clock(reference, 0.066).front().timestamp_ns, 4'934'000'000);
}

}  // namespace
}  // namespace fusebench
