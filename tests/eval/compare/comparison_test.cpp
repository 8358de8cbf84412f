#include "eval/compare/comparison.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "eval/compare/comparison_formats.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace metrics;
using namespace trajectory_error;
using namespace record;
using namespace run_files;
using namespace compare;

namespace {

constexpr std::size_t kFrames = 20;

RunRecord good_record(const std::string& recording = "fr1_rpy", const std::string& variant = "full") {
  RunRecord record;
  record.status = RunStatus::ok;
  record.reason = "";
  record.recording.name = recording;
  record.recording.frames = kFrames;
  record.recording.fingerprint = recording;
  record.variant = variant;
  record.config = {{"iekf.max_iterations", std::int64_t{8}, "default"},
                   {"tsdf.voxel_m", 0.01, "default"},
                   {"imu.use", true, "variant full"}};
  AteResult ate;
  ate.stats = statistics(std::vector<double>{0.01, 0.02});
  record.metrics.ate = {ate, {}};
  RpeResult rpe;
  rpe.translation = statistics(std::vector<double>{0.001});
  rpe.rotation = statistics(std::vector<double>{0.002});
  record.metrics.rpe_frame = {rpe, {}};
  record.metrics.rpe_second = {rpe, {}};
  IntensityResult aie;
  aie.all.aie_grey = 7.5;
  record.metrics.aie = {aie, {}};
  record.frames = {kFrames, kFrames, 0};
  record.model = {1000, 2000, 30};
  record.timing.wall_s = 10;
  record.timing.cpu_s = 20;
  record.timing.peak_rss_bytes = 300'000'000;
  record.provenance.cpu = "CPU";
  record.provenance.host = "host";
  record.provenance.threads = 2;
  return record;
}

std::string trajectory(std::size_t moved_from = kFrames, double x_m = 0) {
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  for (std::size_t i = 0; i < kFrames; ++i)
    text += fmt::format("{}.000000000 {} 0 0 0 0 0 1\n", i, i < moved_from ? 0.5 : 0.5 + x_m);
  return text;
}

const GateResult* gate(const RunComparison& comparison, std::string_view name) {
  for (const ComparedRun& run : comparison.runs) {
    for (const GateResult& result : run.gates) {
      if (result.gate == name && result.verdict != GateVerdict::unchanged) return &result;
    }
  }
  return nullptr;
}

class ComparisonTest : public testing::InTemporaryFolder {
 protected:
  void add(const std::string& side, const RunRecord& record, const std::string& tum = trajectory(),
           int repetition = 0) const {
    const auto run = std::filesystem::path(side) / fmt::format("r{:02}", repetition) / record.recording.name /
                     record.variant / "01234567";
    write(run / "record.json", to_json(record));
    if (!tum.empty()) write(run / "trajectory.tum", tum);
  }

  [[nodiscard]] RunComparison compare(const Gates& gates = {}, bool confirm = false) const {
    const auto found = [&](const char* side) {
      auto runs = find_runs(folder_ / side);
      EXPECT_TRUE(runs.has_value()) << runs.error().message;
      return runs ? *runs : std::vector<FoundRun>();
    };
    return compare_runs(found("base"), found("new"), gates,
                        confirm ? found("again") : std::vector<FoundRun>())
        .value();
  }

  /// BASE as it is, NEW with a change.
  template <class Change>
  [[nodiscard]] RunComparison compare_changed(Change change) const {
    add("base", good_record());
    RunRecord record = good_record();
    change(record);
    add("new", record);
    return compare();
  }

  /// n repetitions with a median time, memory and 3 % of noise.
  void add_timed(const std::string& side, int n, double factor, std::uint64_t seed) const {
    std::mt19937_64 generator(seed);
    for (int i = 0; i < n; ++i) {
      const auto noise = [&] { return 1 + 0.06 * (static_cast<double>(generator() >> 11) * 0x1p-53 - 0.5); };
      RunRecord record = good_record();
      record.timing.cpu_s = 20 * factor * noise();
      record.timing.wall_s = 10 * factor * noise();
      record.timing.peak_rss_bytes = static_cast<std::uint64_t>(3e8 * noise());
      add(side, record, trajectory(), i);
    }
  }
};

TEST_F(ComparisonTest, EqualRunsPassAndAreBitIdentical) {
  const RunComparison comparison = compare_changed([](RunRecord&) {});
  EXPECT_TRUE(comparison.passed());
  EXPECT_EQ(comparison.identical(), 1U);
  EXPECT_EQ(comparison.count(GateVerdict::regression), 0U);
  EXPECT_EQ(comparison.count(GateVerdict::note), 3U);  // times of one repetition
  EXPECT_EQ(gate(comparison, "wall_s")->message,
            "10 s -> 10 s (ratio 1.000), not gated: 1 repetition; 5 are needed");
}

RunRecord record_of_program(double ate_m, int seed, const std::string& definition = "name = \"other\"\n") {
  RunRecord record = good_record("fr1_rpy", "other");
  record.config.clear();
  record.program = RecordedProgram{definition, "1.0", seed};
  record.repetition = seed;
  record.metrics.ate.value->stats.rmse = ate_m;
  return record;
}

TEST_F(ComparisonTest, AProgramThatIsNotDeterministicPassesAgainstItself) {
  for (int seed = 1; seed <= 5; ++seed) {
    add("base", record_of_program(0.01 + 0.001 * seed, seed), trajectory(5, 0.001 * seed), seed);
    add("new", record_of_program(0.0155 - 0.001 * seed, seed), trajectory(5, 0.002 * seed), seed);
  }
  const RunComparison comparison = compare();
  EXPECT_TRUE(comparison.passed()) << gate(comparison, "repetitions");
  EXPECT_EQ(gate(comparison, "ate_rmse_m"), nullptr);
  EXPECT_EQ(gate(comparison, "trajectory"), nullptr) << "no two of its trajectories are the same";
}

TEST_F(ComparisonTest, AProgramThatIsNotDeterministicFailsWhereItsRangesAreApart) {
  for (int seed = 1; seed <= 5; ++seed) {
    add("base", record_of_program(0.01 + 0.001 * seed, seed), trajectory(), seed);
    add("new", record_of_program(0.05 + 0.001 * seed, seed), trajectory(), seed);
  }
  const RunComparison comparison = compare();
  ASSERT_NE(gate(comparison, "ate_rmse_m"), nullptr);
  EXPECT_EQ(gate(comparison, "ate_rmse_m")->verdict, GateVerdict::regression);
}

TEST_F(ComparisonTest, FewRunsOfAProgramThatIsNotDeterministicAreShown) {
  for (int seed = 1; seed <= 2; ++seed) {
    add("base", record_of_program(0.01, seed), trajectory(), seed);
    add("new", record_of_program(0.05, seed), trajectory(), seed);
  }
  const RunComparison comparison = compare();
  EXPECT_TRUE(comparison.passed());
  ASSERT_NE(gate(comparison, "ate_rmse_m"), nullptr);
  EXPECT_EQ(gate(comparison, "ate_rmse_m")->verdict, GateVerdict::note);
  EXPECT_NE(gate(comparison, "ate_rmse_m")->not_gated.find("2 runs"), std::string::npos);
}

TEST_F(ComparisonTest, RepetitionsThatDifferFailUnlessTheGateSaysReport) {
  const std::string declared = "name = \"other\"\ndeterministic = true\n";
  for (int seed = 1; seed <= 2; ++seed)
    for (const char* const side : {"base", "new"})
      add(side, record_of_program(0.01 * seed, seed, declared), trajectory(), seed);
  const RunComparison failed = compare();
  ASSERT_NE(gate(failed, "repetitions"), nullptr);
  EXPECT_TRUE(gate(failed, "repetitions")->fails);
  Gates gates;
  gates.repetitions_fail = false;
  EXPECT_TRUE(compare(gates).passed());
}

TEST_F(ComparisonTest, PairsRunsThatDifferInIgnoredOptions) {
  const auto with = [](std::int64_t iterations, double voxel_m) {
    RunRecord record = good_record();
    record.config = {{"iekf.max_iterations", iterations, "--set"},
                     {"tsdf.voxel_m", voxel_m, "--set"},
                     {"imu.use", true, "variant full"}};
    return record;
  };
  add("base", with(4, 0.02));
  RunRecord changed = with(6, 0.03);
  changed.metrics.ate.value->stats.rmse *= 2;
  add("new", changed);
  const auto compared = [&](const IgnoredOptions& ignored) {
    return compare_runs(*find_runs(folder_ / "base"), *find_runs(folder_ / "new"), Gates(), {}, ignored)
        .value();
  };
  EXPECT_EQ(compared({}).runs.size(), 2U);
  EXPECT_EQ(compared({"iekf."}).runs.size(), 2U) << "another one differs, too";
  const RunComparison paired = compared({"iekf.", "tsdf.voxel_m"});
  ASSERT_EQ(paired.runs.size(), 1U);
  ASSERT_NE(gate(paired, "ate_rmse_m"), nullptr);
  EXPECT_EQ(gate(paired, "ate_rmse_m")->verdict, GateVerdict::regression);
  ASSERT_NE(gate(paired, "options"), nullptr);
  EXPECT_EQ(gate(paired, "options")->verdict, GateVerdict::note);
  EXPECT_EQ(gate(paired, "options")->message,
            "ignored: iekf.max_iterations = 4 and 6, tsdf.voxel_m = 0.02 and 0.03");
  EXPECT_EQ(gate(paired, "config"), nullptr) << "what is ignored is no changed default";
  EXPECT_TRUE(paired.notes.empty());
  EXPECT_EQ(compared({"iekf.", "tsdf.voxel_m", "tsdf.gone"}).notes.size(), 1U) << "no run has it";
}

TEST_F(ComparisonTest, AnIgnoredOptionMayBeSetOnOneSideOnly) {
  add("base", good_record());
  RunRecord set = good_record();
  set.config[0] = {"iekf.max_iterations", std::int64_t{3}, "--set"};
  add("new", set);
  const auto compared = compare_runs(*find_runs(folder_ / "base"), *find_runs(folder_ / "new"), Gates(), {},
                                     {"iekf.max_iterations"})
                            .value();
  ASSERT_EQ(compared.runs.size(), 1U);
  EXPECT_TRUE(compared.passed());
  ASSERT_NE(gate(compared, "options"), nullptr);
}

TEST_F(ComparisonTest, WorseMetricIsARegressionAndBetterOneAnImprovement) {
  add("base", good_record());
  RunRecord record = good_record();
  record.metrics.ate.value->stats.rmse *= 1.001;
  record.metrics.aie.value->all.aie_grey *= 0.999;
  record.metrics.rpe_second.value->rotation.rmse *= 1 + 1e-12;  // within the tolerance
  add("new", record);
  RunComparison comparison = compare();
  EXPECT_EQ(comparison.failures(), 2U);
  ASSERT_NE(gate(comparison, "ate_rmse_m"), nullptr);
  EXPECT_EQ(gate(comparison, "ate_rmse_m")->verdict, GateVerdict::regression);
  EXPECT_NE(gate(comparison, "ate_rmse_m")->message.find("+0.1 %"), std::string::npos);
  ASSERT_NE(gate(comparison, "aie_grey"), nullptr);
  EXPECT_EQ(gate(comparison, "aie_grey")->verdict, GateVerdict::improvement);
  EXPECT_TRUE(comparison.notes.empty()) << "no next BASE after a regression: " << comparison.notes.front();
  Gates gates;
  gates.improvements_fail = false;
  comparison = compare(gates);
  EXPECT_EQ(comparison.failures(), 1U);
}

TEST_F(ComparisonTest, ANextBaseIsSuggestedOnceAndOnlyWithoutRegressions) {
  const RunComparison better = compare_changed([](RunRecord& record) {
    record.metrics.ate.value->stats.rmse *= 0.5;
    record.metrics.aie.value->all.aie_grey *= 0.5;
  });
  EXPECT_EQ(better.count(GateVerdict::improvement), 2U);
  ASSERT_EQ(better.notes.size(), 1U);
  EXPECT_NE(better.notes[0].find("take NEW as the next BASE"), std::string::npos);
}

TEST_F(ComparisonTest, ADroppedFrameIsCaughtByFramesAndCoverage) {
  const RunComparison comparison = compare_changed([](RunRecord& record) {
    record.frames.tracked = kFrames - 1;
    record.frames.lost = 1;
  });
  EXPECT_EQ(comparison.failures(), 2U);
  EXPECT_EQ(gate(comparison, "frames_tracked")->verdict, GateVerdict::regression);
  EXPECT_EQ(gate(comparison, "coverage")->verdict, GateVerdict::regression);
}

TEST_F(ComparisonTest, ANumberWithoutADirectionIsChangedAndListedAfterRegressions) {
  const RunComparison comparison = compare_changed([](RunRecord& r) {
    ++r.model.vertices;
    r.metrics.ate.value->stats.rmse *= 2;
  });
  ASSERT_NE(gate(comparison, "model_vertices"), nullptr);
  EXPECT_EQ(gate(comparison, "model_vertices")->verdict, GateVerdict::changed);
  EXPECT_TRUE(gate(comparison, "model_vertices")->fails);
  EXPECT_TRUE(comparison_summary(comparison).starts_with("FAIL: 1 regression, 1 changed, 0 improvements, "));
  const auto lines = comparison_lines(comparison, false);
  ASSERT_GE(lines.size(), 2U);
  EXPECT_EQ(lines[0].gate, "ate_rmse_m");
  EXPECT_EQ(lines[1].gate, "model_vertices");
  EXPECT_NE(comparison_text(comparison, false).find("\nCHANGED "), std::string::npos);
  EXPECT_NE(comparison_junit(comparison).find("<failure type=\"CHANGED\""), std::string::npos);
}

TEST_F(ComparisonTest, ALostRunIsOneRegressionAndBackIsAnImprovement) {
  RunComparison comparison = compare_changed([](RunRecord& record) {
    record.status = RunStatus::lost;
    record.reason = "lost at frame 3";
    record.metrics = {};
  });
  EXPECT_EQ(comparison.failures(), 1U);
  EXPECT_EQ(gate(comparison, "status")->message, "ok -> lost (lost at frame 3)");
  const auto base = find_runs(folder_ / "base");
  const auto fresh = find_runs(folder_ / "new");
  const auto reversed = compare_runs(*fresh, *base, Gates()).value();
  EXPECT_EQ(gate(reversed, "status")->verdict, GateVerdict::improvement);
}

TEST_F(ComparisonTest, AMetricThatIsGoneIsARegressionWithItsReason) {
  const RunComparison comparison = compare_changed([](RunRecord& r) {
    r.metrics.ate = {std::nullopt, "no ground truth"};
  });
  EXPECT_EQ(comparison.failures(), 1U);
  EXPECT_NE(gate(comparison, "ate_rmse_m")->message.find("none: no ground truth"), std::string::npos);
}

TEST_F(ComparisonTest, AChangedDefaultStillPairsAndIsCaught) {
  const RunComparison comparison = compare_changed([](RunRecord& r) { r.config[0].value = std::int64_t{9}; });
  EXPECT_EQ(comparison.runs.size(), 1U);
  EXPECT_EQ(comparison.failures(), 1U);
  EXPECT_NE(gate(comparison, "config")->message.find("iekf.max_iterations: 8 -> 9"), std::string::npos);
}

TEST_F(ComparisonTest, AnOptionThatSomebodySetMakesAnotherExperiment) {
  const RunComparison comparison = compare_changed([](RunRecord& r) { r.config[0].origin = "--set"; });
  ASSERT_EQ(comparison.runs.size(), 2U);
  EXPECT_EQ(comparison.runs[0].gates.front().message, "missing in NEW");
  EXPECT_EQ(comparison.runs[1].gates.front().verdict, GateVerdict::note);
  EXPECT_EQ(comparison.runs[1].runs.label, "fr1_rpy/full [iekf.max_iterations=8]");
}

TEST_F(ComparisonTest, OptionsInWhichUnpairedRunsDifferAreNamedOnce) {
  for (const char* recording : {"fr1_rpy", "fr1_xyz"}) {
    add("base", good_record(recording));
    RunRecord set = good_record(recording);
    set.config[0] = {"iekf.max_iterations", std::int64_t{3}, "--set"};
    set.config[1].origin = "--set";
    set.config[1].value = 0.02;
    add("new", set);
  }
  const RunComparison comparison = compare();
  EXPECT_FALSE(comparison.passed());
  ASSERT_EQ(comparison.notes.size(), 1U);
  EXPECT_EQ(
      comparison.notes[0],
      "runs of BASE and NEW differ only in options: iekf.max_iterations, tsdf.voxel_m; --ignore-options "
      "iekf.max_iterations --ignore-options tsdf.voxel_m pairs them");
}

TEST_F(ComparisonTest, VariantsInWhichUnpairedRunsDifferAreNamedWithTheVerbsThatCompareThem) {
  for (const char* recording : {"fr1_rpy", "fr1_xyz"}) {
    RunRecord full = good_record(recording, "full");
    full.recording.imu = "recorded";
    add("base", full);
    add("new", good_record(recording, "no-imu"));
  }
  const RunComparison comparison = compare();
  ASSERT_EQ(comparison.notes.size(), 1U);
  EXPECT_TRUE(comparison.notes[0].starts_with(
      "runs of BASE and NEW differ only in the variant (full and no-imu): `compare` pairs"))
      << comparison.notes[0];
}

TEST_F(ComparisonTest, UnpairedRunsOfOtherRecordingsHaveNoHint) {
  add("base", good_record("fr1_rpy"));
  add("new", good_record("fr1_xyz", "dm"));
  EXPECT_TRUE(compare().notes.empty());
}

TEST_F(ComparisonTest, AMissingRunFailsAndANewOneDoesNot) {
  add("base", good_record());
  add("base", good_record("fr1_xyz"));
  add("new", good_record());
  add("new", good_record("fr1_desk"));
  const RunComparison comparison = compare();
  EXPECT_EQ(comparison.failures(), 1U);
  EXPECT_EQ(gate(comparison, "run")->message, "new, no baseline: ok");
  EXPECT_NE(comparison_text(comparison, false).find("fr1_xyz/full"), std::string::npos);
  EXPECT_TRUE(comparison_text(comparison, false).ends_with(comparison_summary(comparison) + "\n"));
}

TEST_F(ComparisonTest, ARunThatNeverBeganPairsAlthoughItKnowsNoFrames) {
  add("base", good_record());
  RunRecord record;
  record.reason = "no space left";
  record.recording.name = "fr1_rpy";
  record.variant = "full";
  add("new", record, "");
  const RunComparison comparison = compare();
  ASSERT_EQ(comparison.runs.size(), 1U);
  EXPECT_EQ(comparison.failures(), 1U);
  EXPECT_EQ(gate(comparison, "status")->message, "ok -> failed (no space left)");
}

TEST_F(ComparisonTest, OtherDataIsSaidInsteadOfMetrics) {
  for (const std::size_t frames : {kFrames, kFrames - 1}) {
    const RunComparison comparison = compare_changed([&](RunRecord& record) {
      record.recording.fingerprint = "other";
      record.recording.frames = frames;
      record.metrics.ate.value->stats.rmse *= 2;
    });
    EXPECT_EQ(comparison.failures(), 1U);
    ASSERT_NE(gate(comparison, "data"), nullptr);
    EXPECT_NE(gate(comparison, "data")->message.find("changed: not comparable"), std::string::npos);
    EXPECT_NE(gate(comparison, "data")->message.find("the same recording and --frames"), std::string::npos);
    EXPECT_EQ(gate(comparison, "data")->message.find("scripts/"), std::string::npos);  // ours, not a user's
  }
}

TEST_F(ComparisonTest, ASimulationMadeAnewIsComparedWhereTheGatesLetIt) {
  Gates gates;
  gates.changed_simulation_fails = false;
  for (const char* data : {"simulated", "recorded"}) {
    const auto made = [&](RunRecord record, const char* fingerprint) {
      record.recording.data = data;
      record.recording.fingerprint = fingerprint;
      return record;
    };
    add("base", made(good_record(data), "one"));
    add("new", made(good_record(data), "other"));
  }
  const RunComparison comparison = compare(gates);
  EXPECT_EQ(comparison.failures(), 1U) << "what was recorded cannot be made anew";
  ASSERT_EQ(comparison.runs.size(), 2U);
  for (const ComparedRun& run : comparison.runs)
    EXPECT_EQ(run.gates.size() > 3, run.runs.experiment.recording == "simulated") << run.runs.label;
}

TEST_F(ComparisonTest, DivergencesAreNamedTheEarliestFirst) {
  for (const char* name : {"a", "b", "c"}) add("base", good_record(name));
  add("new", good_record("a"), trajectory(12, 0.001));
  add("new", good_record("b"), trajectory(5, 0.0002));
  add("new", good_record("c"));
  write("new/r00/b/full/01234567/frames.csv",
        "frame,timestamp,status\n104,4.000000000,tracked\n105,5.000000000,tracked\n");
  const RunComparison comparison = compare();
  EXPECT_TRUE(comparison.passed());
  EXPECT_EQ(comparison.identical(), 1U);
  const auto diverging = comparison.diverging();
  ASSERT_EQ(diverging.size(), 2U);
  EXPECT_EQ(diverging[0]->divergence->text(), "differs from frame 12 on (stamp 12.000000000): moved by 1 mm");
  EXPECT_EQ(diverging[1]->divergence->text(),
            "differs from frame 105 on (stamp 5.000000000): moved by 0.2 mm");
  Gates gates;
  gates.divergence_fails = true;
  EXPECT_EQ(compare(gates).failures(), 2U);
}

TEST_F(ComparisonTest, AFrameTrackedOnOneSideIsADivergence) {
  add("base", good_record());
  std::string tum = trajectory();
  const auto row = tum.find("7.000000000");
  tum.erase(row, tum.find('\n', row) + 1 - row);
  add("new", good_record(), tum);
  EXPECT_EQ(compare().runs[0].divergence->text(),
            "differs from frame 7 on (stamp 7.000000000): only BASE tracked it");
}

TEST_F(ComparisonTest, ADamagedTrajectoryIsARegression) {
  add("base", good_record());
  add("new", good_record(), "0.0 1 2 3\n");
  const RunComparison comparison = compare();
  ASSERT_NE(gate(comparison, "trajectory"), nullptr);
  EXPECT_TRUE(gate(comparison, "trajectory")->fails);
  const std::string& message = gate(comparison, "trajectory")->message;
  EXPECT_NE(message.find("trajectory.tum:1"), std::string::npos) << message;
}

TEST_F(ComparisonTest, ADamagedRunOfEitherSideIsAnErrorThatNamesItsFile) {
  add("base", good_record());
  add("new", good_record());
  write("new/r00/fr1_rpy/full/01234567/record.json", std::string(5000, '\0'));
  const auto whole = *find_runs(folder_ / "base");
  const auto damaged = *find_runs(folder_ / "new");
  for (const auto& comparison : {compare_runs(whole, damaged, Gates()), compare_runs(damaged, whole, Gates()),
                                 compare_runs(whole, whole, Gates(), damaged)}) {
    ASSERT_FALSE(comparison.has_value());
    EXPECT_EQ(comparison.error().code, ErrorCode::data_corrupt);
    EXPECT_EQ(comparison.error().message,
              (folder_ / "new/r00/fr1_rpy/full/01234567/record.json").string() +
                  " is damaged: not JSON at byte 1 (zeros after a power cut?); run it again");
  }
}

TEST_F(ComparisonTest, ABaselineRunThatFailedWhenItWasMadeIsCompared) {
  RunRecord failed = good_record();
  failed.status = RunStatus::failed;
  failed.reason = "no space left";
  add("base", failed, "");
  add("new", good_record());
  ASSERT_NE(gate(compare(), "status"), nullptr);
  EXPECT_EQ(gate(compare(), "status")->verdict, GateVerdict::improvement);
}

TEST_F(ComparisonTest, RepetitionsThatDifferAreARegression) {
  add("base", good_record());
  add("new", good_record(), trajectory(), 0);
  RunRecord record = good_record();
  record.metrics.ate.value->stats.rmse *= 1 + 1e-15;
  add("new", record, trajectory(), 1);
  RunComparison comparison = compare();
  ASSERT_NE(gate(comparison, "repetitions"), nullptr);
  EXPECT_NE(gate(comparison, "repetitions")->message.find("repetitions of NEW differ: ate_rmse_m"),
            std::string::npos);
  add("new", good_record(), trajectory(3, 1e-9), 1);
  comparison = compare();
  ASSERT_NE(gate(comparison, "repetitions"), nullptr);
  EXPECT_NE(gate(comparison, "repetitions")->message.find("frame 3"), std::string::npos);
}

TEST_F(ComparisonTest, WhatOnlyMakesPosesWrongFails) {
  const auto with_truth = [](std::size_t silent, double nees, double final_m) {
    RunRecord record = good_record();
    RecordedSilentFailures failures;
    failures.failures.judged = kFrames;
    failures.failures.silent = silent;
    record.metrics.silent = {failures, {}};
    NeesResult pose;
    pose.part = kStateParts[5];
    pose.stats = statistics(std::vector<double>{nees});
    record.metrics.nees[5] = {pose, {}};
    record.final_metrics = record.metrics;
    record.final_metrics->ate.value->stats.rmse = final_m;
    return record;
  };
  add("base", with_truth(2, 1.2, 0.01));
  add("new", with_truth(6, 1.2, 0.01));
  EXPECT_EQ(gate(compare(), "silent_failures")->verdict, GateVerdict::regression);
  add("new", with_truth(2, 0.6, 0.01));
  EXPECT_EQ(gate(compare(), "nees_pose")->verdict, GateVerdict::changed);
  EXPECT_TRUE(gate(compare(), "nees_pose")->fails);
  EXPECT_EQ(gate(compare(), "silent_failures"), nullptr);
  add("new", with_truth(2, 1.2, 0.02));
  EXPECT_EQ(gate(compare(), "ate_revised_m")->verdict, GateVerdict::regression);
  EXPECT_EQ(gate(compare(), "ate_rmse_m"), nullptr);
  add("new", with_truth(2, 1.2, 0.01));
  EXPECT_TRUE(compare().passed());
}

TEST_F(ComparisonTest, ReplicatesWithOtherSeedsRaiseNoAlarmAndAWorseMethodDoes) {
  std::mt19937_64 generator(7);
  const auto add_side = [&](const std::string& side, double factor) {
    std::filesystem::remove_all(folder_ / side);
    for (int replicate = 0; replicate < 5; ++replicate) {
      RunRecord record = good_record();
      record.replicate = replicate;
      const double chance = 1 + 0.2 * static_cast<double>(generator() >> 11) * 0x1p-53;
      record.metrics.ate.value->stats.rmse *= factor * chance;
      record.metrics.aie.value->all.aie_grey *= factor * chance;
      record.model.vertices += generator() % 10;
      add(side, record, trajectory(3, 1e-3 * chance), replicate);
    }
  };
  add_side("base", 1);
  for (int i = 0; i < 20; ++i) {
    add_side("new", 1);
    const RunComparison comparison = compare();
    EXPECT_TRUE(comparison.passed()) << i;
    EXPECT_EQ(comparison.runs.size(), 1U);
  }
  add_side("new", 2);
  const RunComparison worse = compare();
  EXPECT_EQ(gate(worse, "ate_rmse_m")->verdict, GateVerdict::regression);
  EXPECT_NE(gate(worse, "ate_rmse_m")->message.find("ranges of replicates"), std::string::npos);
  add_side("new", 0.4);
  EXPECT_EQ(gate(compare(), "ate_rmse_m")->verdict, GateVerdict::improvement);
}

TEST_F(ComparisonTest, TooFewReplicatesAreComparedAsSingleRuns) {
  for (const char* side : {"base", "new"}) {
    for (int replicate = 0; replicate < 2; ++replicate) {
      RunRecord record = good_record();
      record.replicate = replicate;
      record.metrics.ate.value->stats.rmse *= 1 + 0.1 * replicate;
      add(side, record, trajectory(), replicate);
    }
  }
  EXPECT_TRUE(compare().passed());
  EXPECT_EQ(gate(compare(), "repetitions"), nullptr);  // replicates are none
}

TEST_F(ComparisonTest, AHundredComparisonsOfEqualRunsRaiseNoAlarm) {
  std::mt19937_64 generator(3);
  // A factor of a share around 1: what else runs on a machine is in the wall time.
  const auto noise = [&](double share) {
    return 1 + 2 * share * (static_cast<double>(generator() >> 11) * 0x1p-53 - 0.5);
  };
  const auto group = [&] {
    std::vector<FoundRun> repetitions;
    for (int i = 0; i < 7; ++i) {
      RunRecord record = good_record();
      record.timing.cpu_s *= noise(0.06);
      record.timing.wall_s *= noise(0.15);
      record.timing.peak_rss_bytes = static_cast<std::uint64_t>(3e8 * noise(0.02));
      repetitions.push_back({folder_ / fmt::format("{}", i), std::move(record)});
    }
    return repetitions;
  };
  for (int i = 0; i < 100; ++i) {
    const auto comparison = compare_runs(group(), group(), Gates()).value();
    EXPECT_TRUE(comparison.passed()) << comparison_text(comparison, false);
  }
}

TEST_F(ComparisonTest, SlowerRunsAreSuspectUntilARerunDecides) {
  add_timed("base", 7, 1.0, 1);
  add_timed("new", 7, 1.5, 2);
  RunComparison comparison = compare();
  EXPECT_EQ(comparison.failures(), 2U);
  ASSERT_NE(gate(comparison, "cpu_ms_per_frame"), nullptr);
  EXPECT_EQ(gate(comparison, "cpu_ms_per_frame")->verdict, GateVerdict::suspect);
  EXPECT_NE(gate(comparison, "cpu_ms_per_frame")->message.find("--confirm"), std::string::npos);
  EXPECT_EQ(gate(comparison, "wall_s")->verdict, GateVerdict::suspect);
  EXPECT_EQ(gate(comparison, "peak_rss_bytes"), nullptr);
  const std::string text = render_comparison(comparison, ComparisonFormat::table);
  EXPECT_NE(text.find("2 possible slowdowns in "), std::string::npos) << text;
  EXPECT_NE(text.find("POSSIBLE SLOWDOWN  "), std::string::npos) << text;
  add_timed("again", 7, 1.5, 3);
  comparison = compare({}, true);
  EXPECT_EQ(gate(comparison, "cpu_ms_per_frame")->verdict, GateVerdict::regression);
  add_timed("again", 7, 1.0, 4);
  comparison = compare({}, true);
  EXPECT_EQ(gate(comparison, "cpu_ms_per_frame")->verdict, GateVerdict::note);
  EXPECT_TRUE(comparison.passed());
}

TEST_F(ComparisonTest, TimesOfOtherMachinesAreNotGated) {
  add_timed("base", 7, 1.0, 1);
  for (int i = 0; i < 7; ++i) {
    RunRecord record = good_record();
    record.timing.cpu_s = 60 + i;
    record.provenance.cpu = "another";
    add("new", record, trajectory(), i);
  }
  const RunComparison comparison = compare();
  EXPECT_TRUE(comparison.passed());
  EXPECT_NE(gate(comparison, "cpu_ms_per_frame")->message.find("not gated: other CPU models"),
            std::string::npos);
}

TEST_F(ComparisonTest, NamesAreEscapedInEveryFormat) {
  const std::string name = R"(a<b>&"c"|`d`)";
  add("base", good_record());
  RunRecord record = good_record();
  record.status = RunStatus::lost;
  record.reason = "lost <at> \"frame\" & | more\n# EOF";
  add("new", record);
  auto base = *find_runs(folder_ / "base");
  auto fresh = *find_runs(folder_ / "new");
  for (auto* runs : {&base, &fresh}) runs->front().record.recording.name = name;
  const auto comparison = compare_runs(base, fresh, Gates()).value();
  const std::string xml = comparison_junit(comparison);
  EXPECT_NE(xml.find("classname=\"a&lt;b&gt;&amp;&quot;c&quot;|`d`/full\""), std::string::npos) << xml;
  EXPECT_NE(xml.find("lost &lt;at&gt; &quot;frame&quot; &amp; | more\\x0A# EOF"), std::string::npos) << xml;
  EXPECT_NE(xml.find("failures=\"1\""), std::string::npos);
  const std::string markdown = comparison_markdown(comparison, false);
  EXPECT_NE(markdown.find(R"(a&lt;b&gt;&amp;"c"\|\`d\`/full)"), std::string::npos) << markdown;
  EXPECT_NE(markdown.find("&amp; \\| more\\\\x0A# EOF"), std::string::npos) << markdown;
  const std::string metrics = comparison_openmetrics(comparison);
  EXPECT_NE(metrics.find(R"(fusebench_run_ok{recording="a<b>&\"c\"|`d`",variant="full",frames="0:20")"),
            std::string::npos)
      << metrics;
  EXPECT_TRUE(metrics.ends_with("# EOF\n"));
  EXPECT_EQ(metrics.find("# EOF"), metrics.size() - 6);
}

TEST_F(ComparisonTest, SeriesHaveTheNumbersOfNew) {
  add_timed("base", 2, 1.0, 1);
  add_timed("new", 2, 1.0, 2);
  const RunComparison comparison = compare();
  const auto gbench = nlohmann::json::parse(comparison_gbench(comparison));
  ASSERT_EQ(gbench.at("benchmarks").size(), 2U);
  EXPECT_EQ(gbench.at("benchmarks").at(1).at("name"), "fr1_rpy/full");
  EXPECT_EQ(gbench.at("benchmarks").at(1).at("repetition_index"), 1);
  EXPECT_NEAR(gbench.at("benchmarks").at(1).at("real_time").get<double>(), 10000, 400);
  const auto series = nlohmann::json::parse(comparison_github_benchmark(comparison));
  const auto named = [&](const std::string& key) {
    const auto found = std::ranges::find_if(
        series, [&](const auto& entry) { return entry.at("name") == "fr1_rpy/full: " + key; });
    return found == series.end() ? nlohmann::json() : *found;
  };
  EXPECT_EQ(named("ate_rmse_m").at("unit"), "m");
  EXPECT_EQ(named("frames_not_tracked").at("value"), 0);
  EXPECT_TRUE(named("wall_s").at("range").get<std::string>().starts_with("± "));
  EXPECT_TRUE(named("coverage").is_null());
  const std::string metrics = comparison_openmetrics(comparison);
  EXPECT_NE(metrics.find(
                "# TYPE fusebench_ate_rmse_m gauge\n# HELP fusebench_ate_rmse_m absolute trajectory error: "),
            std::string::npos);
  for (const ComparisonFormat format :
       {ComparisonFormat::table, ComparisonFormat::markdown, ComparisonFormat::json, ComparisonFormat::junit,
        ComparisonFormat::gbench, ComparisonFormat::github_benchmark, ComparisonFormat::openmetrics}) {
    const std::string text = render_comparison(comparison, format, true);
    EXPECT_EQ(text.find("nan"), std::string::npos) << text;
    EXPECT_EQ(text.find("inf"), std::string::npos) << text;
  }
  std::istringstream table(render_comparison(comparison, ComparisonFormat::table, true, 70));
  for (std::string line; std::getline(table, line);) {
    EXPECT_TRUE(line.size() <= 70 || line.find("  ") == std::string::npos) << line;
  }
}

TEST_F(ComparisonTest, JsonHasEveryGate) {
  const RunComparison comparison =
      compare_changed([](RunRecord& r) { r.metrics.ate.value->stats.rmse = 0.5; });
  const auto json = nlohmann::json::parse(comparison_json(comparison));
  EXPECT_EQ(json.at("passed"), false);
  EXPECT_EQ(json.at("regressions"), 1);
  const auto& gates = json.at("runs").at(0).at("gates");
  const auto ate = std::ranges::find_if(gates, [](const auto& g) { return g.at("gate") == "ate_rmse_m"; });
  ASSERT_NE(ate, gates.end());
  EXPECT_EQ(ate->at("new"), 0.5);
  EXPECT_EQ(ate->at("unit"), "m");
  EXPECT_EQ(ate->at("better"), "smaller");
  const auto base = ate->at("base").get<double>();
  EXPECT_DOUBLE_EQ(ate->at("tolerance").get<double>(), 1e-9 * base);
  EXPECT_DOUBLE_EQ(ate->at("ratio").get<double>(), 0.5 / base);
  const auto wall = std::ranges::find_if(gates, [](const auto& g) { return g.at("gate") == "wall_s"; });
  ASSERT_NE(wall, gates.end());
  EXPECT_DOUBLE_EQ(wall->at("tolerance").get<double>(), 2.5) << "factor 1.25 of 10 s";
  EXPECT_TRUE(json.at("runs").at(0).at("bit_identical").get<bool>());
  EXPECT_EQ(parse_comparison_format("pdf").error().code, ErrorCode::usage);
}

TEST_F(ComparisonTest, AnOverrideThatMeetsNoRunIsSaid) {
  const auto gates = parse_gates("[[overrides]]\nrecordings = [\"fr9_*\"]\nrelative = 0.1\n", "gates.toml");
  ASSERT_TRUE(gates.has_value());
  add("base", good_record());
  add("new", good_record());
  const RunComparison comparison = compare(*gates);
  ASSERT_EQ(comparison.notes.size(), 1U);
  EXPECT_EQ(comparison.notes[0], "gates.toml:1: this override is for none of the runs");
}

}  // namespace
}  // namespace fusebench
