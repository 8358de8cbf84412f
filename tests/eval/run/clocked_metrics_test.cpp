// Metrics of a run whose ground truth has a clock of its own.
#include <gtest/gtest.h>

#include "core/base/trajectory/trajectory.hpp"
#include "core/config/config.hpp"
#include "datasets/recording/recording.hpp"
#include "eval/metrics/trajectory_error/ate_rpe.hpp"
#include "eval/metrics/trajectory_error/fitted_offset.hpp"
#include "eval/run/run_evaluation.hpp"
#include "tests/eval/metrics/reference_clock/moving_bodies.hpp"

namespace fusebench {

using namespace run;
using testing::on_clock;
using testing::random_motion;
using testing::sampled;
using testing::with_errors;

namespace {

constexpr double kClockOffset_s = 0.08;

/// A recording of which nothing but the stamps and the truth exists, and what a tracker made of it.
struct ClockedRun {
  recording::Recording recording;
  RunOutput output;
};

/// The stamps of the images are stamp_delay_s later than their instants.
ClockedRun clocked_run(double duration_s, double stamp_delay_s = 0) {
  const testing::Motion motion = random_motion(11, 1.0, 0.5);
  ClockedRun run;
  run.recording.name = "clocked";
  run.recording.ground_truth = sampled(motion, -1, duration_s + 1, 100);
  run.output.has_filter = false;
  const Trajectory instants = with_errors(on_clock(sampled(motion, 0, duration_s, 30), kClockOffset_s),
                                          {.white = 0.001, .walk = 0.002}, 3);
  run.output.trajectory = trajectory::with_clock_offset(instants, std::llround(1e9 * stamp_delay_s));
  for (std::size_t i = 0; i < instants.size(); ++i) {
    recording::FrameEntry frame;
    frame.timestamp_ns = run.output.trajectory[i].timestamp_ns;
    frame.capture_ns = instants[i].timestamp_ns;
    run.recording.frames.push_back(frame);
    run.output.states.push_back({frame.capture_ns, {}});
  }
  return run;
}

record::RecordedMetrics clocked_metrics(const ClockedRun& run, config::ReferenceTimeOffset option) {
  config::Config config;
  config.evaluation.reference_time_offset = option;
  return metrics_of(run.output, run.recording, config, Workers(1));
}

TEST(ClockedMetrics, WithoutTheOptionTheStampsAreTakenAsTheyAre) {
  const ClockedRun run = clocked_run(20);
  const record::RecordedMetrics metrics = clocked_metrics(run, config::ReferenceTimeOffset::none);
  const auto ate =
      trajectory_error::absolute_trajectory_error(run.recording.ground_truth, run.output.trajectory);
  EXPECT_EQ(metrics.ate.value->stats.rmse, ate->stats.rmse);
  const auto& clock = metrics.reference_clock.value;
  ASSERT_TRUE(clock) << metrics.reference_clock.reason;
  EXPECT_FALSE(clock->applied);
  EXPECT_TRUE(clock->offset.significant());
  EXPECT_LT(std::abs(clock->offset.offset_s - kClockOffset_s), 3 * clock->offset.sigma_s);
  EXPECT_EQ(clock->as_read.ate_rmse_m, metrics.ate.value->stats.rmse);
  EXPECT_EQ(clock->as_read.rpe_1s_m, metrics.rpe_second.value->translation.rmse);
  EXPECT_EQ(clock->as_read.rpe_1s_rad, metrics.rpe_second.value->rotation.rmse);
  EXPECT_EQ(clock->as_read.silent, metrics.silent_frames());
  EXPECT_LT(*clock->fitted.ate_rmse_m, 0.5 * *clock->as_read.ate_rmse_m);
  EXPECT_LT(*clock->fitted.silent, *clock->as_read.silent);
}

TEST(ClockedMetrics, FittedTakesTheShiftedStamps) {
  const ClockedRun run = clocked_run(20);
  const record::RecordedMetrics none = clocked_metrics(run, config::ReferenceTimeOffset::none);
  const record::RecordedMetrics metrics = clocked_metrics(run, config::ReferenceTimeOffset::fitted);
  const auto& clock = metrics.reference_clock.value;
  ASSERT_TRUE(clock) << metrics.reference_clock.reason;
  EXPECT_TRUE(clock->applied);
  EXPECT_EQ(clock->offset.offset_s, none.reference_clock.value->offset.offset_s);
  EXPECT_EQ(clock->as_read.ate_rmse_m, none.ate.value->stats.rmse);
  EXPECT_EQ(clock->as_read.silent, none.silent_frames());
  EXPECT_EQ(clock->fitted.ate_rmse_m, metrics.ate.value->stats.rmse);
  EXPECT_EQ(clock->fitted.silent, metrics.silent_frames());
  // As `eval ate --t_offset` has it: added to the stamps of the estimate.
  trajectory_error::AteOptions options;
  options.offset_s = clock->offset.offset_s;
  const Trajectory& truth = run.recording.ground_truth;
  EXPECT_NEAR(metrics.ate.value->stats.rmse,
              trajectory_error::absolute_trajectory_error(truth, run.output.trajectory, options)->stats.rmse,
              1e-12);
  EXPECT_NEAR(metrics.ate_fitted.value->stats.rmse,
              trajectory_error::fitted_offset(truth, run.output.trajectory, options)->stats.rmse, 1e-12);
}

TEST(ClockedMetrics, AnOffsetThatIsNotObservableChangesNothing) {
  const ClockedRun run = clocked_run(1.5);
  const record::RecordedMetrics none = clocked_metrics(run, config::ReferenceTimeOffset::none);
  const record::RecordedMetrics fitted = clocked_metrics(run, config::ReferenceTimeOffset::fitted);
  EXPECT_FALSE(fitted.reference_clock.value);
  EXPECT_NE(fitted.reference_clock.reason.find("not observable"), std::string::npos)
      << fitted.reference_clock.reason;
  EXPECT_EQ(fitted.ate.value->stats.rmse, none.ate.value->stats.rmse);
  EXPECT_EQ(fitted.silent_frames(), none.silent_frames());
}

TEST(ClockedMetrics, TheOffsetIsThatOfTheInstantsAndNotOfTheStamps) {
  const ClockedRun run = clocked_run(20, 0.012);
  const record::RecordedMetrics metrics = clocked_metrics(run, config::ReferenceTimeOffset::none);
  const auto& clock = metrics.reference_clock.value;
  ASSERT_TRUE(clock) << metrics.reference_clock.reason;
  EXPECT_LT(std::abs(clock->offset.offset_s - kClockOffset_s), 3 * clock->offset.sigma_s);
}

TEST(ClockedMetrics, WithoutTruthThereIsNoClock) {
  ClockedRun run = clocked_run(5);
  run.recording.ground_truth.clear();
  const record::RecordedMetrics metrics = clocked_metrics(run, config::ReferenceTimeOffset::fitted);
  EXPECT_EQ(metrics.reference_clock.reason, "the recording has no ground truth");
  EXPECT_EQ(metrics.ate.reason, "the recording has no ground truth");
  EXPECT_EQ(metrics.silent.reason, "the recording has no ground truth");
}

}  // namespace
}  // namespace fusebench
