// Runs whose files are not what they were when they were written: each is a row that says so, and no other
// row changes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/base/io/staged_folder.hpp"
#include "core/base/trajectory/trajectory_file.hpp"
#include "eval/compare/aggregate/record_scan.hpp"
#include "eval/compare/aggregate/run_rows.hpp"
#include "eval/compare/comparison.hpp"
#include "eval/compare/tables/table.hpp"
#include "eval/metrics/intensity_file.hpp"
#include "eval/record/run_files/record_files.hpp"
#include "eval/report/results_page.hpp"
#include "eval/suites/engine/run_housekeeping.hpp"
#include "tests/support/collected_table.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace io;
using namespace config;
using namespace trajectory;
using namespace metrics;
using namespace trajectory_error;
using namespace record;
using namespace run_files;
using namespace engine;
using namespace aggregate;
using namespace tables;
using namespace page;
using namespace compare;
using namespace report;

namespace {

namespace fs = std::filesystem;
using testing::collect_table;

class DamagedRunsTest : public testing::InTemporaryFolder {
 protected:
  /// Two good runs in each of two folders.
  void SetUp() override {
    for (const char* side : {"base", "runs"}) {
      add(side, "full");
      add(side, "dm");
    }
  }

  void add(const char* side, const std::string& variant) const {
    RunRecord record;
    record.status = RunStatus::ok;
    record.reason = "";
    record.run_id = std::string(32, variant == "dm" ? 'd' : 'f');
    record.recording.name = "desk";
    record.recording.fingerprint = "0123";
    record.recording.frames = 2;
    record.variant = variant;
    record.config_hash = variant;
    record.config.push_back({"iekf.max_iterations", std::int64_t{3}, "default"});
    record.frames = {2, 2, 0};
    AteResult ate;
    ate.stats = statistics(std::vector<double>{0.01});
    record.metrics.ate = {ate, {}};
    const std::vector<IntensityResidual> pixels = {{5, 2.0F, true}, {7, 10.0F, true}};
    IntensityAccumulator sums;
    sums.add_frame(pixels);
    record.metrics.aie = {sums.result(), {}};
    auto folder = StagedFolder::create(folder_ / side / "desk" / variant / record.run_id.substr(0, 8));
    ASSERT_TRUE(folder.has_value());
    auto writer = IntensityWriter::create(folder->file("intensity.bin"), 640, 480);
    ASSERT_TRUE(writer && writer->write_frame(1, {}) && writer->write_frame(2, pixels) && writer->finish());
    const Trajectory trajectory = {{1'000'000'000, SE3{}}, {2'000'000'000, SE3{}}};
    ASSERT_TRUE(folder->write("trajectory.tum", tum_text(trajectory)));
    ASSERT_TRUE(folder->write("mesh.ply", "a mesh"));
    ASSERT_TRUE(folder->write("frames.csv", "times"));
    ASSERT_TRUE(commit_run(*folder, record));
  }

  [[nodiscard]] fs::path damaged(const char* name) const { return folder_ / "runs/desk/dm/dddddddd" / name; }
  void overwrite(const char* name, const std::string& content) const {
    std::ofstream(damaged(name), std::ios::binary | std::ios::trunc) << content;
  }
  void flip_byte(const char* name, std::size_t at) const {
    std::string content = testing::read_bytes(damaged(name));
    ASSERT_LT(at, content.size());
    content[at] = static_cast<char>(content[at] ^ 0x40);
    overwrite(name, content);
  }

  /// In everything that reads folders of runs.
  void expect_row(const std::string& reason) const {
    const auto table = collect_table(folder_ / "runs");
    ASSERT_TRUE(table.has_value()) << table.error().message;
    ASSERT_EQ(table->rows.size(), 2U);
    EXPECT_EQ(table->rows[0].status, RunStatus::ok);
    EXPECT_TRUE(table->rows[0].numbers["ate_rmse_m"].has_value());
    const TableRow& row = table->rows[1];
    EXPECT_EQ(row.recording, "desk");
    EXPECT_EQ(row.variant, "dm");
    EXPECT_EQ(row.status, RunStatus::failed);
    EXPECT_EQ(row.reason, reason);
    EXPECT_FALSE(row.numbers["ate_rmse_m"].has_value());
    EXPECT_NE(render_table(*table, TableFormat::markdown).find("1 of 2 runs ok"), std::string::npos);

    const auto collected = read_run_rows(folder_ / "runs", Workers(1));
    ASSERT_TRUE(collected.has_value());
    EXPECT_EQ(unreadable_count(*collected), 1U);
    EXPECT_EQ((*collected)[1].variant, "dm");
    EXPECT_EQ((*collected)[1].reason, reason);
    EXPECT_FALSE((*collected)[1].numbers["ate_rmse_m"].has_value());

    const auto listed = list_runs(folder_ / "runs");
    ASSERT_TRUE(listed.has_value());
    EXPECT_EQ(listed->front().head.status, RunStatus::failed);
    EXPECT_EQ(listed->front().head.reason, reason);

    const auto found = find_runs(folder_ / "runs");
    const auto base = find_runs(folder_ / "base");
    for (const auto& comparison :
         {compare_runs(*base, *found, Gates()), compare_runs(*found, *base, Gates())}) {
      ASSERT_FALSE(comparison.has_value());
      EXPECT_EQ(comparison.error().code, ErrorCode::data_corrupt);
      EXPECT_EQ(comparison.error().message, damaged(reason.c_str()).string());
    }
    EXPECT_NE(to_html(results_page(*found, "t").page).find("1 of 2 runs ok"), std::string::npos);
  }
};

TEST_F(DamagedRunsTest, WhatIsWholeIsARowWithItsNumbers) {
  const auto record = read_record(damaged("record.json"));
  ASSERT_TRUE(record.has_value()) << record.error().message;
  ASSERT_EQ(record->files.size(), 3U);
  EXPECT_EQ(record->files[0].name, "intensity.bin");
  EXPECT_EQ(record->files[0].bytes, fs::file_size(damaged("intensity.bin")));
  EXPECT_EQ(record->files[0].xxh3.size(), 32U);
  // It holds times, and what stands outside `timing` is the same in each repetition.
  ASSERT_EQ(record->timing.files.size(), 1U);
  EXPECT_EQ(record->timing.files[0].name, "frames.csv");
  const auto table = collect_table(folder_ / "runs");
  EXPECT_TRUE(table->rows[1].numbers["ate_rmse_m"].has_value());
  EXPECT_TRUE(table->rows[1].numbers["aie_common_grey"].has_value());
  EXPECT_TRUE(compare_runs(*find_runs(folder_ / "base"), *find_runs(folder_ / "runs"), Gates())->passed());
  const auto listed = list_runs(folder_ / "runs", true);
  for (const ListedRun& run : *listed) EXPECT_EQ(run.head.status, RunStatus::ok);
}

TEST_F(DamagedRunsTest, ARecordOfZerosAfterItsHead) {
  const std::string whole = testing::read_bytes(damaged("record.json"));
  overwrite("record.json", whole.substr(0, 1000) + std::string(whole.size() - 1000, '\0'));
  expect_row("record.json is damaged: not JSON at byte 1001 (zeros after a power cut?); run it again");
}

TEST_F(DamagedRunsTest, ARecordThatEndsEarly) {
  overwrite("record.json", testing::read_bytes(damaged("record.json")).substr(0, 1000));
  expect_row("record.json is damaged: not JSON at byte 1000, where it ends; run it again");
}

TEST_F(DamagedRunsTest, OfWhichKindTheDataOfALostRecordAreIsUnknown) {
  overwrite("record.json", "{ half");
  const auto table = collect_table(folder_ / "runs");
  ASSERT_TRUE(table.has_value());
  EXPECT_EQ(table->rows[1].data, kUnknownWord);
  EXPECT_EQ(table->rows[1].imu, kUnknownWord);
  EXPECT_NE(render_table(*table, TableFormat::markdown).find("| unknown"), std::string::npos);
  EXPECT_EQ(scan_record("{ half").data, kUnknownWord);
  // Of a run that lost another file only the numbers are in doubt.
  overwrite("record.json", testing::read_bytes(folder_ / "base/desk/dm/dddddddd/record.json"));
  overwrite("mesh.ply", "");
  EXPECT_EQ(collect_table(folder_ / "runs")->rows[1].data, "recorded");
}

TEST_F(DamagedRunsTest, AnEmptyRecord) {
  overwrite("record.json", "");
  expect_row("record.json is damaged: empty; run it again");
}

TEST_F(DamagedRunsTest, EmptiedFiles) {
  for (const char* name : {"mesh.ply", "trajectory.tum", "intensity.bin", "frames.csv"}) {
    const std::string whole = testing::read_bytes(damaged(name));
    overwrite(name, "");
    expect_row(fmt::format("{} is damaged: 0 bytes of {}; run it again", name, whole.size()));
    overwrite(name, whole);
  }
}

/// Sizes are looked at everywhere, contents where they are read for numbers.
TEST_F(DamagedRunsTest, AFlippedByteOfIntensitiesLeavesTheCommonPixels) {
  flip_byte("intensity.bin", fs::file_size(damaged("intensity.bin")) - 13);  // of the last difference
  const auto table = collect_table(folder_ / "runs");
  ASSERT_TRUE(table.has_value());
  for (const TableRow& row : table->rows)
    EXPECT_FALSE(row.numbers["aie_common_grey"].has_value()) << row.variant;
  ASSERT_EQ(table->notes.size(), 1U);
  EXPECT_EQ(
      table->notes[0],
      "desk, dm: left out of AIE common: intensity.bin is damaged: its content is not what the run wrote; "
      "run it again");
  EXPECT_EQ(list_runs(folder_ / "runs")->front().head.status, RunStatus::ok);
  const auto verified = list_runs(folder_ / "runs", true);
  EXPECT_EQ(verified->front().head.status, RunStatus::failed);
  EXPECT_EQ(verified->front().head.reason,
            "intensity.bin is damaged: its content is not what the run wrote; run it again");
  EXPECT_EQ((*verified)[1].head.status, RunStatus::ok);
}

TEST_F(DamagedRunsTest, AFlippedByteOfATrajectoryCannotBeCompared) {
  flip_byte("trajectory.tum", testing::read_bytes(damaged("trajectory.tum")).find("2.0"));
  const auto comparison = compare_runs(*find_runs(folder_ / "base"), *find_runs(folder_ / "runs"), Gates());
  ASSERT_FALSE(comparison.has_value());
  EXPECT_EQ(comparison.error().message,
            damaged("trajectory.tum").string() +
                " is damaged: its content is not what the run wrote; run it again");
  const ResultsPage page = results_page(*find_runs(folder_ / "runs"), "t");
  EXPECT_TRUE(std::ranges::any_of(page.warnings, [](const std::string& warning) {
    return warning.find("trajectory.tum is damaged: its content") != std::string::npos;
  }));
}

TEST_F(DamagedRunsTest, AFlippedByteOfAMeshIsNotShown) {
  flip_byte("mesh.ply", 2);
  const ResultsPage page = results_page(*find_runs(folder_ / "runs"), "t");
  EXPECT_TRUE(std::ranges::any_of(page.warnings, [](const std::string& warning) {
    return warning.find("mesh.ply is damaged: its content") != std::string::npos;
  }));
}

TEST_F(DamagedRunsTest, NothingIsKnownOfTheFilesOfAnOlderRecord) {
  auto record = read_record(damaged("record.json"));
  record->files.clear();
  record->timing.files.clear();
  overwrite("record.json", to_json(*record));
  overwrite("mesh.ply", "");
  const auto table = collect_table(folder_ / "runs");
  EXPECT_EQ(table->rows[1].status, RunStatus::ok);
  EXPECT_TRUE(table->rows[1].numbers["aie_common_grey"].has_value());
  EXPECT_EQ(list_runs(folder_ / "runs", true)->front().head.status, RunStatus::ok);
  EXPECT_EQ(unreadable_count(*read_run_rows(folder_ / "runs", Workers(1))), 0U);
}

/// As in the baseline, which keeps record and trajectory only.
TEST_F(DamagedRunsTest, FilesThatSomebodyTookAwayAreNoDamage) {
  for (const char* name : {"mesh.ply", "intensity.bin", "frames.csv"}) fs::remove(damaged(name));
  EXPECT_TRUE(compare_runs(*find_runs(folder_ / "base"), *find_runs(folder_ / "runs"), Gates())->passed());
  EXPECT_EQ(collect_table(folder_ / "runs")->rows[1].status, RunStatus::ok);
  EXPECT_EQ(unreadable_count(*read_run_rows(folder_ / "runs", Workers(1))), 0U);
}

TEST_F(DamagedRunsTest, RecordingsWithHiddenNamesAreFound) {
  fs::rename(folder_ / "runs/desk", folder_ / "runs/.rec1");
  fs::create_directories(folder_ / "runs/.rec1.tmp");
  fs::copy(folder_ / "runs/.rec1", folder_ / "runs/.rec1.tmp", fs::copy_options::recursive);
  EXPECT_EQ(find_runs(folder_ / "runs")->size(), 4U);
  EXPECT_EQ(list_runs(folder_ / "runs")->size(), 4U);
  EXPECT_EQ(read_run_rows(folder_ / "runs", Workers(1))->size(), 4U);
}

TEST_F(DamagedRunsTest, LinkedFoldersAreLookedThroughOnceAndNeverInCircles) {
  // As an engine finds them, which follows links.
  fs::rename(folder_ / "runs/desk", folder_ / "elsewhere");
  fs::create_directory_symlink(folder_ / "elsewhere", folder_ / "runs/desk");
  ASSERT_TRUE(found_run(folder_ / "runs/desk/dm/dddddddd").has_value());
  const auto files = record_files(folder_ / "runs");
  ASSERT_TRUE(files.has_value()) << files.error().message;
  EXPECT_EQ(files->size(), 2U);
  fs::create_directory_symlink(folder_ / "elsewhere/dm", folder_ / "runs/again");
  fs::create_directory_symlink(folder_ / "runs", folder_ / "elsewhere/back");
  fs::create_directory_symlink(folder_, folder_ / "runs/up");
  fs::create_directory_symlink("self", folder_ / "runs/self");
  fs::create_directory_symlink("nowhere", folder_ / "runs/dangling");
  const auto same = record_files(folder_ / "runs");
  ASSERT_TRUE(same.has_value()) << same.error().message;
  EXPECT_EQ(same->size(), 2U);
}

}  // namespace
}  // namespace fusebench
