#include "eval/compare/findings/findings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "eval/compare/findings/overview.hpp"
#include "eval/metrics/intensity_metrics.hpp"
#include "tests/support/expect_text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace findings;
using namespace record;
using namespace run_files;

namespace {

class FindingsTest : public testing::InTemporaryFolder {
 protected:
  void add_run(const std::string& recording, const std::string& variant, double ate_m,
               const std::string& reason = "") {
    RunRecord record;
    record.status = reason.empty() ? RunStatus::ok : RunStatus::lost;
    record.reason = reason;
    record.recording.name = recording;
    record.recording.fingerprint = recording;
    record.recording.imu = variant == "no-imu" ? "none" : "recorded";
    record.variant = variant;
    record.config = {{"terms.prior", std::string("imu"), "default"}};
    record.frames = {100, 100, 0};
    trajectory_error::AteResult ate;
    ate.stats = metrics::statistics(std::vector<double>{ate_m});
    if (reason.empty()) record.metrics.ate = {ate, {}};
    record.provenance = {"0.1.0", "abc", "GNU", "-O3", "e", "CPU X", 2, "host"};
    const auto folder = std::filesystem::path("runs") / recording / variant / "01234567";
    write(folder / "record.json", to_json(record));
    runs_.push_back({folder_ / folder, record});
  }

  [[nodiscard]] std::vector<Ranking> rankings() const { return rankings_of(runs_, tables::table_of(runs_)); }

  std::vector<FoundRun> runs_;
};

TEST_F(FindingsTest, OneRecordingIsNoEvidence) {
  add_run("a", "full", 0.01);
  add_run("a", "dm", 0.02);
  const auto found = rankings();
  ASSERT_EQ(found.size(), 1U);
  const std::string sentence = sentence_of(found[0]).value();
  testing::expect_contains(sentence, "full has the smallest ATE on one real recording: 1.00 cm");
  testing::expect_contains(sentence, "dm with 2.00 cm, 2.00 times the best of each recording");
  testing::expect_contains(sentence, "One recording: no evidence");
  EXPECT_FALSE(found[0].configurations[1].mean.interval.has_value());
}

TEST_F(FindingsTest, ARunThatTrackedFewFramesIsNotTheSmallestWithoutItsShare) {
  add_run("a", "full", 0.01);
  add_run("a", "dm", 0.005);
  runs_[1].record.frames = {100, 20, 80};
  runs_[1].record.recording.notes = {"warning: the poses contradict the ground truth: ATE 0.85 m"};
  const auto found = rankings();
  testing::expect_contains(sentence_of(found.at(0)).value(),
                           "dm (20 % of its frames tracked, its poses contradict the ground truth) has the "
                           "smallest ATE on one real recording");
  const auto overview = overview_of(found[0], tables::table_of(runs_));
  EXPECT_FALSE(overview.at(0).cells.at(0).best) << "dm";
  EXPECT_TRUE(overview[0].cells.at(1).best);
}

TEST_F(FindingsTest, NamesATieOfEqualNumbers) {
  add_run("a", "full", 0.01);
  add_run("a", "dm", 0.01);
  EXPECT_EQ(sentence_of(rankings().at(0)).value(),
            "A tie for the smallest ATE on one real recording: full 1.00 cm, 1.00 times the best of each "
            "recording; dm 1.00 cm, 1.00 times the best of each recording. Their numbers are equal.");
}

TEST_F(FindingsTest, PosesAtTheEndAreHeldAgainstThoseOnTheWay) {
  add_run("a", "full", 0.02);
  EXPECT_FALSE(final_poses_of(runs_));
  const auto close_loops = [&](double ate_m) {
    RunRecord& record = runs_.back().record;
    record.final_metrics = record.metrics;
    record.final_metrics->ate.value->stats = metrics::statistics(std::vector<double>{ate_m});
  };
  close_loops(0.012);
  testing::expect_contains(final_poses_of(runs_).value(),
                           "final poses have an ATE of 1.20 cm, and online poses 2.00 cm");
  add_run("b", "full", 0.02);
  close_loops(0.024);
  testing::expect_contains(final_poses_of(runs_).value(), "in 1 of 2 runs; the median ratio is 0.90");
}

TEST_F(FindingsTest, ARunWithADamagedRecordFailedAmongThoseOfItsRecording) {
  add_run("a", "full", 0.01);
  add_run("a", "dm", 0.02);
  record::RunRecord damaged;
  damaged.recording.name = "a";
  damaged.recording.data = record::kUnknownWord;
  damaged.recording.imu = record::kUnknownWord;
  damaged.variant = "dm";
  runs_.push_back({folder_ / "runs/a/dm/89abcdef", damaged, run_files::RunState::damaged});
  const auto found = rankings();
  ASSERT_EQ(found.size(), 1U);
  ASSERT_EQ(found[0].configurations.size(), 2U);
  EXPECT_EQ(found[0].configurations[1].runs, 2U);
  EXPECT_EQ(found[0].configurations[1].ok, 1U);
}

TEST_F(FindingsTest, JudgesADifferenceByTheMeanRatioAndIntervalOfBest) {
  const double noise[] = {0.02, -0.01, 0.015, -0.025};
  for (int i = 0; i < 4; ++i) {
    const std::string name(1, static_cast<char>('a' + i));
    add_run(name, "full", 0.01 * (i + 1));  // recordings differ by far more than the variants
    add_run(name, "dm", 0.013 * (i + 1) * std::exp(noise[i]));
  }
  const auto clear = rankings();
  EXPECT_NEAR(*clear[0].configurations[1].mean.ratio, 1.3, 1e-9);
  EXPECT_GT((*clear[0].configurations[1].mean.interval)[0], 1.2);
  testing::expect_contains(sentence_of(clear[0]).value(),
                           "1.30 times the best of each recording (95 % interval 1.2");
  testing::expect_contains(sentence_of(clear[0]).value(), "do not explain the difference");
  testing::expect_contains(sentence_of(clear[0]).value(), "(geometric mean over recordings)");

  runs_.clear();
  for (const auto& [name, dm_m] : {std::pair{"a", 0.02}, {"b", 0.006}, {"c", 0.012}}) {
    add_run(name, "full", 0.01);
    add_run(name, "dm", dm_m);
  }
  testing::expect_contains(sentence_of(rankings()[0]).value(),
                           "A tie for the smallest ATE on 3 real recordings: full");

  runs_.clear();
  for (const char* const name : {"a", "b"}) {
    add_run(name, "full", 0.01);
    add_run(name, "dm", 0.012);
  }
  testing::expect_contains(sentence_of(rankings()[0]).value(), "2 recordings are too few");
}

TEST_F(FindingsTest, RunsThatEndedWellSayHowMuchTheyLost) {
  add_run("a", "full", 0.01);
  add_run("a", "dm", 0.02);
  runs_[0].record.frames = {100, 96, 4};
  EXPECT_EQ(failures_of(tables::table_of(runs_)).size(), 1U) << "little";
  runs_[1].record.frames = {100, 42, 58};
  const auto failures = failures_of(tables::table_of(runs_));
  ASSERT_EQ(failures.size(), 2U);
  EXPECT_EQ(failures[0], "All runs ended well.");
  EXPECT_EQ(failures[1], "Frames without a pose, which an ATE excludes: dm on a (58 %).");
}

TEST_F(FindingsTest, RanksAConfigurationThatLostARecordingLast) {
  add_run("a", "full", 0.01);
  add_run("b", "full", 0.04);
  add_run("a", "dm", 0.005);  // better, but lost elsewhere
  add_run("b", "dm", 0.0, "too many lost frames");
  const auto found = rankings();
  EXPECT_EQ(found[0].configurations[0].label, "full");
  EXPECT_NEAR(*found[0].configurations[0].value, 0.02, 1e-12);
  EXPECT_FALSE(found[0].configurations[1].value.has_value());
  EXPECT_NEAR(*found[0].configurations[0].mean.ratio, std::sqrt(2.0), 1e-12);
  const std::string sentence = sentence_of(found[0]).value();
  testing::expect_contains(sentence, "full alone has an ATE on all of 2 real recordings");
  testing::expect_contains(sentence, "Next is dm, which has it on 1.");
  const auto failures = failures_of(tables::table_of(runs_));
  ASSERT_EQ(failures.size(), 1U);
  testing::expect_contains(failures[0], "1 of 4 runs did not end well: dm on b (lost: too many lost frames)");
}

TEST_F(FindingsTest, TheOverviewHasANumberForEachRecordingAndMethodAndTheBestMarked) {
  add_run("a", "full", 0.01);
  add_run("b", "full", 0.04);
  add_run("c", "full", 0.03);
  add_run("a", "dm", 0.02);
  add_run("b", "dm", 0.02);
  add_run("c", "dm", 0.0, "too many lost frames");
  runs_[3].record.frames = {100, 42, 58};
  const auto found = rankings();
  const std::vector<OverviewRow> overview = overview_of(found.at(0), tables::table_of(runs_));
  ASSERT_EQ(overview.size(), 3U);
  EXPECT_EQ(overview[0].recording, "a");
  EXPECT_NEAR(overview[0].cells.at(0).value->median, 0.01, 1e-12);
  EXPECT_TRUE(overview[0].cells[0].best);
  EXPECT_FALSE(overview[0].cells[1].best);
  EXPECT_NEAR(*overview[0].cells[1].tracked_share, 0.42, 1e-12);
  EXPECT_TRUE(overview[1].cells[1].best);
  EXPECT_FALSE(overview[2].cells[0].best) << "there is no other";
  EXPECT_FALSE(overview[2].cells[1].value);
  EXPECT_EQ(overview[2].cells[1].status, RunStatus::lost);
  EXPECT_NEAR(*found[0].configurations[0].mean.ratio, std::cbrt(2.0), 1e-12);
  EXPECT_EQ(found[0].configurations[1].mean.recordings, 2U);
}

TEST_F(FindingsTest, ReplicatesWhoseRangesOverlapAreAllBest) {
  const auto add_replicates = [&](const std::string& variant, std::initializer_list<double> ate_m) {
    int replicate = 0;
    for (const double value : ate_m) {
      add_run("a", variant, value);
      runs_.back().record.replicate = replicate++;
    }
  };
  add_replicates("full", {0.010, 0.012, 0.011});
  add_replicates("dm", {0.0115, 0.013, 0.014});
  add_replicates("no-imu", {0.02, 0.03, 0.025});
  const auto found = rankings();
  const std::vector<OverviewRow> overview = overview_of(found.at(0), tables::table_of(runs_));
  const auto& cells = overview.at(0).cells;
  ASSERT_EQ(cells.size(), 3U);
  EXPECT_NEAR(cells[0].value->least, 0.010, 1e-12);
  EXPECT_NEAR(cells[0].value->median, 0.011, 1e-12);
  EXPECT_NEAR(cells[0].value->most, 0.012, 1e-12);
  EXPECT_TRUE(cells[0].best && cells[1].best);
  EXPECT_FALSE(cells[2].best);
}

TEST_F(FindingsTest, WindowsThatShareFramesAndImusAreComparedApart) {
  const auto add_window = [&](const std::string& variant, std::size_t first, std::size_t frames,
                              double ate_m) {
    add_run("a", variant, ate_m);
    runs_.back().record.recording.first_frame = first;
    runs_.back().record.recording.frames = frames;
  };
  add_window("full", 0, 5, 0.01);
  add_window("full", 0, 4, 0.03);
  add_window("dm", 0, 5, 0.02);
  add_window("dm", 0, 5, 0.04);
  runs_.back().record.recording.imu = "synthetic IMU";
  const auto found = rankings();
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].frames, "");  // the whole recording
  EXPECT_EQ(found[1].frames, "frames 0:4");
  ASSERT_EQ(found[0].configurations.size(), 2U);
  EXPECT_EQ(found[0].configurations[0].label, "full");
  EXPECT_EQ(found[0].configurations[1].label, "dm recorded IMU");
  ASSERT_EQ(found[1].configurations.size(), 1U);
  EXPECT_EQ(found[2].configurations.at(0).label, "dm synthetic IMU");
  testing::expect_contains(sentence_of(found[1]).value(), "3.00 cm on one real recording, frames 0:4");

  add_run("b", "full", 0.01);  // a whole recording is compared with the others
  EXPECT_EQ(rankings().at(0).recordings, 2U);
  runs_ = {runs_.front()};
  runs_.front().record.recording.whole_frames = 9;
  testing::expect_contains(sentence_of(rankings().at(0)).value(), "one real recording, frames 0:5");

  runs_.clear();  // windows that share no frame are samples of the recording
  add_window("full", 0, 5, 0.01);
  add_window("full", 5, 5, 0.04);
  const auto apart = rankings();
  ASSERT_EQ(apart.size(), 1U);
  EXPECT_EQ(apart[0].recordings, 2U);
  EXPECT_NEAR(*apart[0].configurations[0].value, 0.02, 1e-12);
}

TEST_F(FindingsTest, ARunWithoutGroundTruthHasItsIntensityErrorSaid) {
  add_run("a", "full", 0.01);
  RecordedMetrics& known = runs_.front().record.metrics;
  known.ate = {std::nullopt, "no ground truth"};
  metrics::IntensityAccumulator sums;
  sums.add_frame(std::vector<IntensityResidual>{{5, 2.0F, true}, {7, 10.0F, true}});
  known.aie = {sums.result(), {}};
  const auto found = rankings();
  ASSERT_EQ(found.size(), 1U);
  testing::expect_contains(sentence_of(found[0]).value(),
                           "full has an AIE of 6.000 grey on one real recording.");

  add_run("a", "dm", 0.01);
  runs_.back().record.metrics =
      runs_.front().record.metrics;  // of pixels that it does not share, as no file says which
  EXPECT_TRUE(rankings().empty()) << "over other pixels they do not compare";
}

TEST_F(FindingsTest, RunsWithASyntheticImuAreRankedApart) {
  add_run("a", "full", 0.01);
  runs_.back().record.recording.imu = "synthetic IMU";
  add_run("a", "no-imu", 0.02);
  const auto found = rankings();
  ASSERT_EQ(found.size(), 2U);
  testing::expect_contains(
      sentence_of(found[0]).value(),
      "full has an ATE of 1.00 cm on one real recording, synthetic IMU. There is nothing");
  testing::expect_contains(sentence_of(found[1]).value(),
                           "no-imu has an ATE of 2.00 cm on one real recording.");
}

TEST_F(FindingsTest, TheOriginHasVersionAndMachine) {
  add_run("a", "full", 0.01);
  add_run("b", "full", 0.01);
  EXPECT_EQ(origin_of(runs_), "Made by fusebench 0.1.0 (abc) on host, CPU X (2 threads).");
}

}  // namespace
}  // namespace fusebench
