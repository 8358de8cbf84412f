#include "eval/compare/tables/systems_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/expect_text.hpp"

namespace fusebench {

using namespace record;
using namespace run_files;
using namespace tables;

namespace {

FoundRun run_of(const std::string& system, double ate_m, const std::string& reason = "") {
  FoundRun run;
  run.record.status = reason.empty() ? RunStatus::ok : RunStatus::failed;
  run.record.reason = reason;
  run.record.recording.name = "rgbd_dataset_freiburg1_xyz";
  run.record.variant = system;
  run.record.frames = {100, 90, 10};
  run.record.timing.cpu_s = 20;
  if (reason.empty()) {
    trajectory_error::AteResult ate;
    ate.stats = metrics::statistics(std::vector<double>{ate_m});
    run.record.metrics.ate = {ate, {}};
    run.record.metrics.pose_intensity = {RecordedPoseIntensity{7.5, 9, 80, 1000, false}, {}};
  }
  return run;
}

TEST(SystemsTable, HasTheMedianAndTheRangeOfRepetitionsAndTheirFailures) {
  std::vector<FoundRun> runs = {run_of("full", 0.01)};
  for (const double ate_m : {0.05, 0.02, 0.03}) runs.push_back(run_of("drawing", ate_m));
  runs.push_back(run_of("drawing", 0, "drawing: signal 9 (Killed)"));
  runs.back().record.poses = PoseKind::final;
  const SystemsTable table = systems_table_of(runs);
  ASSERT_GE(table.rows.size(), 2U);
  EXPECT_EQ(table.rows[0].system, "full");
  const SystemRow& drawing = table.rows[1];
  EXPECT_EQ(drawing.runs, 4U);
  EXPECT_EQ(drawing.ok, 3U);
  ASSERT_TRUE(drawing.value("ate_rmse_m").has_value());
  EXPECT_DOUBLE_EQ(drawing.value("ate_rmse_m")->median, 0.03);
  EXPECT_DOUBLE_EQ(drawing.value("ate_rmse_m")->least, 0.02);
  EXPECT_DOUBLE_EQ(drawing.value("ate_rmse_m")->most, 0.05);
  EXPECT_NEAR(drawing.value("coverage")->median, 0.9, 1e-12);
  EXPECT_NEAR(drawing.value("cpu_ms_per_frame")->median, 200, 1e-9);
  const auto cells = systems_table_cells(table);
  ASSERT_EQ(cells.size(), table.rows.size() + 1);
  EXPECT_NE(std::ranges::find(cells[2], "3.00 [2.00, 5.00]"), cells[2].end());
  const std::string text = render_systems_table(table, TableFormat::markdown);
  testing::expect_contains(text, "3.00 [2.00, 5.00]");
  testing::expect_contains(text, "3/4 ok");
  testing::expect_contains(text, "drawing: 1 of 4 runs not ok: drawing: signal 9 (Killed)");
  const std::string without_notes =
      render_systems_table(systems_table_of({run_of("full", 0.01)}), TableFormat::markdown);
  EXPECT_NE(text.find("\n\nMedians"), std::string::npos);
  EXPECT_NE(without_notes.find("|\n\nMedians"), std::string::npos) << without_notes;
  const std::string folded = render_systems_table(table, TableFormat::markdown, {}, 80);
  EXPECT_NE(folded.find("\n\n| recording"), std::string::npos) << folded;
  testing::expect_contains(render_systems_table(table, TableFormat::json), "\"least\": 0.02");
  testing::expect_contains(render_systems_table(table, TableFormat::csv), ",0.03,0.02,0.05,");
}

TEST(SystemsTable, VersionsAndFramesOfOneSystemAreRowsApart) {
  std::vector<FoundRun> runs = {run_of("mine", 0.01), run_of("mine", 0.02), run_of("mine", 0.04)};
  runs[0].record.config_hash = "0123456789abcdef";
  runs[1].record.config_hash = runs[2].record.config_hash = "fedcba9876543210";
  runs[1].record.recording.frames = runs[0].record.recording.frames = 100;
  runs[2].record.recording.first_frame = 20;
  runs[2].record.recording.frames = 30;
  const SystemsTable table = systems_table_of(runs);
  ASSERT_GE(table.rows.size(), 3U);
  EXPECT_EQ(table.rows[0].system, "mine #01234567 [0:100]");
  EXPECT_EQ(table.rows[1].system, "mine #fedcba98 [0:100]");
  EXPECT_EQ(table.rows[2].system, "mine #fedcba98 [20:50]");
}

TEST(SystemsTable, PosesOfTheEndAreARowOfTheirOwn) {
  FoundRun run = run_of("full", 0.03);
  run.record.final_metrics = run.record.metrics;
  run.record.final_metrics->ate.value->stats = metrics::statistics(std::vector<double>{0.01});
  const SystemsTable table = systems_table_of({run});
  ASSERT_GE(table.rows.size(), 2U);
  EXPECT_EQ(table.rows[0].poses, "online");
  EXPECT_DOUBLE_EQ(table.rows[0].value("ate_rmse_m")->median, 0.03);
  EXPECT_EQ(table.rows[1].poses, "final");
  EXPECT_EQ(table.rows[1].system, "full");
  EXPECT_DOUBLE_EQ(table.rows[1].value("ate_rmse_m")->median, 0.01);
}

TEST(SystemsTable, PosesOfTheEndOfALostRunAreARowOfTheirOwn) {
  FoundRun run = run_of("full", 0.03);
  run.record.status = RunStatus::lost;
  run.record.final_metrics = run.record.metrics;
  const SystemsTable table = systems_table_of({run});
  ASSERT_GE(table.rows.size(), 2U);
  EXPECT_EQ(table.rows[0].poses, "online");
  EXPECT_EQ(table.rows[0].runs, 1U);
  EXPECT_EQ(table.rows[1].poses, "final");
  EXPECT_EQ(table.rows[1].runs, 1U);
}

TEST(SystemsTable, ComparesOnlySeveralSystemsOrRevisedPoses) {
  const auto of_method = [](const std::string& variant, const std::string& method) {
    FoundRun run = run_of(variant, 0.01);
    run.record.config = {{"system.method", method, "the variant"}};
    return run;
  };
  const FoundRun full = of_method("full", "filter");
  const FoundRun other = of_method("infinitam", "infinitam");
  EXPECT_FALSE(compares_systems({full, of_method("dm", "filter")}));
  EXPECT_TRUE(compares_systems({full, other}));
  EXPECT_FALSE(compares_systems({other, other}));
  EXPECT_TRUE(compares_systems({full, run_of("imported", 0.02)}));
  FoundRun damaged = run_of("unknown", 0, "its record is no record");
  damaged.state = RunState::damaged;
  EXPECT_FALSE(compares_systems({full, damaged}));
  FoundRun revised = full;
  revised.record.final_metrics = revised.record.metrics;
  EXPECT_TRUE(compares_systems({revised}));
}

TEST(SystemsTable, LabelsPublishedNumbersAndKeepsThemApart) {
  const SystemsTable table = systems_table_of({run_of("full", 0.01)});
  const auto elastic = std::ranges::find(table.rows, "ElasticFusion", &SystemRow::system);
  ASSERT_NE(elastic, table.rows.end());
  EXPECT_EQ(elastic->poses, "published");
  EXPECT_EQ(elastic->runs, 0U);
  EXPECT_DOUBLE_EQ(elastic->value("ate_rmse_m")->median, 0.011);
  EXPECT_FALSE(elastic->value("cpu_ms_per_frame").has_value());
}

}  // namespace
}  // namespace fusebench
