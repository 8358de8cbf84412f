#include "eval/run_charts/run_series.hpp"

#include <gtest/gtest.h>

#include "core/trajectory/trajectory_file.hpp"
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

}  // namespace
}  // namespace fusebench
