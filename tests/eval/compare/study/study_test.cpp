#include "eval/compare/study/study.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "core/base/trajectory/trajectory_file.hpp"
#include "eval/compare/study/criteria_check.hpp"
#include "eval/compare/study/study_summary.hpp"
#include "eval/compare/study/summary_formats.hpp"
#include "eval/compare/tables/common_pixels.hpp"
#include "eval/metrics/intensity_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace trajectory;
using namespace metrics;
using namespace trajectory_error;
using namespace record;
using namespace suites;
using namespace tables;
using namespace study;

namespace {

using Pixels = std::vector<IntensityResidual>;

/// Made-up runs; recordings named "t..." are the tuning split.
class StudyTest : public testing::InTemporaryFolder {
 protected:
  StudyRun& add(const std::string& recording, const std::string& group, const std::string& variant,
                double ate_m, RunStatus status = RunStatus::ok) {
    StudyRun run{recording, group, recording.starts_with('t') ? "tuning" : "held-out", variant, {}, {}};
    run.record.status = status;
    run.record.reason = status == RunStatus::ok ? "" : "why";
    run.record.frames = {100, status == RunStatus::ok ? 100U : 40U, status == RunStatus::ok ? 0U : 6U};
    AteResult ate;
    ate.stats = statistics(std::vector<double>{ate_m});
    run.record.metrics.ate = {ate, {}};
    runs_.push_back(run);
    return runs_.back();
  }

  /// Frames of a run: the first has no pixels, as in a run.
  void add_frames(StudyRun& run, const std::vector<Pixels>& frames, const std::vector<double>& motion_px) {
    const std::filesystem::path folder = std::filesystem::path(run.recording) / run.variant;
    std::string csv = "frame,timestamp,reason,patch_motion_px\n0," + stamp_text(1) + ",,\n";
    for (std::size_t i = 0; i < motion_px.size(); ++i) {
      csv += std::to_string(i + 1) + "," + stamp_text(static_cast<std::int64_t>(i) + 2) + ",a; b," +
             std::to_string(motion_px[i]) + "\n";
    }
    write(folder / "frames.csv", csv);
    auto writer = IntensityWriter::create(folder_ / folder / "intensity.bin", 4, 4);
    ASSERT_TRUE(writer && writer->write_frame(1, {}));
    for (std::size_t i = 0; i < frames.size(); ++i) {
      ASSERT_TRUE(writer->write_frame(static_cast<std::int64_t>(i) + 2, frames[i]).has_value());
    }
    ASSERT_TRUE(writer->finish().has_value());
    run.folder = folder_ / folder;
  }

  [[nodiscard]] Study study() { return gather_study(runs_, variants_); }

  [[nodiscard]] CriterionMeasurement check(Criterion criterion) {
    criterion.title = "t";
    if (criterion.split.empty()) criterion.split = "held-out";
    return check_criteria(study(), std::vector<Criterion>{criterion}).front().decided;
  }

  static Criterion ate_criterion(CriterionStatistic statistic, const std::string& variant = "full") {
    Criterion criterion;
    criterion.variant = variant;
    criterion.metric = "ate_rmse_m";
    criterion.statistic = statistic;
    return criterion;
  }

  std::vector<StudyRun> runs_;
  std::vector<std::string> variants_ = {"full", "dm", "no-imu"};
};

TEST_F(StudyTest, WorstAgainstALimit) {
  add("a", "slow", "full", 0.008);
  add("b", "slow", "full", 0.009);
  add("c", "fast", "full", 0.5);
  add("t1", "slow", "full", 0.7);
  Criterion criterion = ate_criterion(CriterionStatistic::worst);
  criterion.groups = {"slow"};
  criterion.at_most = 0.009;
  CriterionMeasurement measured = check(criterion);
  EXPECT_EQ(measured.verdict, Verdict::passed);
  EXPECT_DOUBLE_EQ(*measured.measured, 0.009);
  EXPECT_EQ(measured.recordings, 2U);
  EXPECT_EQ(measured.limit, "<= 0.009");
  EXPECT_EQ(measured.note, "worst: b");
  criterion.at_most.reset();
  criterion.below = 0.009;
  EXPECT_EQ(check(criterion).verdict, Verdict::failed);  // below is strict
  criterion.below.reset();
  criterion.at_least = 0.0085;
  measured = check(criterion);
  EXPECT_DOUBLE_EQ(*measured.measured, 0.008);  // the smallest is the worst over a lower limit
  EXPECT_EQ(measured.verdict, Verdict::failed);
}

TEST_F(StudyTest, APassByLessThanTheNoiseIsATie) {
  for (const double ate_m : {0.001, 0.002, 0.003}) add(std::to_string(ate_m), "slow", "full", ate_m);
  Criterion criterion = ate_criterion(CriterionStatistic::mean);
  criterion.at_most = 0.0030;
  // The standard error of the mean of 1, 2 and 3 mm is 1 mm / sqrt(3).
  CriterionMeasurement measured = check(criterion);
  ASSERT_TRUE(measured.noise.has_value());
  EXPECT_NEAR(*measured.noise, 0.001 / std::sqrt(3.0), 1e-12);
  EXPECT_EQ(measured.verdict, Verdict::passed);
  criterion.at_most = 0.0025;
  measured = check(criterion);
  EXPECT_EQ(measured.verdict, Verdict::tied);
  EXPECT_EQ(to_string(measured.verdict), "TIE");
  criterion.at_most = 0.0019;
  EXPECT_EQ(check(criterion).verdict, Verdict::failed);
  criterion.statistic = CriterionStatistic::worst;
  criterion.at_most = 0.0030;
  measured = check(criterion);
  EXPECT_EQ(measured.verdict, Verdict::passed) << "the worst has no standard error";
  EXPECT_FALSE(measured.noise.has_value());
}

TEST_F(StudyTest, TheOtherSplitStandsBeside) {
  add("a", "slow", "full", 0.01);
  add("t1", "slow", "full", 0.03);
  Criterion criterion = ate_criterion(CriterionStatistic::worst);
  criterion.split = "held-out";
  criterion.at_most = 0.02;
  const CriterionResult result = check_criteria(study(), std::vector<Criterion>{criterion}).front();
  EXPECT_EQ(result.decided.verdict, Verdict::passed);
  EXPECT_EQ(result.beside.split, "tuning");
  EXPECT_EQ(result.beside.verdict, Verdict::failed);
  EXPECT_DOUBLE_EQ(*result.beside.measured, 0.03);
}

TEST_F(StudyTest, TheCellOfASplitWithoutRunsIsBlank) {
  add("a", "slow", "full", 0.01);
  Criterion criterion = ate_criterion(CriterionStatistic::worst);
  criterion.split = "held-out";
  criterion.at_most = 0.02;
  const auto others = [&] {
    return criteria_table(check_criteria(study(), std::vector{criterion})).rows[0][6];
  };
  EXPECT_EQ(others(), "");
  add("t1", "slow", "full", 0.03);
  EXPECT_EQ(others(), "tuning: 0.03 m (FAIL, 1 recording)");
  criterion.groups = {"fast"};
  EXPECT_EQ(criteria_table(check_criteria(study(), std::vector{criterion})).rows[0][0], "not decided");
}

TEST_F(StudyTest, ThePageSaysTheVerdictInItsTitleAndTheUnitsOfItsNumbers) {
  add("a", "slow", "full", 0.01);
  add("b", "slow", "full", 0.03);
  Criterion criterion = ate_criterion(CriterionStatistic::worst);
  criterion.split = "held-out";
  criterion.at_most = 0.02;
  const Study all = study();
  std::string page = summary_page(summarise("demo", all, std::vector{criterion}), all);
  EXPECT_NE(page.find("<h1>Study demo: FAIL, 1 of 1 criteria failed</h1>"), std::string::npos);
  EXPECT_NE(page.find("<td>0.03 m</td><td>&lt;= 0.02 m</td>"), std::string::npos);
  EXPECT_NE(page.find("<td>mean\nmedian\nworst</td>"), std::string::npos);
  criterion.at_most = 0.04;
  page = summary_page(summarise("demo", all, std::vector{criterion}), all);
  EXPECT_NE(page.find("<h1>Study demo: PASS, 1 of 1 criteria passed</h1>"), std::string::npos);
  EXPECT_NE(summary_page(summarise("demo", all, {}), all).find("<h1>Study demo</h1>"), std::string::npos);
}

TEST_F(StudyTest, OverconfidenceAndUnderconfidenceAreToldApart) {
  const auto word_of = [&](double nees) {
    runs_.clear();
    NeesResult result;
    result.stats = statistics(std::vector<double>{nees});
    add("a", "slow", "full", 0.01).record.metrics.nees[0] = {result, {}};
    std::string words;
    for (const SummaryTable& table : value_tables(summarise("demo", study(), {}))) {
      if (!table.title.starts_with("NEES")) continue;
      for (const std::string& cell : table.rows.at(0)) words += cell == "-" ? "" : cell;
    }
    return words;
  };
  EXPECT_TRUE(word_of(1e3).ends_with(") overconfident")) << word_of(1e3);
  EXPECT_TRUE(word_of(1e-3).ends_with(") underconfident")) << word_of(1e-3);
}

TEST_F(StudyTest, ALostRunFailsACriterionAndNoRunDecidesNothing) {
  add("a", "slow", "full", 0.001);
  add("b", "slow", "full", 0.001, RunStatus::lost);
  Criterion criterion = ate_criterion(CriterionStatistic::worst);
  criterion.at_most = 1;
  EXPECT_EQ(check(criterion).verdict, Verdict::failed);
  EXPECT_EQ(check(criterion).note, "not ok: b");
  criterion.metric = "runs_not_ok";
  EXPECT_DOUBLE_EQ(*check(criterion).measured, 1);
  criterion.metric = "ate_rmse_m";
  criterion.groups = {"fast"};
  EXPECT_EQ(check(criterion).verdict, Verdict::not_applicable);
  criterion.groups = {};
  criterion.metric = "nees_pose";  // no run has it, but one was lost
  EXPECT_EQ(check(criterion).verdict, Verdict::failed);
  runs_.pop_back();
  EXPECT_EQ(check(criterion).verdict, Verdict::not_applicable);
}

TEST_F(StudyTest, ARunThatDidNotStartHasNoLostFrames) {
  add("a", "slow", "full", 0.001);
  StudyRun& absent = add("b", "slow", "full", 0.001, RunStatus::failed);
  absent.record.frames = {};
  const registry::RunMetric& value = registry::run_metric("frames_lost");
  EXPECT_FALSE(value_of(study(), runs_[1], value).has_value());
  EXPECT_EQ(value_of(study(), runs_[0], value), 0.0);
  Criterion criterion = ate_criterion(CriterionStatistic::worst);
  criterion.metric = "frames_lost";
  criterion.at_most = 0;
  EXPECT_EQ(check(criterion).verdict, Verdict::failed);
  EXPECT_EQ(check(criterion).note, "not ok: b");
  EXPECT_DOUBLE_EQ(*check(criterion).measured, 0);
  const StudySummary summary = summarise("demo", study(), {});
  const auto columns = registry::columns_of(registry::Column::study);
  const auto lost = std::ranges::find(columns, &value) - columns.begin();
  EXPECT_EQ(summary.rows[0].values[static_cast<std::size_t>(lost)].count, 1U);  // of the one that ran
  runs_.erase(runs_.begin());
  EXPECT_EQ(check(criterion).verdict, Verdict::failed);  // none ran: no evidence
  EXPECT_FALSE(check(criterion).measured.has_value());
}

TEST_F(StudyTest, ARunWithoutTheNumberFailsWhereOthersHaveIt) {
  add("a", "slow", "full", 0.001);
  add("b", "slow", "full", 0.001).record.metrics.ate = {};
  Criterion criterion = ate_criterion(CriterionStatistic::mean);
  criterion.at_most = 1;
  const CriterionMeasurement measured = check(criterion);
  EXPECT_EQ(measured.verdict, Verdict::failed);
  EXPECT_EQ(measured.note, "without the number: b");
}

TEST_F(StudyTest, ComparisonsAreByRecordingOrOfMeans) {
  add("a", "slow", "full", 0.01);
  add("a", "slow", "no-imu", 0.04);
  add("b", "slow", "full", 0.03);
  add("b", "slow", "no-imu", 0.03);
  add("c", "slow", "full", 0.5);
  add("c", "slow", "no-imu", 0.5, RunStatus::lost);
  Criterion criterion = ate_criterion(CriterionStatistic::mean);
  criterion.against = "no-imu";
  criterion.at_most = 1;
  CriterionMeasurement measured = check(criterion);
  EXPECT_DOUBLE_EQ(*measured.measured, (0.25 + 1.0) / 2);
  EXPECT_EQ(measured.recordings, 2U);
  EXPECT_EQ(measured.note, "left out, no-imu is not ok: c");
  EXPECT_EQ(measured.verdict, Verdict::passed);
  criterion.of_means = true;
  EXPECT_DOUBLE_EQ(*check(criterion).measured, 0.04 / 0.07);
  criterion.of_means = false;
  criterion.compare = CriterionComparison::difference;
  EXPECT_NEAR(*check(criterion).measured, -0.015, 1e-15);
}

TEST_F(StudyTest, SharesCountLostRunsWhereTheCriterionSaysSo) {
  for (const char* name : {"a", "b", "c", "d"}) add(name, "fast", "full", 0.01);
  add("a", "fast", "no-imu", 0.049);
  add("b", "fast", "no-imu", 0.051);
  add("c", "fast", "no-imu", 0, RunStatus::lost);
  add("d", "fast", "no-imu", 0.01);
  Criterion criterion = ate_criterion(CriterionStatistic::share, "no-imu");
  criterion.against = "full";
  criterion.each_at_least = 5;
  criterion.lost_counts = true;
  criterion.at_least = 0.5;
  CriterionMeasurement measured = check(criterion);
  EXPECT_DOUBLE_EQ(*measured.measured, 0.5);
  EXPECT_EQ(measured.recordings, 4U);
  EXPECT_EQ(measured.verdict, Verdict::passed);
  criterion.lost_counts = false;
  EXPECT_EQ(check(criterion).verdict, Verdict::failed);
}

TEST_F(StudyTest, NeesIsHeldAgainstTheBoundsOfSoManyRuns) {
  for (const auto& [name, nees] : {std::pair("a", 0.9), std::pair("b", 1.2), std::pair("c", 1.1)}) {
    NeesResult result;
    result.stats = statistics(std::vector<double>{nees});
    add(name, "slow", "full", 0.01).record.metrics.nees[0] = {result, {}};
  }
  Criterion criterion = ate_criterion(CriterionStatistic::mean);
  criterion.metric = "nees_orientation";
  criterion.within_bounds = true;
  CriterionMeasurement measured = check(criterion);
  EXPECT_NEAR(*measured.measured, 3.2 / 3, 1e-15);
  // Chi-square with 9 degrees of freedom: 2.700 and 19.023, divided by 9.
  EXPECT_EQ(measured.limit, "0.3 .. 2.11 (95 % of 3 runs)");
  EXPECT_EQ(measured.verdict, Verdict::passed);
  runs_[0].record.metrics.nees[0].value->stats.mean = 5;
  EXPECT_EQ(check(criterion).verdict, Verdict::failed);
}

/// As tables have it, with the groups that it is about.
TEST_F(StudyTest, WhereTheDataComeFromIsSaid) {
  add("a", "walk", "full", 0.01).record.recording.truth = kPseudoTruthWord;
  add("b", "walk", "full", 0.01).record.recording.truth = kPseudoTruthWord;
  add("c", "room", "full", 0.01).record.recording.data = "simulated";
  add("d", "desk", "full", 0.01);
  const Study all = study();
  const StudySummary summary = summarise("demo", all, {});
  ASSERT_EQ(summary.notes.size(), 2U);
  EXPECT_TRUE(summary.notes[0].starts_with("simulated: ")) << summary.notes[0];
  EXPECT_TRUE(summary.notes[0].ends_with("(room)")) << summary.notes[0];
  EXPECT_TRUE(summary.notes[1].starts_with("pseudo ground truth: ")) << summary.notes[1];
  EXPECT_TRUE(summary.notes[1].ends_with("(walk)")) << summary.notes[1];
  EXPECT_NE(summary_text(summary).find("- pseudo ground truth: "), std::string::npos);
  EXPECT_NE(summary_json(summary, all).find("pseudo ground truth: "), std::string::npos);
  EXPECT_NE(summary_page(summary, all).find("<td>pseudo ground truth: "), std::string::npos);
}

TEST_F(StudyTest, TheSummaryHasItsOrigin) {
  add("a", "walk", "full", 0.01).record.provenance.cpu = "A";
  StudyRun& replicate = add("a", "walk", "full", 0.02);
  replicate.record.provenance.cpu = "B";
  for (StudyRun& run : runs_) {
    run.record.provenance.version = "0.1.0";
    run.record.provenance.git = "abc";
  }
  replicate.record.replicate = 1;
  const Study all = study();
  const auto json = nlohmann::json::parse(
      summary_json(summarise("demo", all, {}), all, {"fusebench bench demo --data DATA", {"b: elsewhere"}}));
  const nlohmann::json& origin = json.at("origin");
  EXPECT_EQ(origin.at("command"), "fusebench bench demo --data DATA");
  EXPECT_EQ(origin.at("versions"), nlohmann::json::array({"0.1.0 (abc)"}));
  EXPECT_EQ(origin.at("machines"), nlohmann::json::array({"A", "B"}));
  EXPECT_EQ(origin.at("absent"), nlohmann::json::array({"b: elsewhere"}));
  EXPECT_EQ(json.at("runs").at(0).at("replicate"), 0);
  EXPECT_EQ(json.at("runs").at(1).at("replicate"), 1);
}

/// The JSON that a page draws its charts from.
nlohmann::json charts_of(const std::string& page) {
  const std::string mark = R"(id="charts">)";
  const std::size_t begin = page.find(mark) + mark.size();
  return nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

TEST_F(StudyTest, ColoursAreByVariantAndPlacesByRecording) {
  add("a", "slow", "full", 0.01);
  add("a", "slow", "dm", 0.02);
  add("b", "slow", "full", 0.03);
  add("b", "slow", "no-imu", 0.05);  // the second recording, and the first of this variant
  add("c", "fast", "full", 0.01, RunStatus::lost);
  add("c", "fast", "no-imu", 0.04);  // alone in its chart
  const Study all = study();
  const nlohmann::json charts = charts_of(summary_page(summarise("demo", all, {}), all));
  ASSERT_EQ(charts.size(), 2U);
  std::map<std::string, int> colours;
  for (const auto& chart : charts) {
    for (const auto& series : chart.at("series")) {
      const auto [known, fresh] = colours.emplace(series.at("label"), series.at("colour"));
      EXPECT_EQ(known->second, series.at("colour")) << known->first;
    }
  }
  EXPECT_EQ(colours.size(), 3U);
  EXPECT_NE(colours["full"], colours["no-imu"]);
  EXPECT_NE(colours["full"], colours["dm"]);
  EXPECT_NE(colours["dm"], colours["no-imu"]);
  const auto& third = charts[0].at("series").at(2);
  EXPECT_EQ(third.at("label"), "no-imu");
  EXPECT_EQ(third.at("points"), nlohmann::json::parse("[[2.0, 5.0]]"));  // cm
}

class SharedPixelsTest : public StudyTest {
 protected:
  void SetUp() override {
    // Frame 1: pixels 1 and 2 are shared; the second 2 of dm lies in an overlapping patch and does not count.
    // Frame 2: pixel 5. Frame 3: nothing.
    runs_.reserve(4);
    add_frames(add("a", "fast", "full", 0.01),
               {{{1, 2.0F, true}, {2, 4.0F, true}, {9, 50.0F, true}}, {{5, 10.0F, true}}, {{3, 1.0F, true}}},
               {1.5, 35, 8});
    add_frames(add("a", "fast", "dm", 0.01),
               {{{2, 6.0F, true}, {1, 8.0F, false}, {2, 90.0F, true}, {7, 9.0F, true}},
                {{5, 30.0F, true}},
                {{4, 1.0F, true}}},
               {99, 99, 99});
  }
};

TEST_F(SharedPixelsTest, AgreeWithTheTablesCommonPixels) {
  const Study study = this->study();
  ASSERT_TRUE(study.notes.empty()) << study.notes.front();
  const auto expected = common_pixel_error(std::vector<std::filesystem::path>{
      runs_[0].folder / "intensity.bin", runs_[1].folder / "intensity.bin"});
  ASSERT_TRUE(expected.has_value());
  const registry::RunMetric& value = registry::run_metric("aie_common_grey");
  EXPECT_DOUBLE_EQ(*value_of(study, study.runs[0], value), (*expected)[0].aie_grey);
  EXPECT_DOUBLE_EQ(*value_of(study, study.runs[1], value), (*expected)[1].aie_grey);
  EXPECT_DOUBLE_EQ(*value_of(study, study.runs[0], value), (3.0 + 10.0) / 2);
  EXPECT_DOUBLE_EQ(*value_of(study, study.runs[1], value), (7.0 + 30.0) / 2);
  ASSERT_EQ(study.runs[1].shared.size(), 2U);
  EXPECT_EQ(study.runs[1].shared[0].pixels, 2U);
  EXPECT_DOUBLE_EQ(*study.runs[1].shared[1].motion_px, 35);  // as full saw it
}

TEST_F(SharedPixelsTest, CriteriaTakeFramesAboveAMotion) {
  Criterion criterion;
  criterion.variant = "dm";
  criterion.against = "full";
  criterion.metric = "aie_common_grey";
  criterion.statistic = CriterionStatistic::mean;
  criterion.of_means = true;
  criterion.at_least = 1.75;
  EXPECT_DOUBLE_EQ(*check(criterion).measured, 37.0 / 13);
  criterion.frames_above_px = 30;
  EXPECT_DOUBLE_EQ(*check(criterion).measured, 3);
  criterion.frames_above_px = 35;
  EXPECT_EQ(check(criterion).verdict, Verdict::not_applicable);
  std::swap(criterion.variant, criterion.against);
  criterion.frames_above_px = 30;
  EXPECT_DOUBLE_EQ(*check(criterion).measured, 1.0 / 3);
}

TEST_F(SharedPixelsTest, TheSummaryHasRowsAndCurves) {
  const StudySummary summary = summarise("demo", study(), {});
  ASSERT_EQ(summary.rows.size(), 2U);
  EXPECT_EQ(summary.rows[0].variant, "full");
  EXPECT_EQ(summary.rows[0].ok, 1U);
  ASSERT_EQ(summary.curves.size(), 2U);  // all groups, and the one
  EXPECT_EQ(summary.curves[0].group, "all");
  const auto& bins = summary.curves[1].bins;
  EXPECT_EQ(bins[0].means.frames, 1U);
  EXPECT_EQ(bins[0].means.pixels, 2U);
  EXPECT_DOUBLE_EQ(bins[0].means.variant_grey, 7);
  EXPECT_EQ(bins[5].means.frames, 1U);
  EXPECT_EQ(bins[3].means.frames, 0U);

  const auto json = nlohmann::json::parse(summary_json(summary, study()));
  EXPECT_EQ(json["motion"][1]["bins"][5]["ratio"], 3.0);
  EXPECT_TRUE(json["motion"][1]["bins"][5]["to_px"].is_null());
  EXPECT_TRUE(json["motion"][1]["bins"][3]["full"].is_null());
  EXPECT_EQ(json["rows"][1]["values"]["aie_common_grey"]["partner"], "full");
  EXPECT_EQ(json["rows"][1]["values"]["aie_common_grey"]["partner_mean"], 6.5);
  EXPECT_EQ(json["runs"][0]["values"]["ate_rmse_m"], 0.01);
  EXPECT_NE(summary_text(summary).find("| all   | 30 and more | 1"), std::string::npos)
      << summary_text(summary);
  const std::string page = summary_page(summary, study());
  const nlohmann::json motion = charts_of(page)[0].at("series");
  ASSERT_EQ(motion.size(), 3U);
  EXPECT_EQ(motion[2].at("label"), "dm / full");
  EXPECT_EQ(motion[0].at("colour"),
            1);  // full and dm as on all pages, and their ratio in grey, as no variant
  EXPECT_EQ(motion[1].at("colour"), 2);
  EXPECT_EQ(motion[2].at("colour"), 7);
  EXPECT_EQ(page.find("https://"), page.find("https://www.chartjs.org"));  // nothing is loaded from elsewhere
}

TEST_F(SharedPixelsTest, TheVariantsAreThoseThatTheSuiteNames) {
  runs_[0].variant = "literal";
  runs_[1].variant = "planar";
  variants_ = {"literal", "planar"};
  const Study all = study();
  const StudySummary summary = summarise("demo", all, {});
  ASSERT_FALSE(summary.curves.empty());
  const auto json = nlohmann::json::parse(summary_json(summary, all));
  const auto& bin = json.at("motion").at(0).at("bins").at(0);
  EXPECT_DOUBLE_EQ(bin.at("literal"), 3.0);
  EXPECT_DOUBLE_EQ(bin.at("planar"), 7.0);
  const std::vector<std::string> header = motion_tables(summary).front().header;
  EXPECT_EQ(header[4], "literal");
  EXPECT_EQ(header[5], "planar");
  EXPECT_EQ(header[6], "planar / literal");
  const nlohmann::json charts = charts_of(summary_page(summary, all));
  EXPECT_EQ(charts.at(0).at("series").at(0).at("label"), "literal");
  EXPECT_EQ(charts.at(0).at("series").at(1).at("label"), "planar");
  EXPECT_EQ(charts.at(0).at("series").at(2).at("label"), "planar / literal");
}

TEST_F(SharedPixelsTest, WhatCannotBeComparedIsANote) {
  write("a/full/frames.csv", "frame,timestamp\n");
  const Study study = this->study();
  ASSERT_EQ(study.notes.size(), 1U);
  EXPECT_NE(study.notes[0].find("patch_motion_px"), std::string::npos);
  EXPECT_TRUE(study.runs[1].shared.empty());
}

}  // namespace
}  // namespace fusebench
