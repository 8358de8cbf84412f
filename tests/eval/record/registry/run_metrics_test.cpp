#include "eval/record/registry/run_metric.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "eval/compare/aggregate/record_scan.hpp"
#include "eval/record/record.hpp"
#include "eval/record/registry/run_numbers.hpp"
#include "tests/eval/record/sample_record.hpp"
#include "tests/support/repository.hpp"

namespace fusebench::registry {
namespace {

using nlohmann::json;

json::json_pointer pointer_of(std::string_view path) {
  std::string pointer = "/" + std::string(path);
  std::ranges::replace(pointer, '.', '/');
  return json::json_pointer(pointer);
}

/// A record in which every number that a metric names is another one.
json numbered_record() {
  json document = json::parse(to_json(testing::complete_record()));
  document["recording"].erase("camera");  // it has no size
  int number = 3;
  for (const RunMetric& metric : run_metrics()) {
    if (metric.path.empty()) continue;
    json& value = document[pointer_of(metric.path)];
    number += 2;
    value = metric.kind == MetricKind::estimate ? json(number + 0.125) : json(number);
  }
  document["frames"] = {{"total", 300},         {"tracked", 200}, {"lost", 50},
                        {"other_segments", 30}, {"segments", 3},  {"segments_joined", 2}};
  document[pointer_of(run_metric("coverage").path)] = 200.0 / 300.0;
  return document;
}

/// Numbers of a record that no metric names, since they say how another number was computed, or describe the
/// same errors by another statistic.
const std::vector<std::regex>& details() {
  static const std::vector<std::regex> kDetails = {
      std::regex(R"(.*\.stats\.(rmse|mean|median|std|min|max|sse|count))"),
      std::regex(R"(.*\.alignment\..*)"),
      std::regex(
          R"(.*\.(ate|ate_fitted_offset|frame|second)\.(pairs|possible|coverage|max_difference_s|delta))"),
      std::regex(R"(.*\.ate_fitted_offset\.(offset_m|offset_sigma_m)\..*)"),
      std::regex(R"(.*\.aie\.(accepted\.)?(aie|rms|pixels|frames|frames_excluded))"),
      std::regex(R"(.*\.intensity_readings\.readings\..*)"),
      std::regex(R"(.*\.residuals\.(frames|patches_.*))"),
      std::regex(R"(.*\.nees\.[a-z_]+\.(dof|frames|possible|median|std|min|max|final|final_bounds_95\..*))"),
      std::regex(R"(.*\.mesh\.(samples|observed|first_camera|positions|thresholds)\..*)"),
      std::regex(R"(.*\.mesh\.(accuracy|completeness)\.(rmse|median|std|min|max|sse|count|p90|p95))"),
      std::regex(R"(.*\.silent_failures\.(interval_s|max_.*|first_.*|worst_.*))"),
      std::regex(R"(.*\.pose_intensity\.(rms_grey|frames|pixels))"),
      std::regex(R"(.*\.reference_clock\.(motions|(as_read|fitted)\..*))"),
      std::regex(R"(.*\.coverage\.(tracked|total))"),
      std::regex(R"(final_metrics\..*)"),  // of the poses at the end: metrics name the errors of trajectories
      std::regex(R"(loops\.error\.(protocol|revisits)\..*)"),
      std::regex(R"(loops\.error\.(places|verified|false_verified|median_.*|nees_.*|oracle_ate_m))"),
      std::regex(R"(model\.(triangles|blocks))"),
      std::regex(R"(timing\.(stages_ms|histogram_ms|files)\..*)")};
  return kDetails;
}

void collect_numbers(const json& value, const std::string& path, std::vector<std::string>& paths) {
  if (value.is_number()) paths.push_back(path);
  if (!value.is_structured()) return;
  for (const auto& [key, part] : value.items())
    collect_numbers(part, path.empty() ? key : path + "." + key, paths);
}

TEST(RunMetrics, HaveKeysAndWordsOfTheirOwnAndADefinition) {
  std::set<std::string_view> names;
  for (const RunMetric& metric : run_metrics()) {
    EXPECT_TRUE(names.insert(metric.key).second) << metric.key;
    if (!metric.word.empty()) {
      EXPECT_TRUE(names.insert(metric.word).second) << metric.word;
    }
    EXPECT_FALSE(metric.definition.empty() || metric.heading.empty() || metric.unit.empty()) << metric.key;
    EXPECT_FALSE(metric.definition.ends_with('.')) << metric.key;
    EXPECT_EQ(&run_metric(metric.key), &metric);
  }
}

TEST(RunMetrics, ReadTheSameNumbersFromARecordAndFromItsText) {
  const json document = numbered_record();
  const auto record = record::parse_record(document.dump(), "record");
  ASSERT_TRUE(record.has_value()) << record.error().message;
  const RunNumbers numbers = numbers_of(*record);
  const aggregate::RunRow row = aggregate::scan_record(document.dump());
  ASSERT_TRUE(row.readable) << row.reason;
  for (const RunMetric& metric : run_metrics()) {
    EXPECT_EQ(numbers[metric], row.numbers[metric]) << metric.key;
    EXPECT_EQ(numbers[metric].has_value(), !metric.takes_several_runs()) << metric.key;
    if (metric.path.empty()) continue;
    EXPECT_EQ(numbers[metric], document.at(pointer_of(metric.path)).get<double>()) << metric.key;
  }
}

TEST(RunMetrics, NameEveryNumberOfARecordThatIsNoDetail) {
  std::vector<std::string> paths;
  const json document = json::parse(to_json(testing::complete_record()));
  for (const char* const part : {"metrics", "final_metrics", "loops", "frames", "model", "timing"})
    collect_numbers(document.at(part), part, paths);
  EXPECT_GT(paths.size(), 200U);
  for (const std::string& path : paths) {
    const bool named = std::ranges::find(run_metrics(), path, &RunMetric::path) != run_metrics().end();
    const bool detail = std::ranges::any_of(
        details(), [&](const std::regex& pattern) { return std::regex_match(path, pattern); });
    EXPECT_TRUE(named || detail) << path << ": add it to run_metrics(), or to the details of this test";
  }
}

TEST(RunMetrics, OfFinalPosesAreThoseOfARunThatDidNotReviseThem) {
  record::RunRecord record = testing::complete_record();
  record.final_metrics->ate.value->stats.rmse = 0.5;
  EXPECT_EQ(numbers_of(record)["ate_final_m"], 0.5);
  record.final_metrics.reset();
  EXPECT_EQ(numbers_of(record)["ate_final_m"], record.metrics.ate.value->stats.rmse);
  EXPECT_FALSE(numbers_of(record)["ate_revised_m"].has_value());
}

TEST(RunMetrics, TimeOfAFrameIsOfThoseThatWereProcessed) {
  record::RunRecord record = testing::complete_record();
  record.frames = {1000, 60, 20};
  record.timing.cpu_s = 4;
  EXPECT_DOUBLE_EQ(*numbers_of(record)["cpu_ms_per_frame"], 50);
  record.timing.cpu_s = 0;  // it was not timed
  EXPECT_FALSE(numbers_of(record)["cpu_ms_per_frame"].has_value());
}

TEST(RunMetrics, ARunThatDidNotBeginHasNoFramesAndNoCoverage) {
  const RunNumbers numbers = numbers_of(record::RunRecord{});
  const aggregate::RunRow row = aggregate::scan_record(to_json(record::RunRecord{}));
  for (const RunMetric& metric : run_metrics()) EXPECT_EQ(numbers[metric], row.numbers[metric]) << metric.key;
  EXPECT_FALSE(numbers["frames_lost"].has_value());
  for (const RunMetric& metric : run_metrics()) {
    if (metric.kind != MetricKind::count) {
      EXPECT_FALSE(numbers[metric].has_value()) << metric.key;
    }
  }
  EXPECT_EQ(numbers["coverage"], 0);
  EXPECT_EQ(numbers["runs_not_ok"], 1);
}

TEST(RunMetrics, RankingTakesWordsAndKeysOfWhatIsBetterWhenSmaller) {
  EXPECT_EQ((*find_ranking_metric("ate"))->key, "ate_rmse_m");
  EXPECT_EQ((*find_ranking_metric("ate_fitted_m"))->word, "ate-fitted");
  EXPECT_EQ(find_ranking_metric("fps").error().code, ErrorCode::usage);        // more is better
  EXPECT_EQ(find_ranking_metric("nees_pose").error().code, ErrorCode::usage);  // 1 is best
  EXPECT_TRUE(find_ranking_metric("atee").error().message.ends_with("(nearest: ate)"));
}

TEST(RunMetrics, ArePropertiesOfTheSchemaOfRecords) {
  std::ifstream file(testing::repository_root() / "docs" / "record.schema.json");
  const std::string schema = json::parse(file).dump();
  for (const RunMetric& metric : run_metrics()) {
    if (metric.path.empty()) continue;
    const std::string_view name = metric.path.substr(metric.path.rfind('.') + 1);
    EXPECT_NE(schema.find("\"" + std::string(name) + "\":"), std::string::npos) << metric.path;
  }
}

}  // namespace
}  // namespace fusebench::registry
