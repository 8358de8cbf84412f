#include "eval/compare/tables/table.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "eval/text/plain_table.hpp"
#include "tests/eval/compare/tables/folder_of_runs.hpp"
#include "tests/support/collected_table.hpp"

namespace fusebench {

using namespace metrics;
using namespace trajectory_error;
using namespace record;
using namespace run_files;
using namespace tables;

namespace {

using testing::collect_table;

using TableTest = testing::InFolderOfRuns;

TEST_F(TableTest, RowsAreInTheOrderOfVariantsWithCommonPixels) {
  add_three_runs();
  const auto table = collect_table(folder_ / "runs");
  ASSERT_TRUE(table.has_value()) << table.error().message;
  ASSERT_EQ(table->rows.size(), 3U);
  EXPECT_EQ(table->rows[0].variant, "full");
  EXPECT_EQ(table->rows[1].variant, "dm");
  EXPECT_EQ(table->rows[2].variant, "no-imu");
  EXPECT_DOUBLE_EQ(*table->rows[0].numbers["aie_grey"], 6.0);
  EXPECT_DOUBLE_EQ(*table->rows[0].numbers["aie_common_grey"], 2.0);
  EXPECT_DOUBLE_EQ(*table->rows[1].numbers["aie_common_grey"], 3.0);
  EXPECT_DOUBLE_EQ(*table->rows[0].numbers["ate_rmse_m"], 0.0123);
}

TEST_F(TableTest, ALostRunIsARowWithItsReasonAndNoNumbers) {
  add_three_runs();
  const auto table = collect_table(folder_ / "runs");
  ASSERT_TRUE(table.has_value());
  const TableRow& lost = table->rows[2];
  EXPECT_EQ(lost.status, RunStatus::lost);
  EXPECT_FALSE(lost.numbers["ate_rmse_m"].has_value());
  EXPECT_FALSE(lost.numbers["aie_common_grey"].has_value());
  EXPECT_EQ(lost.tracked, 12U);
  const std::string text = render_table(*table, TableFormat::markdown);
  EXPECT_NE(text.find("2 of 3 runs ok"), std::string::npos) << text;
  const std::string folded = render_table(*table, TableFormat::markdown, {}, 80);
  EXPECT_NE(folded.find("\n\n| recording"), std::string::npos) << folded;
  EXPECT_NE(text.find("lost at frame 12"), std::string::npos) << text;
  EXPECT_NE(text.find("synthetic IMU: made from the ground truth"), std::string::npos) << text;
}

TEST_F(TableTest, SimulatedDataIsLabelled) {
  add_run("full", RunStatus::ok, "", 0.0123, {});
  const auto before = collect_table(folder_ / "runs");
  ASSERT_TRUE(before.has_value());
  for (const TableFormat format :
       {TableFormat::markdown, TableFormat::csv, TableFormat::json, TableFormat::latex})
    EXPECT_EQ(render_table(*before, format).find("simulated"), std::string::npos);
  ResultTable table = *before;
  table.rows[0].data = "simulated";
  for (const TableFormat format :
       {TableFormat::markdown, TableFormat::csv, TableFormat::json, TableFormat::latex})
    EXPECT_NE(render_table(table, format).find("simulated"), std::string::npos);
}

TEST_F(TableTest, APseudoGroundTruthIsMarkedAndExplained) {
  RunRecord record;
  record.recording.name = "walk";
  for (const char* const truth : {"none", "given"}) {
    record.recording.truth = truth;
    write("runs/walk/full/01234567/record.json", to_json(record));
    const auto without = collect_table(folder_ / "runs");
    ASSERT_TRUE(without.has_value()) << without.error().message;
    for (const TableFormat format :
         {TableFormat::markdown, TableFormat::csv, TableFormat::json, TableFormat::latex})
      EXPECT_EQ(render_table(*without, format).find("pseudo"), std::string::npos);
  }
  record.recording.truth = kPseudoTruthWord;
  write("runs/walk/full/01234567/record.json", to_json(record));
  const auto table = collect_table(folder_ / "runs");
  ASSERT_TRUE(table.has_value()) << table.error().message;
  const std::string mark = "recorded, pseudo ground truth";
  const std::string footnote = "pseudo ground truth: the reference is a batch estimate of the same recording";
  EXPECT_NE(render_table(*table, TableFormat::markdown).find("| walk      | " + mark + " |"),
            std::string::npos)
      << render_table(*table, TableFormat::markdown);
  EXPECT_NE(render_table(*table, TableFormat::latex).find("& " + mark + " &"), std::string::npos);
  EXPECT_NE(render_table(*table, TableFormat::csv).find("walk,recorded,none,pseudo ground truth,"),
            std::string::npos);
  const auto document = nlohmann::json::parse(render_table(*table, TableFormat::json));
  EXPECT_EQ(document.at("rows").at(0).at("truth"), kPseudoTruthWord);
  EXPECT_TRUE(document.at("protocol").back().get<std::string>().starts_with(footnote));
  EXPECT_NE(render_table(*table, TableFormat::markdown).find(footnote), std::string::npos);
}

TEST_F(TableTest, MarkdownLinesAreAligned) {
  add_three_runs();
  const std::string text = render_table(*collect_table(folder_ / "runs"), TableFormat::markdown);
  std::istringstream lines(text);
  std::size_t width = 0;
  int rows = 0;
  for (std::string line; std::getline(lines, line) && line.starts_with("|"); ++rows) {
    if (rows == 0) width = line.size();
    EXPECT_EQ(line.size(), width) << line;
    EXPECT_EQ(std::count(line.begin(), line.end(), '|'), 15) << line;
  }
  EXPECT_EQ(rows, 5);
}

TEST_F(TableTest, ASignificantOffsetOfTheReferenceClockIsANote) {
  add_three_runs();
  auto runs = find_runs(folder_ / "runs");
  ASSERT_TRUE(runs.has_value()) << runs.error().message;
  for (FoundRun& run : *runs) {
    run.record.recording.truth = "given";
    if (run.record.variant != "dm") continue;
    run.record.metrics.reference_clock = {
        reference_clock::ReferenceClock{{0.066, 0.002, 100}, false, {0.052, {}, {}, {}}, {0.041, {}, {}, {}}},
        {}};
  }
  const std::vector<std::string> notes = table_of(*runs).notes;
  EXPECT_EQ(
      std::ranges::count(notes,
                         "fr1_rpy, dm: the reference clock is 66 +- 2 ms off; ATE 4.10 instead of 5.20 cm "
                         "with --set evaluation.reference_time_offset=fitted"),
      1);
  EXPECT_EQ(std::ranges::count_if(
                notes, [](const std::string& note) { return note.find("clock") != std::string::npos; }),
            1);
}

TEST_F(TableTest, CsvAndJsonCarryTheSameNumbers) {
  add_three_runs();
  const auto table = collect_table(folder_ / "runs");
  const auto document = nlohmann::json::parse(render_table(*table, TableFormat::json));
  EXPECT_EQ(document.at("n_ok"), 2);
  EXPECT_EQ(document.at("n_total"), 3);
  EXPECT_EQ(document.at("rows").at(0).at("ate_rmse_m"), 0.0123);
  EXPECT_TRUE(document.at("rows").at(2).at("ate_rmse_m").is_null());
  EXPECT_EQ(document.at("rows").at(0).at("ate_fitted_m"), 0.0123 / 2);
  EXPECT_TRUE(document.at("rows").at(1).at("ate_fitted_m").is_null());
  std::istringstream lines(render_table(*table, TableFormat::csv));
  std::string header, full;
  std::getline(lines, header);
  std::getline(lines, full);
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(full.begin(), full.end(), ','));
  EXPECT_NE(full.find(",0.0123,"), std::string::npos) << full;
}

TEST_F(TableTest, LongCsvHasALineForEachNumber) {
  add_three_runs();
  const std::string text = render_table(*collect_table(folder_ / "runs"), TableFormat::csv_long);
  EXPECT_NE(text.find("fr1_rpy,recorded,synthetic IMU,none,full,01234567,,0,1,ok,ate_rmse_m,m,0.0123\n"),
            std::string::npos)
      << text;
  EXPECT_EQ(text.find("lost,ate_rmse_m"), std::string::npos) << text;  // does not exist
  EXPECT_NE(text.find("lost,frames_tracked,frames,12\n"), std::string::npos) << text;
}

TEST_F(TableTest, MeansAreOverOkRunsOfOneKindOfData) {
  add_three_runs();
  recording_ = "fr1_xyz";
  add_run("full", RunStatus::ok, "", 0.0277, {{5, 2.0F, true}, {7, 10.0F, true}});
  add_run("no-imu", RunStatus::ok, "", 0.5, {{5, 2.0F, true}});
  const auto table = collect_table(folder_ / "runs");
  ASSERT_EQ(table->means.size(), 2U);  // dm ran on one recording
  EXPECT_EQ(table->means[0].variant, "full");
  EXPECT_EQ(table->means[0].ok, 2U);
  EXPECT_DOUBLE_EQ(*table->means[0].values["ate_rmse_m"], 0.02);
  EXPECT_EQ(table->means[1].ok, 1U);
  EXPECT_EQ(table->means[1].total, 2U);
  EXPECT_DOUBLE_EQ(*table->means[1].values["ate_rmse_m"], 0.5);
  EXPECT_NE(render_table(*table, TableFormat::markdown).find("| 1/2 ok |"), std::string::npos);
}

TEST_F(TableTest, AMeanOverPartsOfARecordingSaysSo) {
  add_run("full", RunStatus::ok, "", 0.01, {}, "aaaaaaaa");
  add_run("full", RunStatus::ok, "", 0.03, {}, "bbbbbbbb");
  const auto part = std::filesystem::path("runs") / recording_ / "full/bbbbbbbb/record.json";
  RunRecord record = *read_record(folder_ / part);
  record.frames = {100, 100, 0};
  write(part, to_json(record));
  recording_ = "fr1_xyz";
  add_run("full", RunStatus::ok, "", 0.02, {});
  add_run("dm", RunStatus::ok, "", 0.02, {});
  recording_ = "fr1_rpy";
  add_run("dm", RunStatus::ok, "", 0.02, {});
  const auto table = collect_table(folder_ / "runs");
  ASSERT_TRUE(table.has_value());
  ASSERT_EQ(table->means.size(), 2U);
  EXPECT_EQ(table->means[0].windows, 3U);
  const auto cells = table_cells(*table);
  EXPECT_EQ(cells[cells.size() - 2][0], "mean over 3 windows of 2 recordings");
  EXPECT_EQ(cells.back()[0], "mean over 2 recordings");
}

TEST_F(TableTest, AMeanSaysThatItCountsRunsAsSilentAndARowFrames) {
  ResultTable table;
  table.means.push_back({"recorded", "none", "given", "full", "full", 2, 2, 2, 1, {}, 2});
  EXPECT_EQ(table_cells(table).back()[4], "2/2 ok (1 run with undetected failures)");
}

TEST_F(TableTest, TwoRunsOfOneVariantAreToldApart) {
  add_run("full", RunStatus::ok, "", 0.01, {{5, 2.0F, true}}, "aaaaaaaa");
  add_run("full", RunStatus::ok, "", 0.02, {{5, 2.0F, true}}, "bbbbbbbb");
  const std::string text = render_table(*collect_table(folder_ / "runs"), TableFormat::markdown);
  EXPECT_NE(text.find("full (aaaaaaaa)"), std::string::npos) << text;
  EXPECT_NE(text.find("full (bbbbbbbb)"), std::string::npos) << text;
}

TEST_F(TableTest, ReplicatesAreOneRowWithMediansAndRanges) {
  const std::vector<double> ates = {0.010, 0.014, 0.011};
  for (std::size_t k = 0; k < ates.size(); ++k) {
    const std::string hash = fmt::format("{0}{0}{0}{0}{0}{0}{0}{0}", k);
    add_run("full", RunStatus::ok, "", ates[k], {}, hash.c_str());
    const auto file = std::filesystem::path("runs") / recording_ / "full" / hash / "record.json";
    RunRecord record = *read_record(folder_ / file);
    record.replicate = static_cast<int>(k);
    write(file, to_json(record));
  }
  add_run("dm", RunStatus::ok, "", 0.02, {});
  const auto table = collect_table(folder_ / "runs");
  ASSERT_TRUE(table.has_value()) << table.error().message;
  ASSERT_EQ(table->rows.size(), 2U);
  EXPECT_EQ(table->rows[0].label, "full");
  EXPECT_EQ(table->rows[0].numbers["ate_rmse_m"], 0.011);
  const std::string text = render_table(*table, TableFormat::markdown);
  EXPECT_NE(text.find("1.10 [1.00, 1.40]"), std::string::npos) << text;
  EXPECT_NE(text.find("3/3 ok"), std::string::npos) << text;
  EXPECT_NE(text.find(" 0.36 |"), std::string::npos) << text;  // sensitivity: 0.4 / 1.1
  const auto json = nlohmann::json::parse(render_table(*table, TableFormat::json));
  EXPECT_EQ(json["rows"][0]["replicates"], 3);
  EXPECT_EQ(json["rows"][0]["ranges"]["ate_rmse_m"], (nlohmann::json{0.010, 0.014}));
}

TEST_F(TableTest, RowsOfASweepHaveTheirOptionsAndMeansAreOfOneConfiguration) {
  for (const char* recording : {"fr1_rpy", "fr1_xyz"}) {
    recording_ = recording;
    add_run("full", RunStatus::ok, "", 0.01, {}, "aaaaaaaa");
    add_run("full", RunStatus::ok, "", 0.03, {}, "bbbbbbbb");
    const auto edited = std::filesystem::path("runs") / recording / "full/bbbbbbbb/record.json";
    RunRecord record = *read_record(folder_ / edited);
    record.config = {{"tsdf.voxel_m", 0.02, "sweep"}};
    write(edited, to_json(record));
    const auto plain = std::filesystem::path("runs") / recording / "full/aaaaaaaa/record.json";
    record = *read_record(folder_ / plain);
    record.config = {{"tsdf.voxel_m", 0.01, "default"}};
    write(plain, to_json(record));
  }
  const auto table = collect_table(folder_ / "runs");
  ASSERT_TRUE(table.has_value());
  EXPECT_EQ(table->rows[0].label, "full");
  EXPECT_EQ(table->rows[1].label, "full tsdf.voxel_m=0.02");
  ASSERT_EQ(table->means.size(), 2U);
  EXPECT_DOUBLE_EQ(*table->means[0].values["ate_rmse_m"], 0.01);
  EXPECT_DOUBLE_EQ(*table->means[1].values["ate_rmse_m"], 0.03);
  EXPECT_EQ(table->means[1].label, "full tsdf.voxel_m=0.02");
  const auto json = nlohmann::json::parse(render_table(*table, TableFormat::json));
  EXPECT_EQ(json["rows"][1]["options"]["tsdf.voxel_m"], "0.02");
  EXPECT_NE(render_table(*table, TableFormat::csv).find("bbbbbbbb,tsdf.voxel_m=0.02,0,1,ok"),
            std::string::npos);
}

TEST_F(TableTest, DamagedDifferencesCostOnlyTheCommonColumn) {
  add_three_runs();
  std::filesystem::resize_file(folder_ / "runs/fr1_rpy/dm/01234567/intensity.bin", 30);
  const auto table = collect_table(folder_ / "runs");
  ASSERT_TRUE(table.has_value());
  EXPECT_FALSE(table->rows[0].numbers["aie_common_grey"].has_value());
  EXPECT_TRUE(table->rows[0].numbers["aie_grey"].has_value());
  EXPECT_NE(render_table(*table, TableFormat::markdown).find("intensity.bin"), std::string::npos);
}

TEST_F(TableTest, RunsThatKeptNoDifferencesHaveNoCommonPixels) {
  add_three_runs();
  std::filesystem::remove(folder_ / "runs/fr1_rpy/dm/01234567/intensity.bin");
  const auto table = collect_table(folder_ / "runs");
  ASSERT_TRUE(table.has_value());
  EXPECT_NE(std::ranges::find(table->notes,
                              "fr1_rpy: no AIE on common pixels, which needs runs made with --keep all"),
            table->notes.end());
}

TEST_F(TableTest, AnImportedRunLeavesTheCommonPixelsOfOursAlone) {
  add_three_runs();
  RunRecord imported = *read_record(folder_ / "runs/fr1_rpy/full/01234567/record.json");
  imported.variant = "Other";
  imported.metrics.aie = {std::nullopt, "says nothing of intensities"};
  imported.config.clear();
  write("runs/fr1_rpy/Other/01234567/record.json", to_json(imported));
  const auto table = collect_table(folder_ / "runs");
  ASSERT_EQ(table->rows.size(), 4U);
  EXPECT_EQ(table->rows[3].variant, "Other");
  EXPECT_DOUBLE_EQ(*table->rows[0].numbers["aie_common_grey"], 2.0);
  EXPECT_FALSE(table->rows[3].numbers["fps"].has_value());
  EXPECT_FALSE(table->rows[3].numbers["model_vertices"].has_value());
}

TEST_F(TableTest, UnfinishedRunsAreNotRead) {
  add_three_runs();
  write("runs/fr1_rpy/full/.01234567.99.tmp/new/record.json", "half");
  EXPECT_EQ(collect_table(folder_ / "runs")->rows.size(), 3U);
}

TEST_F(TableTest, ErrorsAreTyped) {
  EXPECT_EQ(collect_table(folder_ / "absent").error().code, ErrorCode::data_missing);
  EXPECT_EQ(collect_table(folder_).error().code, ErrorCode::data_missing);
  EXPECT_EQ(parse_table_format("pdf").error().code, ErrorCode::usage);
}

}  // namespace
}  // namespace fusebench
