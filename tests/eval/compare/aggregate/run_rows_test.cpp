#include "eval/compare/aggregate/run_rows.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <tuple>

#include "eval/compare/aggregate/long_table.hpp"
#include "eval/compare/aggregate/record_scan.hpp"
#include "eval/record/run_files/found_runs.hpp"
#include "eval/record/run_files/run_set.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace config;
using namespace metrics;
using namespace trajectory_error;
using namespace record;
using namespace run_files;
using namespace aggregate;

namespace {

RunRecord sample_record(const std::string& recording, const std::string& variant, double ate_m) {
  RunRecord record;
  record.status = RunStatus::ok;
  record.reason.clear();
  record.recording.name = recording;
  record.recording.truth = "given";
  record.recording.imu = "recorded";
  record.recording.fingerprint = "0123";
  record.recording.frames = 100;
  record.recording.notes = {"a note, with a \"mesh\"", "frames"};
  record.variant = variant;
  record.config_hash = "0011223344556677";
  record.config = {{"iekf.max_iterations", std::int64_t{8}, "--set"},
                   {"depth.max_m", 2.5, "sweep.toml:3"},
                   {"terms.visibility_test", true, "variant dm"},
                   {"terms.prior", std::string("imu"), "default"}};
  AteResult ate;
  ate.stats = statistics(std::vector<double>{ate_m});
  record.metrics.ate = {ate, {}};
  RpeResult rpe;
  rpe.translation = statistics(std::vector<double>{0.002});
  rpe.rotation = statistics(std::vector<double>{0.003});
  record.metrics.rpe_second = {rpe, {}};
  RecordedMesh mesh;
  mesh.poses.accuracy.stats = statistics(std::vector<double>{0.004});
  mesh.poses.completeness.stats = statistics(std::vector<double>{0.005});
  mesh.first_camera.accuracy.stats = statistics(std::vector<double>{9.0});
  record.metrics.mesh = {mesh, {}};
  record.frames = {100, 70, 10};
  record.recording.first_frame = 20;
  record.repetition = 3;
  record.timing = {20, 4, 1'000'000, 4, {{"update", 3.0}}};
  return record;
}

TEST(RecordScan, KeepsWhatTheRecordHas) {
  const RunRow row = scan_record(to_json(sample_record("desk", "dm", 0.0123)));
  ASSERT_TRUE(row.readable) << row.reason;
  EXPECT_EQ(std::tie(row.recording, row.data, row.imu, row.truth, row.variant),
            std::tuple("desk", "recorded", "recorded", "given", "dm"));
  EXPECT_EQ(row.status, RunStatus::ok);
  EXPECT_EQ(row.numbers["ate_rmse_m"], 0.0123);
  EXPECT_EQ(row.numbers["rpe_1s_m"], 0.002);
  EXPECT_EQ(row.numbers["rpe_1s_rad"], 0.003);
  EXPECT_FALSE(row.numbers["rpe_frame_m"].has_value());
  EXPECT_FALSE(row.numbers["aie_grey"].has_value());
  EXPECT_EQ(row.numbers["mesh_accuracy_m"], 0.004);  // the main one, not that of the first camera
  EXPECT_EQ(row.numbers["mesh_completeness_m"], 0.005);
  EXPECT_EQ(row.numbers["wall_s"], 20);
  EXPECT_EQ(row.numbers["cpu_s"], 4);
  EXPECT_EQ(row.numbers["cpu_ms_per_frame"], 50);  // of 80 processed frames
  EXPECT_EQ(row.numbers["peak_rss_bytes"], 1e6);
  EXPECT_EQ(std::tuple(row.total, row.tracked, row.lost), std::tuple(100U, 70U, 10U));
  EXPECT_EQ(std::tuple(row.first_frame, row.repetition), std::tuple(20U, 3U));
}

TEST(RecordScan, OnlyEditedOptionsAreKeptByKey) {
  const RunRow row = scan_record(to_json(sample_record("desk", "dm", 0.0123)));
  EXPECT_EQ(row.options, (RunOptions{{"depth.max_m", "2.5"}, {"iekf.max_iterations", "8"}}));
}

TEST(RecordScan, NumbersThatDoNotExistAreAbsent) {
  RunRecord record = sample_record("desk", "full", 0.01);
  record.metrics = {};
  record.timing = {};
  const RunRow row = scan_record(to_json(record));
  ASSERT_TRUE(row.readable) << row.reason;
  for (const registry::RunMetric& metric : registry::run_metrics()) {
    if (metric.kind != registry::MetricKind::count) {
      EXPECT_FALSE(row.numbers[metric].has_value()) << metric.key;
    }
  }
}

TEST(RecordScan, DamagedRecordsSayWhatIsWrong) {
  const std::string good = to_json(sample_record("desk", "dm", 0.0123));
  const RunRow half = scan_record(good.substr(0, good.size() / 2));
  EXPECT_FALSE(half.readable);
  EXPECT_EQ(half.status, RunStatus::failed);
  EXPECT_EQ(half.recording, "desk");
  EXPECT_FALSE(half.numbers["ate_rmse_m"].has_value());
  EXPECT_EQ(half.reason,
            fmt::format("record.json is damaged: not JSON at byte {}, where it ends; run it again",
                        good.size() / 2));
  auto document = nlohmann::json::parse(good);
  document["schema"] = 99;
  EXPECT_EQ(scan_record(document.dump()).reason,
            "record.json: schema has a value that this program does not read");
  document = nlohmann::json::parse(good);
  document["frames"]["total"] = "many";
  EXPECT_NE(scan_record(document.dump()).reason.find("frames.total"), std::string::npos);
  document = nlohmann::json::parse(good);
  document.erase("config");
  EXPECT_EQ(scan_record(document.dump()).reason, "record.json is damaged: config is missing; run it again");
  document = nlohmann::json::parse(good);
  document["config"]["depth.max_m"] = 3;
  EXPECT_FALSE(scan_record(document.dump()).readable);
  for (const char* text : {"", "7", "[]", "{}", "[{\"schema\": 1}]", "null", "{\"config\": [[{\"a\": {}}]]}"})
    EXPECT_FALSE(scan_record(text).readable) << text;
}

class RunRowsTest : public testing::InTemporaryFolder {
 protected:
  void write_record(const std::string& run, const RunRecord& record) const {
    write("runs/" + run + "/record.json", to_json(record));
  }
  std::vector<RunRow> rows(int threads = 2) const {
    const auto read = read_run_rows(folder_ / "runs", Workers(threads));
    EXPECT_TRUE(read.has_value()) << read.error().message;
    return read.value_or(std::vector<RunRow>());
  }
};

TEST_F(RunRowsTest, AnyNumberOfThreadsReadsTheSame) {
  for (int i = 0; i < 200; ++i) {
    RunRecord record =
        sample_record(fmt::format("rec{}", i % 3), i % 2 == 0 ? "full" : "dm", 0.01 * (1 + i % 7));
    record.config[0].value = std::int64_t{i % 11};
    write_record(fmt::format("{}/{}", i % 4, i), record);
  }
  const std::string expected = long_table(rows(1), {});
  EXPECT_EQ(rows(1).size(), 200U);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(long_table(rows(threads), {}), expected);
  const auto sorted = rows();
  EXPECT_EQ(sorted.front().recording, "rec0");
  EXPECT_EQ(sorted.front().variant, "full");
  EXPECT_EQ(sorted.front().options[1].second, "0");
  // 10 comes after 9 although its text does not.
  std::string last;
  for (const RunRow& row : sorted) {
    if (row.recording == "rec0" && row.variant == "full") last = row.options[1].second;
  }
  EXPECT_EQ(last, "10");
}

TEST_F(RunRowsTest, PointsOfASweepAreByValue) {
  for (const double voxel_m : {0.02, 0.01, 0.015}) {
    RunRecord record = sample_record("desk", "full", 0.02);
    record.config[1].value = voxel_m;
    write_record(fmt::format("desk/full/{}", static_cast<int>(1000 * voxel_m)), record);
  }
  const auto found = find_runs(folder_ / "runs");
  ASSERT_TRUE(found.has_value());
  std::vector<std::string> order;
  for (const FoundRun& run : *found) order.push_back(run.folder.filename().string());
  EXPECT_EQ(order, (std::vector<std::string>{"10", "15", "20"}));
  record::RunRecord unrelated = sample_record("desk", "full", 0.02);
  unrelated.config[1].value = 0.1;
  write_record("desk/full/0", unrelated);
  EXPECT_EQ(find_runs(folder_ / "runs")->back().folder.filename(), "0");
}

TEST_F(RunRowsTest, HasTheNumbersThatFindRunsHas) {
  write_record("desk/dm/01234567", sample_record("desk", "dm", 0.0123));
  write_record("desk/full/89abcdef", sample_record("desk", "full", 0.02));
  const auto found = find_runs(folder_ / "runs");
  ASSERT_TRUE(found.has_value());
  const auto read = rows();
  ASSERT_EQ(read.size(), found->size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].variant, (*found)[i].record.variant);
    EXPECT_EQ(read[i].run, (*found)[i].folder.filename().string());
    EXPECT_EQ(read[i].numbers["ate_rmse_m"], (*found)[i].record.metrics.ate.value->stats.rmse);
  }
  EXPECT_EQ(read[0].folder, "desk/full/89abcdef");
}

TEST_F(RunRowsTest, RowsHaveTheLabelsOfTheTable) {
  RunRecord record = sample_record("desk", "full", 0.02);
  write_record("desk/full/0", record);
  record.recording.frames = 50;
  record.recording.imu = "synthetic IMU";
  write_record("desk/full/1", record);
  record.status = RunStatus::failed;
  record.recording = {};
  record.recording.name = "desk";
  write_record("desk/full/2", record);
  const auto read = rows();
  ASSERT_EQ(read.size(), 3U);
  EXPECT_EQ(read[0].label, "full frames 20:120 recorded IMU");
  EXPECT_EQ(read[1].label, "full frames 20:70 synthetic IMU");
  EXPECT_EQ(read[1].recorded_part(), "desk frames 20:70");
  EXPECT_EQ(read[2].imu, "");  // it could have had either
  const auto found = find_runs(folder_ / "runs");
  const auto labels = RunSet(*found).labels();
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(read[i].label, labels[i]);
}

TEST_F(RunRowsTest, ADamagedRecordIsARow) {
  write_record("desk/dm/01234567", sample_record("desk", "dm", 0.0123));
  write("runs/desk/full/89abcdef/record.json", "half");
  const auto read = rows();
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(unreadable_count(read), 1U);
  EXPECT_FALSE(read[0].readable);
  EXPECT_EQ(read[0].folder, "desk/full/89abcdef");
  EXPECT_FALSE(read[0].attributable());
}

TEST_F(RunRowsTest, ARecordThatCannotBeReadSaysNothing) {
  write_record("desk/dm/01234567", sample_record("desk", "dm", 0.0123));
  write("runs/desk/dm/89abcdef/record.json", "");
  std::filesystem::resize_file(folder_ / "runs/desk/dm/89abcdef/record.json", kMostRecordBytes + 1);
  const auto read = rows();
  ASSERT_EQ(read.size(), 2U);
  const RunRow& lost = *std::ranges::find(read, "89abcdef", &RunRow::run);
  const RunRow& whole = *std::ranges::find(read, "01234567", &RunRow::run);
  EXPECT_EQ(std::tie(lost.readable, lost.reason), std::tuple(false, "record.json: cannot be read"));
  EXPECT_EQ(std::tie(lost.data, lost.truth), std::tuple(kUnknownWord, kUnknownWord));
  EXPECT_EQ(lost.imu, "recorded");                                       // as the other run of the method
  EXPECT_EQ(whole.label.find("IMU"), std::string::npos) << whole.label;  // no run has another one
}

TEST_F(RunRowsTest, ARunThatNeverStartedHasTheOptionsOfItsConfiguration) {
  write_record("desk/full/01234567", sample_record("desk", "full", 0.0123));
  RunRecord failed;
  failed.reason = "no such folder";
  failed.recording.name = "room";
  failed.variant = "full";
  failed.config_hash = "0011223344556677";
  write_record("room/full/not-started", failed);
  failed.config_hash = "ffffffffffffffff";
  write_record("room/full/not-started-2", failed);
  const auto read = rows();
  ASSERT_EQ(read.size(), 3U);
  const auto by_run = [&](const std::string& run) { return *std::ranges::find(read, run, &RunRow::run); };
  EXPECT_EQ(by_run("not-started").options, read[0].options);
  EXPECT_TRUE(by_run("not-started").options_known);
  EXPECT_TRUE(by_run("not-started-2").options.empty());
  EXPECT_FALSE(by_run("not-started-2").options_known);
}

TEST_F(RunRowsTest, UnfinishedRunsAreNotRead) {
  write_record("desk/full/01234567", sample_record("desk", "full", 0.0123));
  write("runs/desk/full/.89abcdef.99.tmp/new/record.json", "half");
  EXPECT_EQ(rows().size(), 1U);
}

TEST_F(RunRowsTest, ErrorsAreTyped) {
  const Workers workers(1);
  EXPECT_EQ(read_run_rows(folder_ / "absent", workers).error().code, ErrorCode::data_missing);
  EXPECT_EQ(read_run_rows(folder_, workers).error().code, ErrorCode::data_missing);
}

}  // namespace
}  // namespace fusebench
