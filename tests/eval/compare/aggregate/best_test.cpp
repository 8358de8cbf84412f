#include "eval/compare/aggregate/best.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/eval/compare/aggregate/sample_rows.hpp"

namespace fusebench {

using namespace record;
using namespace aggregate;

namespace {

using testing::metric_of;
using testing::sample_bad_row;
using testing::sample_row;
using testing::shuffled;

/// Levels 1, 2, 3 on two recordings: 2 is the best; 3 would be, had it not lost one.
std::vector<RunRow> three_levels() {
  return {sample_row("desk", {{"levels", "1"}}, 0.02),
          sample_row("room", {{"levels", "1"}}, 0.06),
          sample_row("desk", {{"levels", "2"}}, 0.01),
          sample_row("room", {{"levels", "2"}}, 0.05),
          sample_row("desk", {{"levels", "3"}}, 0.005),
          sample_bad_row("room", {{"levels", "3"}}, RunStatus::lost)};
}

BestTable best(const std::vector<RunRow>& rows, const std::string& group, std::size_t most = 10) {
  return best_configurations(rows, {&metric_of("ate"), group, most}).value();
}

TEST(Best, RanksByTheMeanOverRecordingsAndPutsIncompleteOnesLast) {
  const BestTable table = best(three_levels(), "none");
  ASSERT_EQ(table.groups.size(), 1U);
  const auto& rows = table.groups[0].rows;
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0].configuration.options, (RunOptions{{"levels", "2"}}));
  EXPECT_NEAR(*rows[0].configuration.mean, 0.03, 1e-15);
  EXPECT_TRUE(rows[0].configuration.complete());
  EXPECT_EQ(rows[1].configuration.options, (RunOptions{{"levels", "1"}}));
  EXPECT_EQ(rows[2].configuration.options, (RunOptions{{"levels", "3"}}));
  EXPECT_EQ(rows[2].rank, 3U);
  EXPECT_EQ(rows[2].configuration.n_ok, 1U);
  EXPECT_EQ(rows[2].configuration.n_total, 2U);
  EXPECT_EQ(incomplete_note(rows[2].configuration), "failed or lost: room");
}

TEST(Best, TheHeadlineHasTheMeanOfTheTable) {
  const BestTable table = best(three_levels(), BestRequest().group);
  const BestGroup& group = table.groups.at(0);
  EXPECT_EQ(group.label, "all") << "by default over all recordings";
  // desk: 2 times that of level 3, which has the smallest; room: its own is the smallest.
  EXPECT_NEAR(*group.rows[0].configuration.ratio.ratio, std::sqrt(2.0), 1e-12);
  EXPECT_TRUE(
      group.headline.starts_with("all (recorded, 2 recordings): full levels=2 is best by ate_rmse_m: 1.41 "
                                 "times the best of each recording (95 % "))
      << group.headline;
  EXPECT_EQ(group.headline.find("Tied"), std::string::npos) << group.headline;
  const std::string markdown = render_best(table, BestFormat::markdown);
  EXPECT_TRUE(markdown.starts_with(group.headline)) << markdown;
  EXPECT_NE(markdown.find(" 1.41 | "), std::string::npos) << markdown;
}

TEST(Best, ConfigurationsThatChanceMayHaveSwappedAreNamedAsTied) {
  std::vector<RunRow> rows;
  const double ratios[] = {1.1, 0.9, 1.05, 0.97};
  for (int i = 0; i < 4; ++i) {
    const std::string name(1, static_cast<char>('a' + i));
    rows.push_back(sample_row(name, {{"levels", "1"}}, 0.01));
    rows.push_back(sample_row(name, {{"levels", "2"}}, 0.01 * ratios[i]));
    rows.push_back(sample_row(name, {{"levels", "3"}}, 0.02));
  }
  const BestGroup group = best(rows, "none").groups.at(0);
  EXPECT_EQ(group.rows[0].rank, 1U);
  EXPECT_EQ(group.rows[1].rank, 1U);
  EXPECT_EQ(group.rows[2].rank, 3U);
  EXPECT_NE(group.headline.find("Tied with it: full levels="), std::string::npos) << group.headline;
  EXPECT_EQ(group.headline.find("levels=3"), std::string::npos) << group.headline;
}

TEST(Best, ACountOfZeroHasNoRatioAndIsRankedByTheMean) {
  std::vector<RunRow> rows = three_levels();
  rows[2].numbers.set(registry::run_metric("ate_rmse_m"), 0.0);
  const BestGroup group = best(rows, "none").groups.at(0);
  EXPECT_EQ(group.rows[0].configuration.options[0].second, "2");
  EXPECT_FALSE(group.rows[0].configuration.ratio.ratio);
  EXPECT_NE(group.headline.find("no ratios"), std::string::npos) << group.headline;
}

TEST(Best, GroupsByRecordingVariantAndOption) {
  const BestTable by_recording = best(three_levels(), "recording");
  ASSERT_EQ(by_recording.groups.size(), 2U);
  EXPECT_EQ(by_recording.groups[0].label, "desk");
  EXPECT_EQ(by_recording.groups[0].rows[0].configuration.options[0].second, "3");
  EXPECT_FALSE(by_recording.groups[1].rows[2].rank.has_value());  // lost, without any number
  EXPECT_EQ(best(three_levels(), "variant").groups.at(0).label, "full");
  const BestTable by_level = best(three_levels(), "levels");
  ASSERT_EQ(by_level.groups.size(), 3U);
  EXPECT_EQ(by_level.groups[1].label, "2");
}

TEST(Best, AConfigurationThatDidNotRunSomewhereSaysSo) {
  auto rows = three_levels();
  rows.push_back(sample_row("desk", {{"levels", "4"}}, 0.001));
  const BestTable table = best(rows, "none");
  EXPECT_EQ(incomplete_note(table.groups[0].rows[2].configuration), "not run: room");
  EXPECT_EQ(table.groups[0].rows[2].configuration.options[0].second, "4");
}

TEST(Best, EqualMeansShareARank) {
  const BestTable table =
      best({sample_row("desk", {{"levels", "1"}}, 0.02), sample_row("desk", {{"levels", "2"}}, 0.02),
            sample_row("desk", {{"levels", "3"}}, 0.03)},
           "none");
  EXPECT_EQ(table.groups[0].rows[0].rank, 1U);
  EXPECT_EQ(table.groups[0].rows[1].rank, 1U);
  EXPECT_EQ(table.groups[0].rows[2].rank, 3U);
}

TEST(Best, ARecordingWithoutTheNumberIsLeftOutAndNamed) {
  auto rows = three_levels();
  for (const char* level : {"1", "2", "3"}) {
    rows.push_back(sample_row("walk", {{"levels", level}}, 0));
    rows.back().numbers.set(registry::run_metric("ate_rmse_m"), std::nullopt);
  }
  const BestTable table = best(rows, "none");
  EXPECT_EQ(table.groups[0].recordings, (std::vector<std::string>{"desk", "room"}));
  EXPECT_TRUE(table.groups[0].rows[0].configuration.complete());
  EXPECT_EQ(table.notes.at(0), "No run has ate_rmse_m of walk: left out.");
}

TEST(Best, DataOfDifferentKindsAreNotInOneMean) {
  auto rows = three_levels();
  for (RunRow& row : rows) {
    if (row.recording == "room" && row.status == RunStatus::ok) row.data = "simulated";
  }
  const BestTable table = best(rows, "none");
  ASSERT_EQ(table.groups.size(), 2U);
  EXPECT_EQ(table.groups[0].kind, "recorded");
  EXPECT_EQ(table.groups[1].kind, "simulated");
  EXPECT_EQ(table.groups[1].rows.size(), 3U);  // the lost run, which knows no better, too
  EXPECT_NE(render_best(table, BestFormat::markdown).find("simulated: images"), std::string::npos);
}

TEST(Best, AnOrderByIntensityErrorsSaysThatPixelsDiffer) {
  std::vector<RunRow> rows = {sample_row("desk", {{"patches.size_px", "4"}}, 0.01),
                              sample_row("desk", {{"patches.size_px", "8"}}, 0.01)};
  const registry::RunMetric& aie = registry::run_metric("aie_grey");
  rows[0].numbers.set(aie, 5);
  rows[1].numbers.set(aie, 6);
  const auto table = best_configurations(rows, {&aie});
  ASSERT_TRUE(table.has_value());
  EXPECT_NE(table->groups.at(0).headline.find("AIE on common pixels"), std::string::npos);
}

TEST(Best, WindowsAndImusAreNotAveragedButRepetitionsAre) {
  const auto run = [](std::size_t frames, std::size_t repetition, const char* imu, double ate_m) {
    RunRow row = sample_row("desk", {}, ate_m);
    row.frames = frames;
    row.repetition = repetition;
    row.imu = imu;
    return row;
  };
  std::vector<RunRow> rows = {run(5, 1, "none", 0.02), run(5, 2, "none", 0.04),
                              run(5, 1, "synthetic IMU", 0.01), run(4, 1, "none", 0.08)};
  rows.push_back(sample_bad_row("desk", {}, RunStatus::failed));
  rows.back().fingerprint.clear();  // it did not open the recording
  set_labels(rows);
  EXPECT_EQ(rows[1].label, "full repetition 2 no IMU");
  const BestTable table = best(rows, "recording");
  ASSERT_EQ(table.groups.size(), 2U);
  EXPECT_EQ(table.groups[0].label, "desk");
  EXPECT_EQ(table.groups[0].kind, "recorded");
  EXPECT_EQ(table.groups[1].label, "desk frames 0:4");
  EXPECT_EQ(table.groups[1].kind, "recorded, parts of recordings");
  const auto& five = table.groups[0].rows;
  ASSERT_EQ(five.size(), 3U);  // one of the run whose IMU is unknown
  EXPECT_EQ(five[0].configuration.imu, "synthetic IMU");
  EXPECT_EQ(five[1].configuration.imu, "none");
  EXPECT_NEAR(*five[1].configuration.mean, 0.03, 1e-15);
  EXPECT_EQ(five[1].configuration.n_ok, 2U);
  EXPECT_NE(render_best(table, BestFormat::markdown).find("each window is a recording"), std::string::npos);
  EXPECT_EQ(best(rows, "none").groups.at(0).kind, "recorded, IMUs synthetic");
}

TEST(Best, RunsOfUnknownConfigurationAreCountedNotRanked) {
  auto rows = three_levels();
  rows.push_back(sample_bad_row("desk", {}, RunStatus::failed));
  rows.back().readable = false;
  rows.push_back(sample_bad_row("desk", {}, RunStatus::failed));
  rows.back().options_known = false;
  const BestTable table = best(rows, "none");
  EXPECT_EQ(table.groups[0].rows.size(), 3U);
  EXPECT_EQ(table.notes.at(0),
            "1 of 8 records cannot be read and are left out: `fusebench list runs FOLDER` says why.");
  EXPECT_TRUE(table.notes.at(1).starts_with("1 failed runs never wrote their options"));
}

TEST(Best, DoesNotDependOnTheOrderOfRuns) {
  const auto rows = three_levels();
  const std::string expected = render_best(best(rows, "none"), BestFormat::json);
  for (unsigned seed = 0; seed < 20; ++seed)
    EXPECT_EQ(render_best(best(shuffled(rows, seed), "none"), BestFormat::json), expected);
}

TEST(Best, FormatsCarryTheSameNumbers) {
  const BestTable table = best(three_levels(), "none", 2);
  const std::string csv = render_best(table, BestFormat::csv);
  EXPECT_NE(csv.find("all,recorded,2,full,none,1,ate_rmse_m,m,0.04,0.04,0.04,2,2,2,,2.19"), std::string::npos)
      << csv;
  const auto document = nlohmann::json::parse(render_best(table, BestFormat::json));
  EXPECT_EQ(document.at("groups").at(0).at("rows").at(1).at("mean"), 0.04);
  EXPECT_EQ(document.at("groups").at(0).at("configurations"), 3);
  const std::string markdown = render_best(table, BestFormat::markdown);
  EXPECT_NE(render_best(table, BestFormat::markdown, 50).find("\n\n| "), std::string::npos)
      << "blocks of columns";
  EXPECT_NE(markdown.find("4.00 | 2/2 |"), std::string::npos) << markdown;
  EXPECT_NE(markdown.find("2 of 3 configurations shown"), std::string::npos) << markdown;
}

TEST(Best, ErrorsAreTyped) {
  const auto refused = best_configurations(three_levels(), {&metric_of("ate"), "level", 10});
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::usage);
  EXPECT_NE(refused.error().message.find("none | levels"), std::string::npos) << refused.error().message;
  EXPECT_EQ(parse_best_format("pdf").error().code, ErrorCode::usage);
}

}  // namespace
}  // namespace fusebench
