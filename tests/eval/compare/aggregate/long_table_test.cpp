#include "eval/compare/aggregate/long_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/eval/compare/aggregate/sample_rows.hpp"

namespace fusebench {

using namespace record;
using namespace aggregate;

namespace {

using testing::sample_bad_row;
using testing::sample_row;

std::vector<RunRow> two_runs() {
  std::vector<RunRow> rows = {sample_row("desk", {{"a.b", "1"}}, 0.0123, 7.5),
                              sample_bad_row("desk", {{"c", "x, \"y\""}}, RunStatus::failed)};
  rows[0].run = "01234567";
  rows[0].first_frame = 100;
  rows[0].frames = 50;
  rows[0].repetition = 2;
  rows[0].label = "full frames 100:150";
  rows[1].run = "not-started";
  rows[1].reason = "no, \"never\"";
  rows[1].total = 0;
  return rows;
}

TEST(LongTable, CsvHasALineForEachNumberAndOneForARunWithout) {
  EXPECT_EQ(
      long_table(two_runs(), {}),
      "recording,data,imu,truth,variant,run,status,reason,label,first_frame,last_frame,repetition,replicate,"
      "a.b,c,"
      "metric,unit,value\n"
      "desk,recorded,none,given,full,01234567,ok,,full frames 100:150,100,149,2,0,1,,ate_rmse_m,m,0.0123\n"
      "desk,recorded,none,given,full,01234567,ok,,full frames "
      "100:150,100,149,2,0,1,,cpu_ms_per_frame,ms,7.5\n"
      "desk,recorded,none,given,full,not-started,failed,\"no, \"\"never\"\"\",,0,,1,0,,\"x, "
      "\"\"y\"\"\",,,\n");
}

TEST(LongTable, WithoutTimingOnlyTheInputsCount) {
  auto rows = two_runs();
  const std::string before = long_table(rows, {LongFormat::csv, true});
  EXPECT_EQ(before.find("cpu_ms_per_frame"), std::string::npos);
  rows[0].numbers.set(registry::run_metric("cpu_ms_per_frame"), 8);
  rows[0].numbers.set(registry::run_metric("fps"), 100);
  EXPECT_EQ(long_table(rows, {LongFormat::csv, true}), before);
}

TEST(LongTable, JsonLinesAreDocumentsWithTheSameNumbers) {
  auto rows = two_runs();
  rows[0].recording = "de\xffsk";  // no UTF-8
  std::istringstream lines(long_table(rows, {LongFormat::json_lines, false}));
  std::vector<nlohmann::json> documents;
  for (std::string line; std::getline(lines, line);) documents.push_back(nlohmann::json::parse(line));
  ASSERT_EQ(documents.size(), 3U);
  EXPECT_EQ(documents[0].at("metric"), "ate_rmse_m");
  EXPECT_EQ(documents[0].at("value"), 0.0123);
  EXPECT_EQ(documents[0].at("a.b"), "1");
  EXPECT_EQ(documents[0].at("first_frame"), 100);
  EXPECT_EQ(documents[0].at("last_frame"), 149);
  EXPECT_EQ(documents[0].at("label"), "full frames 100:150");
  EXPECT_TRUE(documents[2].at("last_frame").is_null());
  EXPECT_TRUE(documents[0].at("c").is_null());
  EXPECT_TRUE(documents[2].at("metric").is_null());
  EXPECT_EQ(documents[2].at("reason"), "no, \"never\"");
}

TEST(LongTable, ErrorsAreTyped) { EXPECT_EQ(parse_long_format("xml").error().code, ErrorCode::usage); }

}  // namespace
}  // namespace fusebench
