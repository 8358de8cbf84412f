#include "eval/compare/reproduction/table1.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "tests/support/expect_text.hpp"

namespace fusebench {

using namespace reproduction;

namespace {

MethodNumbers method(double grey, double lost_share = 0) {
  MethodNumbers numbers;
  numbers.grey.emplace();
  numbers.grey->grey.fill(grey);
  numbers.lost_share = lost_share;
  return numbers;
}

RecordingNumbers recording(const std::string& group, double dm_grey, double ours_grey, double dm_lost = 0) {
  return {0, group, "r", "simulated", method(dm_grey, dm_lost), method(ours_grey)};
}

Table1 table_of(std::vector<RecordingNumbers> numbers) {
  Table1 table;
  table.protocol.readings.resize(1);
  table.protocol.readings.front().name = "only";
  table.columns = {{{"calm", "A", "simulated"}, "slow", 1.2, 1.0},
                   {{"wild", "B", "simulated"}, "fast", 2.0, 1.0}};
  table.readings = {0};
  table.numbers = std::move(numbers);
  return table;
}

TEST(Table1, RatiosAreGeometricMeansWithStudentsInterval) {
  const std::vector<RecordingNumbers> numbers = {recording("calm", 2, 1), recording("calm", 8, 1),
                                                 recording("wild", 3, 1)};
  const Ratio ratio = ratio_of(numbers, 0, "calm");
  EXPECT_EQ(ratio.recordings, 2U);
  EXPECT_NEAR(ratio.ratio, 4.0, 1e-12);
  EXPECT_NEAR(ratio.dm_grey, 5.0, 1e-12);
  // Logarithms ln 2 and ln 8: standard error ln 2, times t(0.975, 1) = 12.706.
  ASSERT_TRUE(ratio.interval.has_value());
  EXPECT_NEAR(std::log((*ratio.interval)[1] / 4.0), 12.706 * std::log(2.0), 1e-9);
  EXPECT_FALSE(ratio_of(numbers, 0, "wild").interval.has_value()) << "one recording has no spread";
  EXPECT_EQ(ratio_of(numbers, 1, "calm").recordings, 0U);
}

TEST(Table1, AFailedRunIsCountedAndInNoMean) {
  RecordingNumbers failed = recording("calm", 5, 1);
  failed.dm.grey.reset();
  const Ratio ratio = ratio_of({recording("calm", 2, 1), failed}, 0, "calm");
  EXPECT_EQ(ratio.recordings, 1U);
  EXPECT_EQ(ratio.failed, 1U);
  EXPECT_NEAR(ratio.ratio, 2.0, 1e-12);
}

TEST(Table1, AFailedRunIsARowWithItsReason) {
  RecordingNumbers failed = recording("calm", 5, 1);
  failed.dm.grey.reset();
  failed.dm.failure = "killed after 60 s";
  const Table1 table = table_of({recording("wild", 2, 1), failed});
  testing::expect_contains(render_table1(table, "markdown"), "DM     | killed after 60 s |");
  testing::expect_contains(render_table1(table, "json"), "\"reason\": \"killed after 60 s\"");
  testing::expect_contains(page::to_html(table1_page(table)), "killed after 60 s");
  const Table1 whole = table_of({recording("wild", 2, 1)});
  EXPECT_EQ(render_table1(whole, "markdown").find("Runs without a number"), std::string::npos);
}

TEST(Table1, ThePapersPatternIsEqualWhenSlowAndTwiceWhenFast) {
  EXPECT_TRUE(table_of({recording("calm", 1.2, 1), recording("wild", 2, 1)}).pattern_of(0).is_papers());
  EXPECT_FALSE(table_of({recording("calm", 1.1, 1), recording("wild", 1.2, 1)}).pattern_of(0).is_papers());
  EXPECT_FALSE(table_of({recording("calm", 1.9, 1), recording("wild", 2, 1)}).pattern_of(0).is_papers());
  const Table1 lost = table_of({recording("calm", 1.2, 1), recording("wild", 2, 1, 0.3)});
  EXPECT_FALSE(lost.pattern_of(0).is_papers()) << "a method that lost a third of its frames";
  testing::expect_contains(render_table1(lost, "markdown"), "frames lost");
  testing::expect_contains(render_table1(lost, "markdown"), "(30 % lost)");
  testing::expect_contains(render_table1(lost, "markdown"), "| calm (simulated) | wild (simulated) |");
  const page::Page page = table1_page(lost);
  EXPECT_EQ(page.sections.front().title, "Ratios");
  testing::expect_contains(page::to_html(page), "frames lost");
  const Pattern published = lost.published_pattern();
  EXPECT_NEAR(published.slow, 1.2, 1e-12);
  EXPECT_NEAR(published.fast, 2.0, 1e-12);
}

TEST(Table1, TheProtocolOfTheBinaryIsWhole) {
  const auto protocol = table1_protocol();
  ASSERT_TRUE(protocol.has_value()) << protocol.error().message;
  const auto suite = table1_suite();
  ASSERT_TRUE(suite.has_value()) << suite.error().message;
  std::set<std::string> groups;
  for (const Column& column : protocol->columns) groups.insert(column.group);
  for (const auto& recording : suite->recordings)
    EXPECT_TRUE(groups.contains(recording.group)) << recording.name;
  for (const auto& simulation : suite->simulations)
    EXPECT_TRUE(groups.contains(simulation.group)) << simulation.name;
  // Two priors, three numbers of levels, with and without geometry.
  EXPECT_EQ(std::ranges::count_if(protocol->readings, &Reading::factorial), 12);
}

TEST(Table1, WithoutDataEveryRowOfThePaperHasASpeedAndEachRunIsPlannedOnce) {
  const auto protocol = table1_protocol();
  const auto suite = table1_suite();
  ASSERT_TRUE(protocol && suite);
  engine::BatchOptions options;
  options.data = "no such folder";
  options.out = "out";
  const auto plan = plan_table1(*protocol, *suite, options, {.readings = {"default", "patchwise"}});
  ASSERT_TRUE(plan.has_value()) << plan.error().message;
  // Two readings of two methods each, of which `full` is the same.
  const std::size_t recordings = plan->compared.size() / 2;
  EXPECT_EQ(recordings, 12U);
  EXPECT_EQ(plan->jobs.size(), 3 * recordings);
  for (const ComparedRuns& runs : plan->compared) {
    EXPECT_EQ(plan->jobs[runs.ours].variant, "full");
    EXPECT_EQ(plan->jobs[runs.dm].recording, plan->jobs[runs.ours].recording);
    EXPECT_EQ(plan->jobs[runs.dm].recording.filename().string(), runs.recording);
  }
  EXPECT_FALSE(plan->absent.empty());
  // The factorial takes one recording of each of the four columns, or all of them.
  const std::string cell = protocol->readings.back().name;
  EXPECT_EQ(plan_table1(*protocol, *suite, options, {.readings = {cell}})->compared.size(), 4U);
  const auto everywhere = plan_table1(*protocol, *suite, options, {{cell}, true});
  EXPECT_EQ(everywhere->compared.size(), recordings);
  // Runs that differ have names that differ.
  const auto whole = plan_table1(*protocol, *suite, options, {});
  ASSERT_TRUE(whole.has_value());
  std::set<std::string> names;
  for (const engine::BatchJob& job : whole->jobs)
    EXPECT_TRUE(names.insert(to_string(job)).second) << to_string(job);
  options.only = {"recording=kt2"};
  const Error without_data = plan_table1(*protocol, *suite, options, {}).error();
  EXPECT_EQ(without_data.code, ErrorCode::data_missing);
  EXPECT_NE(without_data.message.find("none of its recordings that --only keeps is under 'no such folder'"),
            std::string::npos);
  testing::expect_contains(without_data.hint, "icl_lr_kt2: put it under --data");
  options.only = {"recording=kt2_path_31", "recording=icl_slow_31"};
  EXPECT_EQ(plan_table1(*protocol, *suite, options, {.readings = {"default"}})->compared.size(), 1U);
  options.only.clear();
  const auto unknown = plan_table1(*protocol, *suite, options, {.readings = {"stric"}});
  ASSERT_FALSE(unknown.has_value());
  testing::expect_contains(unknown.error().message, "no reading 'stric' (nearest: strict)");
}

TEST(Table1, ProtocolsRefuseWhatTheyDoNotKnow) {
  const auto refused = [](const std::string& text) {
    const auto protocol = parse_table1_protocol(text, "f.toml");
    return protocol ? std::string("accepted") : protocol.error().message;
  };
  testing::expect_contains(refused("[[readings]]\nname = \"a\"\nsentence = \"b\"\ndm = \"dmm\"\n"),
                           "f.toml: reading 'a': unknown variant 'dmm'");
  testing::expect_contains(refused("[[readings]]\nnmae = \"a\"\n"), "f.toml:2");
  testing::expect_contains(refused("[[columns]]\ngroup = \"a\"\n"), "a column needs group, row and is");
  testing::expect_contains(refused("name = \"a\"\n"), "f.toml:1");
}

}  // namespace
}  // namespace fusebench
