#include "eval/report/run_charts/run_series.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/geometry.hpp"
#include "core/base/trajectory/trajectory_file.hpp"
#include "eval/metrics/trajectory_error/ate_rpe.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace run_charts;

namespace {

using RunSeriesOfFolder = testing::InTemporaryFolder;

TEST_F(RunSeriesOfFolder, NoPoseOfARunThatTrackedNothingIsNoDamage) {
  write("trajectory.tum", trajectory::tum_text({}));
  run_files::FoundRun run;
  run.folder = folder_;
  run.record.status = record::RunStatus::lost;
  run.record.recording.truth = "none";
  run.record.frames = {5, 0, 5};
  const RunSeries lost = series_of(run, "lost");
  EXPECT_TRUE(lost.warnings.empty()) << lost.warnings.front();
  EXPECT_TRUE(lost.poses.empty());
  run.record.frames = {5, 5, 0};
  EXPECT_EQ(series_of(run, "emptied").warnings.size(), 1U);
}

/// Ten poses a second from the given time on, on a straight line.
Trajectory line(std::int64_t from_ns, int poses) {
  Trajectory trajectory;
  for (int i = 0; i < poses; ++i)
    trajectory.push_back(
        {from_ns + i * std::int64_t{100'000'000}, SE3{so3_exp({0, 0, 0}), {0.01 * i, 0, 0}}});
  return trajectory;
}

TEST_F(RunSeriesOfFolder, TimeCountsFromTheFirstImageThoughTheTruthBeginsEarlier) {
  constexpr std::int64_t kFirstImage_ns = 5'000'000'000;
  write("truth.tum", trajectory::tum_text(line(kFirstImage_ns - 996'000'000, 40)));
  write("trajectory.tum", trajectory::tum_text(line(kFirstImage_ns + 200'000'000, 20)));
  run_files::FoundRun imported;
  imported.folder = folder_;
  imported.record.status = record::RunStatus::ok;
  imported.record.recording.truth = "given";
  imported.record.frames = {22, 20, 2};
  EXPECT_EQ(series_of(imported, "other").start_ns, kFirstImage_ns + 200'000'000) << "of an older record";
  imported.record.recording.start_ns = kFirstImage_ns;
  const RunSeries series = series_of(imported, "other");
  EXPECT_TRUE(series.warnings.empty()) << series.warnings.front();
  ASSERT_EQ(series.poses.size(), 20U);
  EXPECT_NEAR(series.time_s(series.poses.front().timestamp_ns), 0.2, 1e-9);
}

TEST_F(RunSeriesOfFolder, ErrorsAreThoseOfTheAte) {
  Trajectory truth = line(5'000'000'000, 40);
  Trajectory estimate = line(5'008'000'000, 20);   // between two true poses
  for (Trajectory* poses : {&truth, &estimate}) {  // off a line, which would not determine the alignment
    for (std::size_t i = 0; i < poses->size(); ++i)
      (*poses)[i].T_world_camera.translation.z() = 0.1 * std::sin(static_cast<double>(i));
  }
  estimate[7].T_world_camera.translation.y() = 0.03;
  write("truth.tum", trajectory::tum_text(truth));
  write("trajectory.tum", trajectory::tum_text(estimate));
  run_files::FoundRun run;
  run.folder = folder_;
  run.record.recording.truth = "given";
  run.record.frames = {20, 20, 0};
  const auto ate = trajectory_error::absolute_trajectory_error(truth, estimate);
  ASSERT_TRUE(ate.has_value()) << ate.error().message;
  run.record.metrics.ate = {*ate, {}};
  const RunSeries series = series_of(run, "full");
  ASSERT_EQ(series.poses.size(), ate->errors_m.size());
  for (std::size_t i = 0; i < series.poses.size(); ++i)
    EXPECT_NEAR(series.poses[i].error_m, ate->errors_m[i], 1e-6);
}

TEST(RunSeriesColours, DifferBetweenVariants) {
  std::vector<run_files::FoundRun> runs(4);
  std::vector<RunSeries> series(runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    runs[i].record.variant = std::array{"full", "no-imu", "another-system", "full"}[i];
    series[i].run = &runs[i];
  }
  colour_by_variant(series);
  EXPECT_NE(series[0].colour, series[1].colour);
  EXPECT_NE(series[0].colour, series[2].colour);
  EXPECT_NE(series[1].colour, series[2].colour);
  EXPECT_EQ(series[0].colour, series[3].colour);
}

}  // namespace
}  // namespace fusebench
