// The engine over the five golden frames: order, isolation, sharing, and what is never done twice.
#include "eval/suites/engine/local_engine.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <utility>
#include <vector>

#include "core/base/io/staged_folder.hpp"
#include "eval/suites/engine/invocation.hpp"
#include "eval/suites/engine/plan_preview.hpp"
#include "eval/suites/engine/run_claim.hpp"
#include "eval/suites/engine/run_housekeeping.hpp"
#include "tests/datasets/images/child_process.hpp"
#include "tests/datasets/recording/formats/tum/tum_folder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace io;
using namespace record;
using namespace run;
using namespace suites;
using namespace engine;

namespace {

namespace fs = std::filesystem;

class LocalEngineTest : public testing::InTemporaryFolder {
 protected:
  /// Over two of the golden frames, with further lines of the suite.
  [[nodiscard]] BatchPlan plan(const std::string& lines = "") const {
    const fs::path data = folder_ / "data";
    if (!fs::exists(data)) {
      fs::create_directories(data);
      fs::copy(testing::golden_tum_folder(), data / "freiburg1_walk", fs::copy_options::recursive);
    }
    const fs::path file =
        write("suite.toml",
              "name = \"s\"\nrecordings = [\"freiburg1_walk\"]\nvariants = [\"no-imu\"]\nframes = \"0:2\"\n"
              "keep = \"small\"\n" +
                  lines);
    const auto suite = read_suite(file);
    EXPECT_TRUE(suite.has_value()) << suite.error().message;
    BatchOptions options;
    options.data = data;
    options.out = folder_ / "out";
    auto planned = plan_batch(*suite, options);
    EXPECT_TRUE(planned.has_value()) << planned.error().message;
    return std::move(*planned);
  }
};

// Two frames take 45 MB, starting and writing a record 15.
constexpr std::uint64_t kTooLittleMemory = 35'000'000;
constexpr const char* kThree = "[[sweep]]\niekf.max_iterations = [1, 2, 3]\n";

TEST_F(LocalEngineTest, OutcomesAreInTheOrderOfTheJobsAndTheSameForAnyNumberAtOnce) {
  const BatchPlan three = plan(kThree);
  const auto one = run_locally(three.jobs, {.at_once = 1});
  ASSERT_TRUE(one.has_value()) << one.error().message;
  ASSERT_EQ(one->size(), 3U);
  std::vector<std::string> trajectories;
  for (const BatchOutcome& outcome : *one) {
    EXPECT_EQ(outcome.status, RunStatus::ok) << outcome.reason;
    trajectories.push_back(testing::read_bytes(outcome.folder / "trajectory.tum"));
    EXPECT_FALSE(fs::exists(outcome.folder / "mesh.ply"));  // small
  }
  const auto three_at_once = run_locally(three.jobs, {.at_once = 3, .repeat_finished = true});
  ASSERT_TRUE(three_at_once.has_value());
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ((*three_at_once)[i].folder, (*one)[i].folder);
    EXPECT_EQ(testing::read_bytes((*one)[i].folder / "trajectory.tum"), trajectories[i]);
  }
}

TEST_F(LocalEngineTest, RepetitionsHaveFoldersOfTheirOwn) {
  const BatchPlan repeated = plan("repetitions = 2\n");
  const auto outcomes = run_locally(repeated.jobs, {});
  ASSERT_TRUE(outcomes.has_value());
  ASSERT_EQ(outcomes->size(), 2U);
  EXPECT_EQ((*outcomes)[1].folder.string(), (*outcomes)[0].folder.string() + "-r2");
  EXPECT_EQ(testing::read_bytes((*outcomes)[0].folder / "trajectory.tum"),
            testing::read_bytes((*outcomes)[1].folder / "trajectory.tum"));
}

TEST_F(LocalEngineTest, ARunWithoutMemoryIsARowAndTheOthersGoOn) {
  if (!testing::kMemoryIsMeasured) GTEST_SKIP() << "a sanitizer ends a program that is out of memory itself";
  BatchPlan two = plan("[[sweep]]\niekf.max_iterations = [1, 2]\n");
  EngineOptions options;
  options.limits.memory_bytes = kTooLittleMemory;
  const auto starved = run_locally(two.jobs, options);
  ASSERT_TRUE(starved.has_value()) << starved.error().message;
  for (const BatchOutcome& outcome : *starved) {
    EXPECT_EQ(outcome.status, RunStatus::failed);
    EXPECT_NE(outcome.reason.find("memory"), std::string::npos) << outcome.reason;
    const auto record = read_record(outcome.folder / "record.json");
    ASSERT_TRUE(record.has_value()) << record.error().message;
    EXPECT_EQ(record->reason, outcome.reason);
    EXPECT_TRUE(
        testing::read_bytes(outcome.folder / "log.txt").ends_with("failed: " + outcome.reason + "\n"));
  }
  EXPECT_EQ(preview_of(two).failed, 2U);
  // Failed runs are tried again, and give way to good ones.
  const auto fed = run_locally(two.jobs, {});
  for (const BatchOutcome& outcome : *fed) EXPECT_EQ(outcome.status, RunStatus::ok) << outcome.reason;
}

TEST_F(LocalEngineTest, ImagesThatChangeDuringASweepEndRunsAsFailedAndAreRunAgain) {
  const BatchPlan three = plan(kThree);
  const fs::path image = folder_ / "data" / "freiburg1_walk" / "rgb";
  EngineControl control;
  control.finished = [&](std::size_t index, const BatchOutcome&) {
    if (index != 0) return;  // the recording has been opened, and other runs are to follow
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(image)) files.push_back(entry.path());
    std::ranges::sort(files);
    fs::copy_file(files[2], files[1], fs::copy_options::overwrite_existing);
  };
  const auto during = run_locally(three.jobs, {.at_once = 1}, control);
  ASSERT_TRUE(during.has_value()) << during.error().message;
  EXPECT_EQ((*during)[0].status, RunStatus::ok) << (*during)[0].reason;
  for (std::size_t i = 1; i < 3; ++i) {
    EXPECT_EQ((*during)[i].status, RunStatus::failed);
    EXPECT_NE((*during)[i].reason.find(".png: has changed since the recording was opened"), std::string::npos)
        << (*during)[i].reason;
  }
  const auto after = run_locally(three.jobs, {});
  ASSERT_TRUE(after.has_value()) << after.error().message;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ((*after)[i].status, RunStatus::ok) << (*after)[i].reason;
    EXPECT_FALSE((*after)[i].resumed) << "of other images, so another run";
    EXPECT_NE((*after)[i].folder, (*during)[i].folder);
  }
}

TEST_F(LocalEngineTest, ARecordingIsOpenedOnceForAllItsWindows) {
  BatchPlan planned = plan();
  planned.jobs.push_back(planned.jobs[0]);
  planned.jobs.back().spec.frames = FrameWindow{2, 4};
  EngineControl control;
  control.finished = [&](std::size_t index, const BatchOutcome&) {
    if (index == 0) fs::remove(folder_ / "data" / "freiburg1_walk" / "rgb.txt");
  };
  const auto outcomes = run_locally(planned.jobs, {}, control);
  ASSERT_TRUE(outcomes.has_value());
  for (const BatchOutcome& outcome : *outcomes) EXPECT_EQ(outcome.status, RunStatus::ok) << outcome.reason;
}

TEST_F(LocalEngineTest, APlanOfTooManyRunsIsRefusedBeforeItIsMade) {
  const fs::path file =
      write("many.toml",
            "name = \"many\"\nrecordings = [\"freiburg1_walk\"]\nvariants = [\"full\", \"dm\"]\n"
            "repetitions = 100\n[[sweep]]\niekf.max_iterations = [1, 2, 3, 4, 5, 6]\n"
            "[[sweep]]\ndesign = \"random\"\nsamples = 90\n"
            "tsdf.voxel_m = { from = 0.01, to = 0.02 }\n");
  static_cast<void>(plan());  // makes the recording
  BatchOptions options;
  options.data = folder_ / "data";
  const auto refused = plan_batch(*read_suite(file), options);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::configuration);
  EXPECT_EQ(refused.error().message, "suite 'many' has 108000 runs (allowed: up to 100000)");
}

TEST_F(LocalEngineTest, OnlyFailedRunsLeavesTheRestAlone) {
  const BatchPlan three = plan(kThree);
  const std::vector<BatchJob> first(three.jobs.begin(), three.jobs.begin() + 1);
  ASSERT_TRUE(run_locally(first, {}).has_value());
  const std::vector<BatchJob> second(three.jobs.begin() + 1, three.jobs.begin() + 2);
  EngineOptions starving;
  starving.limits.memory_bytes = kTooLittleMemory;
  ASSERT_TRUE(run_locally(second, starving).has_value());
  const auto again = run_locally(three.jobs, {.only_failed = true});
  ASSERT_TRUE(again.has_value());
  EXPECT_TRUE((*again)[0].resumed);
  EXPECT_FALSE((*again)[1].resumed);
  EXPECT_EQ((*again)[1].status, RunStatus::ok);
  EXPECT_TRUE((*again)[2].skipped);
  EXPECT_EQ(list_runs(folder_ / "out")->size(), 2U);
}

TEST_F(LocalEngineTest, AStopLeavesNothingHalf) {
  std::atomic<bool> stop = false;
  const BatchPlan three = plan(kThree);
  EngineControl control;
  control.stop = &stop;
  control.finished = [&](std::size_t, const BatchOutcome&) { stop = true; };
  const auto stopped = run_locally(three.jobs, {}, control);
  ASSERT_FALSE(stopped.has_value());
  EXPECT_NE(stopped.error().message.find("1 of 3 runs are finished"), std::string::npos)
      << stopped.error().message;
  EXPECT_EQ(list_runs(folder_ / "out")->size(), 1U);
  const auto gone_on = run_locally(three.jobs, {});
  ASSERT_TRUE(gone_on.has_value());
  EXPECT_TRUE((*gone_on)[0].resumed);
  EXPECT_FALSE((*gone_on)[2].resumed);
}

TEST_F(LocalEngineTest, WhatAnotherEngineWorksOnIsWaitedFor) {
  const BatchPlan one = plan();
  const PreparedRun run = *prepare_run(one.jobs[0].spec);
  auto claim = RunClaim::take(folder_ / "out", run.run_id + "-1");
  ASSERT_TRUE(claim.has_value() && claim->has_value());
  EXPECT_FALSE(RunClaim::take(folder_ / "out", run.run_id + "-1")->has_value());
  std::size_t looks = 0;
  EngineControl control;
  control.progress = [&](const EngineState& state) {
    EXPECT_TRUE(state.running.empty() || looks >= 3);
    if (++looks == 3) claim->reset();
  };
  const auto outcomes = run_locally(one.jobs, {}, control);
  ASSERT_TRUE(outcomes.has_value());
  EXPECT_GE(looks, 3U);
  EXPECT_EQ(outcomes->front().status, RunStatus::ok);
}

TEST_F(LocalEngineTest, AnUnwritableFolderEndsItAtOnce) {
  write("out", "a file where the folder should be");
  const BatchPlan one = plan();
  const auto outcomes = run_locally(one.jobs, {});
  ASSERT_FALSE(outcomes.has_value());
  EXPECT_EQ(outcomes.error().code, ErrorCode::io);
  EXPECT_NE(outcomes.error().message.find("0 of 1 runs are finished"), std::string::npos);
}

TEST_F(LocalEngineTest, ExclusionsHaveReasons) {
  const BatchPlan planned =
      plan(std::string(kThree) + "[[exclude]]\nreason = \"too few\"\niekf.max_iterations = 1\n");
  EXPECT_EQ(planned.jobs.size(), 2U);
  ASSERT_EQ(planned.excluded.size(), 1U);
  EXPECT_EQ(planned.excluded[0].reason, "too few");
  const std::string text = to_text(preview_of(planned), planned, 2);
  EXPECT_NE(text.find("too few"), std::string::npos);
  EXPECT_NE(text.find("2 runs: 0 finished, 0 failed before, 2 to do, 0 unknown; 1 excluded"),
            std::string::npos)
      << text;
}

TEST_F(LocalEngineTest, NoTimeIsPromisedWhereNoRecordingIsThere) {
  PlanPreview preview;
  preview.runs = {{"a full", JobState::unknown, "its recording will be simulated first", 0}};
  preview.unknown = 1;
  const std::string text = to_text(preview, {}, 2);
  EXPECT_EQ(text.find("about 0 s"), std::string::npos) << text;
  EXPECT_NE(text.find("is known when their recordings are there"), std::string::npos) << text;
}

TEST_F(LocalEngineTest, NamesHowManyRunsTheEstimateExcludes) {
  PlanPreview preview;
  preview.runs = {{"a full", JobState::waiting, "", 0},
                  {"b full", JobState::unknown, "its recording will be simulated first", 0}};
  preview.waiting = 1;
  preview.unknown = 1;
  preview.time_s = 60;
  const std::string text = to_text(preview, {}, 2);
  EXPECT_NE(text.find("; the estimate excludes 1 run\n"), std::string::npos) << text;
}

TEST_F(LocalEngineTest, WindowsThatAreNotThereAreRowsOfTheirOwn) {
  BatchPlan planned = plan();
  const BatchJob first = planned.jobs[0];
  for (const FrameWindow window : {FrameWindow{2, 10}, FrameWindow{5, 8}}) {
    planned.jobs.push_back(first);
    planned.jobs.back().spec.frames = window;
  }
  const auto outcomes = run_locally(planned.jobs, {});
  ASSERT_TRUE(outcomes.has_value()) << outcomes.error().message;
  EXPECT_EQ((*outcomes)[0].status, RunStatus::ok);
  EXPECT_NE((*outcomes)[1].folder, (*outcomes)[2].folder);
  EXPECT_EQ(list_runs(folder_ / "out")->size(), 3U);
  EXPECT_EQ(preview_of(planned).failed, 2U);
  // Once it is there, its row that said otherwise is gone, and the other one stays.
  planned.jobs[1].spec.frames = FrameWindow{2, 10};
  const auto again = run_locally(planned.jobs, {.only_failed = true});
  ASSERT_TRUE(again.has_value());
  EXPECT_TRUE((*again)[0].skipped);
  EXPECT_FALSE((*again)[1].skipped);
  EXPECT_EQ(list_runs(folder_ / "out")->size(), 3U);
}

TEST_F(LocalEngineTest, FilesThatWereNotKeptAreMadeWhenTheyAreAskedFor) {
  BatchPlan one = plan();
  const auto small = run_locally(one.jobs, {});
  ASSERT_TRUE(small.has_value());
  one.jobs[0].spec.kept = KeptFiles::all;
  const auto all = run_locally(one.jobs, {});
  ASSERT_TRUE(all.has_value());
  EXPECT_FALSE(all->front().resumed);
  EXPECT_EQ(all->front().folder, small->front().folder);
  EXPECT_TRUE(fs::exists(all->front().folder / "mesh.ply"));
  one.jobs[0].spec.kept = KeptFiles::small;
  EXPECT_TRUE(run_locally(one.jobs, {})->front().resumed);  // more than what is asked for
}

TEST_F(LocalEngineTest, AProfileIsMadeWhenItIsAskedFor) {
  BatchPlan one = plan();
  const auto plain = run_locally(one.jobs, {});
  ASSERT_TRUE(plain.has_value());
  EXPECT_FALSE(fs::exists(plain->front().folder / "trace.json"));
  one.jobs[0].spec.profile = true;
  EXPECT_EQ(preview_of(one).finished, 0U);
  const auto profiled = run_locally(one.jobs, {});
  ASSERT_TRUE(profiled.has_value());
  EXPECT_FALSE(profiled->front().resumed);
  EXPECT_EQ(profiled->front().folder, plain->front().folder);
  EXPECT_TRUE(fs::exists(profiled->front().folder / "trace.json"));
  EXPECT_TRUE(run_locally(one.jobs, {})->front().resumed);
  one.jobs[0].spec.profile = false;
  EXPECT_TRUE(run_locally(one.jobs, {})->front().resumed);  // more than what is asked for
}

TEST_F(LocalEngineTest, DamagedRunsAreGarbageIfFailedOnesAre) {
  write("out/r/full/00000000/record.json", "{ half of a rec");
  // Neither a run of another version nor what is not named as a run is: what it is, nobody knows.
  write("out/r/full/00000001/record.json", "{\"schema\": 99}");
  write("out/r/full/notes/record.json", "my own record");
  const auto listed = list_runs(folder_ / "out");
  ASSERT_TRUE(listed.has_value());
  ASSERT_EQ(listed->size(), 3U);
  EXPECT_EQ(listed->front().head.status, RunStatus::failed);
  EXPECT_EQ(listed->front().head.reason, "record.json is damaged: not JSON at byte 3; run it again");
  EXPECT_EQ(collect_garbage(folder_ / "out", {.stale = true})->runs, 0U);
  const auto seen = collect_garbage(folder_ / "out", {.failed = true, .stale = true, .only_look = true});
  EXPECT_EQ(seen->paths, std::vector{folder_ / "out/r/full/00000000"});
  EXPECT_TRUE(fs::exists(folder_ / "out/r/full/00000000/record.json"));
  const auto report = collect_garbage(folder_ / "out", {.failed = true, .stale = true, .only_look = false});
  EXPECT_EQ(report->runs, 1U);
  EXPECT_EQ(report->paths, seen->paths);
  EXPECT_FALSE(fs::exists(folder_ / "out/r/full/00000000"));
  EXPECT_TRUE(fs::exists(folder_ / "out/r/full/00000001/record.json"));
  EXPECT_TRUE(fs::exists(folder_ / "out/r/full/notes/record.json"));
}

TEST_F(LocalEngineTest, ADamagedRunIsRunAgain) {
  BatchPlan one = plan();
  one.jobs[0].spec.kept = KeptFiles::all;
  const auto first = run_locally(one.jobs, {});
  ASSERT_TRUE(first.has_value()) << first.error().message;
  const fs::path run = first->front().folder;
  const std::string record = testing::read_bytes(run / "record.json");
  const std::string mesh = testing::read_bytes(run / "mesh.ply");
  ASSERT_GT(record.size(), 8192U);
  const std::string zeroed = record.substr(0, 4096) + std::string(record.size() - 4096, '\0');
  const std::vector<std::pair<std::string, std::string>> damages = {
      {"record.json", zeroed},  {"record.json", record.substr(0, 4096)},
      {"record.json", ""},      {"mesh.ply", ""},
      {"trajectory.tum", ""},   {"frames.csv", "frame\n"},
      {"intensity.bin", "FBIN"}};
  for (const auto& [name, content] : damages) {
    for (const bool only_failed : {false, true}) {
      std::ofstream(run / name, std::ios::binary | std::ios::trunc) << content;
      ASSERT_EQ(preview_of(one).finished, 0U) << name;
      const auto listed = list_runs(folder_ / "out");
      EXPECT_EQ(listed->front().head.status, RunStatus::failed) << name;
      EXPECT_TRUE(listed->front().head.reason.starts_with(name + " is damaged: "))
          << listed->front().head.reason;
      const auto again = run_locally(one.jobs, {.only_failed = only_failed});
      ASSERT_TRUE(again.has_value());
      EXPECT_FALSE(again->front().resumed) << name;
      EXPECT_EQ(again->front().folder, run);
      EXPECT_EQ(testing::read_bytes(run / "mesh.ply"), mesh);
    }
  }
  fs::remove(run / "mesh.ply");
  EXPECT_FALSE(run_locally(one.jobs, {})->front().resumed);
  EXPECT_TRUE(run_locally(one.jobs, {})->front().resumed);
  // Whoever keeps less needs no more.
  fs::remove(run / "mesh.ply");
  one.jobs[0].spec.kept = KeptFiles::small;
  EXPECT_TRUE(run_locally(one.jobs, {})->front().resumed);
}

TEST_F(LocalEngineTest, ARunOfBeforeFilesWereRecordedIsFinished) {
  const BatchPlan one = plan();
  const auto first = run_locally(one.jobs, {});
  ASSERT_TRUE(first.has_value());
  auto record = read_record(first->front().folder / "record.json");
  ASSERT_TRUE(record.has_value());
  EXPECT_FALSE(record->files.empty());
  EXPECT_FALSE(record->timing.files.empty());
  record->files.clear();
  record->timing.files.clear();
  std::string older = to_json(*record);
  const std::string empty = "  \"files\": {},\n";
  ASSERT_NE(older.find(empty), std::string::npos);
  older.erase(older.find(empty), empty.size());
  std::ofstream(first->front().folder / "record.json", std::ios::trunc) << older;
  EXPECT_TRUE(run_locally(one.jobs, {})->front().resumed);
}

TEST_F(LocalEngineTest, OnlyItsOwnFoldersAreTidied) {
  EXPECT_EQ(collect_garbage(folder_, {}).error().code, ErrorCode::data_missing);
  write(".notes.tmp/f", "mine");
  EXPECT_EQ(collect_garbage(folder_, {}).error().code, ErrorCode::data_missing);
  EXPECT_TRUE(fs::exists(folder_ / ".notes.tmp/f"));
  const std::string failed = to_json(RunRecord{});
  RunRecord good;
  good.status = RunStatus::ok;
  for (const char* recording : {".rec1", ".rec1.tmp", "rec1"})
    write(std::string("out/") + recording + "/full/01234567/record.json", to_json(good));
  write("out/rec1/full/.01234567.77.tmp/old/record.json", failed);
  write("out/rec1/.notes.tmp/f", "mine");
  write("out/.fusebench/claims/notes", "mine");
  const std::string claim = std::string(32, 'a') + "-1";
  write("out/.fusebench/claims/" + claim, "");
  EXPECT_EQ(list_runs(folder_ / "out")->size(), 3U);
  const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(2);
  const std::vector<fs::path> files = {write("out/.fusebench/invocations/.0123abcd.json.77.tmp", "half"),
                                       write("out/rec1/.table.csv.77.tmp", "half")};
  for (const fs::path& file : files) fs::last_write_time(file, long_ago);
  write("out/rec1/.other.csv.78.tmp", "being written");
  const auto report = collect_garbage(folder_ / "out", {.failed = true});
  ASSERT_TRUE(report.has_value());
  const std::vector<fs::path> expected = {folder_ / "out/.fusebench/claims" / claim, files[0], files[1],
                                          folder_ / "out/rec1/full/.01234567.77.tmp"};
  EXPECT_EQ(report->paths, expected);
  EXPECT_EQ(report->temporaries, 4U);
  EXPECT_TRUE(fs::exists(folder_ / "out/rec1/.other.csv.78.tmp"));
  EXPECT_EQ(list_runs(folder_ / "out")->size(), 3U);
  EXPECT_TRUE(fs::exists(folder_ / "out/rec1/.notes.tmp/f"));
  EXPECT_TRUE(fs::exists(folder_ / "out/.fusebench/claims/notes"));
}

TEST_F(LocalEngineTest, DamagedRunsAreNotMergedAndGiveWay) {
  const BatchPlan one = plan();
  ASSERT_TRUE(run_locally(one.jobs, {}).has_value());
  ASSERT_EQ(merge_runs(folder_ / "out", folder_ / "all")->copied, 1U);
  const fs::path place = folder_ / "all" / list_runs(folder_ / "all")->front().folder;
  std::ofstream(place / "record.json", std::ios::trunc) << "{";
  const auto kept = merge_runs(folder_ / "all", folder_ / "out");
  EXPECT_EQ(kept->damaged, 1U);
  EXPECT_EQ(kept->copied, 0U);
  EXPECT_EQ(merge_runs(folder_ / "out", folder_ / "all")->copied, 1U);
  EXPECT_EQ(list_runs(folder_ / "all")->size(), 1U);
  EXPECT_EQ(list_runs(folder_ / "all")->front().head.status, RunStatus::ok);
}

TEST_F(LocalEngineTest, RunsWithLinksAreNotMerged) {
  const BatchPlan one = plan();
  ASSERT_TRUE(run_locally(one.jobs, {}).has_value());
  const fs::path place = folder_ / "out" / list_runs(folder_ / "out")->front().folder;
  fs::remove(place / "log.txt");
  for (const fs::path& target : {fs::path("/dev/zero"), write("elsewhere.txt", "not of this run")}) {
    fs::create_symlink(target, place / "log.txt");
    const auto merged = merge_runs(folder_ / "out", folder_ / "all");
    ASSERT_TRUE(merged.has_value()) << merged.error().message;
    EXPECT_EQ(merged->damaged, 1U);
    EXPECT_EQ(merged->copied, 0U);
    EXPECT_FALSE(fs::exists(folder_ / "all"));
    fs::remove(place / "log.txt");
  }
}

TEST_F(LocalEngineTest, FoldersAreMergedAndTidied) {
  const BatchPlan three = plan(kThree);
  ASSERT_TRUE(run_locally(three.jobs, {}).has_value());
  const auto first = merge_runs(folder_ / "out", folder_ / "all");
  ASSERT_TRUE(first.has_value()) << first.error().message;
  EXPECT_EQ(first->copied, 3U);
  const auto second = merge_runs(folder_ / "out", folder_ / "all");
  EXPECT_EQ(second->there, 3U);
  EXPECT_EQ(second->differing, 0U);
  const auto before = list_runs(folder_ / "out");
  const auto after = list_runs(folder_ / "all");
  ASSERT_EQ(after->size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ((*after)[i].folder, (*before)[i].folder);
  // What a killed process left, and what a living one works on.
  const fs::path place = folder_ / "all" / "freiburg1_walk" / "no-imu";
  fs::create_directories(place / ".dead.77.tmp" / "new");
  const auto living = StagedFolder::create(place / "living");
  ASSERT_TRUE(living.has_value());
  const auto report = collect_garbage(folder_ / "all", {});
  ASSERT_TRUE(report.has_value());
  EXPECT_EQ(report->temporaries, 1U);
  EXPECT_FALSE(fs::exists(place / ".dead.77.tmp"));
  EXPECT_TRUE(fs::exists(living->path()));
}

TEST_F(LocalEngineTest, InvocationsComeBackAsTheyWere) {
  const fs::path suite = write("mine.toml", "name = \"m\"\nall = true\nvariants = [\"full\"]\n");
  Invocation invocation{suite, {}, {3, 5, "small"}};
  invocation.options.out = folder_ / "out";
  invocation.options.data = folder_ / "data";
  invocation.options.sets = {"iekf.max_iterations=1,2"};
  invocation.options.profile = true;
  const auto file = keep(invocation);
  ASSERT_TRUE(file.has_value()) << file.error().message;
  EXPECT_EQ(*keep(invocation), *file);
  EXPECT_EQ(kept_invocations(folder_ / "out")->size(), 1U);
  const auto back = read_invocation(*file);
  ASSERT_TRUE(back.has_value()) << back.error().message;
  EXPECT_EQ(back->options.sets, invocation.options.sets);
  EXPECT_EQ(back->options.data, folder_ / "data");
  EXPECT_TRUE(back->options.profile);
  EXPECT_EQ(back->overrides.repetitions, 3);
  const auto read = suite_of(*back);
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->kept, KeptFiles::small);
  EXPECT_EQ(read->repetitions, 3);
  EXPECT_EQ(read->replicates, 5);
}

TEST_F(LocalEngineTest, InvocationsHaveNumbersInTheirRange) {
  const auto message = [&](const std::string& threads, const std::string& repetitions) {
    const std::string text = R"({"data": "", "simulated": "", "threads": )" + threads +
                             R"(, "sets": [], "only": [], "repetitions": )" + repetitions +
                             R"(, "keep": "", "working_folder": ""})";
    const auto read = read_invocation(write("out/.fusebench/invocations/0123abcd.json", text));
    return read ? std::string("was not refused") : read.error().message;
  };
  EXPECT_EQ(message("1024", "0"), "was not refused");
  // As an int it would be 0.
  EXPECT_NE(message("4294967296", "0").find("threads = 4294967296 (allowed: an integer, 1 .. 1024)"),
            std::string::npos);
  EXPECT_NE(message("18446744073709551615", "0").find("threads = 18446744073709551615"), std::string::npos);
  EXPECT_NE(message("0", "0").find("threads = 0"), std::string::npos);
  EXPECT_NE(message("1.5", "0").find("threads = 1.5"), std::string::npos);
  EXPECT_NE(message("1", "-1").find("repetitions = -1 (allowed: an integer, 0 .. 1000)"), std::string::npos);
}

TEST_F(LocalEngineTest, DamagedInvocationsAreNotCopied) {
  const fs::path suite = write("mine.toml", "name = \"m\"\nall = true\nvariants = [\"full\"]\n");
  Invocation invocation{suite, {}, {}};
  invocation.options.out = folder_ / "out";
  const auto file = keep(invocation);
  ASSERT_TRUE(file.has_value()) << file.error().message;
  write("out/.fusebench/invocations/0123abcd.json", "{\"threads\": nan}");
  write("out/.fusebench/invocations/0123abcd.toml", "name = \"m\"\n");
  EXPECT_EQ(copy_invocations(folder_ / "out", folder_ / "into"), 1U);
  const auto copied = kept_invocations(folder_ / "into");
  ASSERT_TRUE(copied.has_value()) << copied.error().message;
  ASSERT_EQ(copied->size(), 1U);
  EXPECT_EQ(copied->front().filename(), file->filename());
  EXPECT_TRUE(fs::exists(read_invocation(copied->front())->suite));
}

}  // namespace
}  // namespace fusebench
