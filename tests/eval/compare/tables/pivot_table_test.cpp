#include "eval/compare/tables/pivot_table.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/eval/compare/tables/folder_of_runs.hpp"
#include "tests/support/collected_table.hpp"

namespace fusebench {

using namespace record;
using namespace tables;

namespace {

using testing::collect_table;

using PivotTableTest = testing::InFolderOfRuns;

TEST_F(PivotTableTest, HasALineARecordingAndAColumnAMethodWithTheBestInBold) {
  add_run("full", RunStatus::ok, "", 0.0123, {});
  add_run("dm", RunStatus::ok, "", 0.02, {});
  add_run("no-imu", RunStatus::lost, "why", 0, {});
  const auto table = collect_table(folder_ / "runs");
  ASSERT_TRUE(table.has_value()) << table.error().message;
  const registry::RunMetric& ate = registry::run_metric("ate_rmse_m");
  const std::string latex = render_pivot(*table, ate, TableFormat::latex, {1, false}).value();
  EXPECT_NE(latex.find(" & \\textbf{1.23} & 2.00 & lost"), std::string::npos) << latex;
  EXPECT_NE(latex.find("\\begin{table}"), std::string::npos);
  EXPECT_NE(latex.find("\\label{tab:pivot-ate-rmse-m}"), std::string::npos);
  const std::string csv = render_pivot(*table, ate, TableFormat::csv).value();
  EXPECT_NE(csv.find(",0.0123,0.02,\n"), std::string::npos) << csv;
  const std::string markdown = render_pivot(*table, ate, TableFormat::markdown).value();
  EXPECT_NE(markdown.find("1.23"), std::string::npos) << markdown;
  EXPECT_EQ(render_pivot(*table, ate, TableFormat::json).error().code, ErrorCode::usage);
}

TEST_F(PivotTableTest, ARunThatTrackedFewFramesIsNotTheBest) {
  add_run("full", RunStatus::ok, "", 0.0123, {});
  add_run("dm", RunStatus::ok, "", 0.02, {});
  add_run("other", RunStatus::ok, "", 0.005, {});
  const auto file = std::filesystem::path("runs") / recording_ / "other/01234567/record.json";
  RunRecord record = *read_record(folder_ / file);
  record.frames = {240, 48, 192};
  record.recording.notes = {"warning: the poses contradict the ground truth: ATE 0.85 m"};
  write(file, to_json(record));
  const auto table = collect_table(folder_ / "runs");
  ASSERT_TRUE(table.has_value()) << table.error().message;
  const registry::RunMetric& ate = registry::run_metric("ate_rmse_m");
  const std::string latex = render_pivot(*table, ate, TableFormat::latex, {1, false}).value();
  EXPECT_NE(latex.find(" & \\textbf{1.23} & 2.00 & 0.50 (20 \\%) *"), std::string::npos) << latex;
  const std::string markdown = render_pivot(*table, ate, TableFormat::markdown).value();
  EXPECT_NE(markdown.find("share of frames tracked"), std::string::npos) << markdown;
  EXPECT_NE(markdown.find("*: the poses contradict"), std::string::npos) << markdown;
  const registry::RunMetric& coverage = registry::run_metric("coverage");
  const std::string tracked = render_pivot(*table, coverage, TableFormat::latex, {1, false}).value();
  EXPECT_NE(tracked.find(" 20.0 \\\\"), std::string::npos) << "without marks: " << tracked;
}

TEST_F(PivotTableTest, ChosenColumnsAloneAreInTheTableOfRuns) {
  add_three_runs();
  const auto table = collect_table(folder_ / "runs");
  LatexLayout layout{1, false, {"ate_rmse_m", "frames_tracked"}};
  ASSERT_TRUE(check_latex_metrics(layout.metrics).has_value());
  const std::string latex = render_table(*table, TableFormat::latex, layout);
  EXPECT_NE(latex.find("status & ATE [cm] & tracked \\\\"), std::string::npos) << latex;
  EXPECT_NE(latex.find("\\textbf{1.23} &"), std::string::npos) << latex;
  EXPECT_NE(latex.find("\nATE: rmse of positions"), std::string::npos) << latex;
  EXPECT_EQ(latex.find("RPE:"), std::string::npos) << "a column that is not in the table";
  EXPECT_EQ(latex.find("fps:"), std::string::npos) << latex;
  const auto unknown = check_latex_metrics({"ate"});
  ASSERT_FALSE(unknown.has_value());
  EXPECT_NE(unknown.error().message.find("ate_rmse_m"), std::string::npos) << unknown.error().message;
}

}  // namespace
}  // namespace fusebench
