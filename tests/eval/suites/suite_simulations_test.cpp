#include "eval/suites/suite_simulations.hpp"

#include <gtest/gtest.h>

#include "eval/suites/engine/job_plan.hpp"
#include "eval/suites/engine/simulated_recordings.hpp"
#include "eval/suites/suite_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace simulator::motion;
using namespace simulator::layouts;
using namespace record;
using namespace suites;
using namespace engine;

namespace {

class SuiteSimulationsTest : public testing::InTemporaryFolder {
 protected:
  /// A suite with these tables after its first three lines; the tables begin at line 4.
  Result<Suite> read(const std::string& tables) {
    return read_suite(
        write("suite.toml", "name = \"s\"\nvariants = [\"full\", \"dm\"]\nimu = \"auto\"\n" + tables));
  }
  void expect_refused(const std::string& tables, const std::string& place, const std::string& part) {
    const auto suite = read(tables);
    ASSERT_FALSE(suite.has_value()) << tables;
    EXPECT_EQ(suite.error().code, ErrorCode::configuration);
    EXPECT_NE(suite.error().message.find("suite.toml" + place), std::string::npos) << suite.error().message;
    EXPECT_NE(suite.error().message.find(part), std::string::npos) << suite.error().message;
  }
};

constexpr const char* kLists =
    "[[simulations]]\nname = \"zr300_{preset}_{start}_{seed}\"\npreset = [\"slow\", \"shake\"]\n"
    "start = [\"rest\", \"motion\"]\nseed = [1, 2]\ntuning_seeds = [1]\nduration_s = 5\n";

TEST_F(SuiteSimulationsTest, ListsAreMultipliedOutInTheOrderOfTheFile) {
  const auto suite = read(kLists);
  ASSERT_TRUE(suite.has_value()) << suite.error().message;
  std::vector<std::string> names;
  for (const SuiteSimulation& simulation : suite->simulations) names.push_back(simulation.name);
  EXPECT_EQ(names,
            (std::vector<std::string>{"zr300_slow_rest_1", "zr300_slow_rest_2", "zr300_slow_motion_1",
                                      "zr300_slow_motion_2", "zr300_shake_rest_1", "zr300_shake_rest_2",
                                      "zr300_shake_motion_1", "zr300_shake_motion_2"}));
  const SuiteSimulation& last = suite->simulations.back();
  EXPECT_EQ(last.group, "shake");
  EXPECT_EQ(last.split, "held-out");
  EXPECT_EQ(suite->simulations[6].split, "tuning");
  EXPECT_EQ(last.variants, suite->variants);
  EXPECT_EQ(last.request.layout, RecordingLayout::zr300);
  EXPECT_EQ(last.request.preset, MotionPreset::shake);
  EXPECT_EQ(last.request.seed, 2U);
  EXPECT_DOUBLE_EQ(last.request.duration_s.value_or(0), 5);
  EXPECT_EQ(last.request.from_rest, false);
}

TEST_F(SuiteSimulationsTest, ASecondDeclarationAddsVariants) {
  const auto suite = read(std::string(kLists) +
                          "[[simulations]]\nname = \"zr300_{preset}_{start}_{seed}\"\npreset = \"slow\"\n"
                          "start = \"motion\"\nseed = [1]\ntuning_seeds = [1]\nduration_s = 5\n"
                          "variants = [\"dm\", \"planar\"]\n");
  ASSERT_TRUE(suite.has_value()) << suite.error().message;
  ASSERT_EQ(suite->simulations.size(), 8U);
  EXPECT_EQ(suite->simulations[2].variants, (std::vector<std::string>{"full", "dm", "planar"}));
  EXPECT_EQ(suite->simulations[3].variants, (std::vector<std::string>{"full", "dm"}));
}

TEST_F(SuiteSimulationsTest, RealisticSensorsForPresetsAndTrajectories) {
  const auto suite = read(
      "[[simulations]]\nname = \"{preset}\"\npreset = [\"realistic_turns\", \"slow\"]\n"
      "[[simulations]]\nname = \"twin\"\ngroup = \"twins\"\ntrajectory = \"a.txt\"\nskip_s = 0.5\n"
      "realistic = true\nexposure_s = 0.01\n");
  ASSERT_TRUE(suite.has_value()) << suite.error().message;
  const auto turns = simulation_options(suite->simulations[0].request);
  const auto slow = simulation_options(suite->simulations[1].request);
  const auto twin = simulation_options(suite->simulations[2].request);
  ASSERT_TRUE(turns && slow && twin);
  EXPECT_EQ(turns->duration_s, 60);
  EXPECT_TRUE(turns->auto_exposure.on && turns->untold_shutters);
  EXPECT_EQ(slow->duration_s, 10);
  EXPECT_FALSE(slow->auto_exposure.on || slow->untold_shutters || slow->stamps.any());
  EXPECT_EQ(twin->duration_s, 10);
  EXPECT_EQ(twin->file_motion.skip_s, 0.5);
  EXPECT_TRUE(twin->untold_shutters && twin->depth_errors.any());
  EXPECT_FALSE(twin->auto_exposure.on);  // what is asked for counts
  EXPECT_EQ(twin->exposure_s, 0.01);
}

TEST_F(SuiteSimulationsTest, RoutesBringTheirScenesAndDurations) {
  const auto suite = read(
      "[[simulations]]\nname = \"{preset}\"\npreset = [\"loop_room\", \"loop_flat\"]\nrealistic = true\n"
      "[[simulations]]\nname = \"{preset}_{exposure_s}s\"\npreset = \"shake_revisit\"\nrealistic = true\n"
      "exposure_s = [0.008, 0.030]\n");
  ASSERT_TRUE(suite.has_value()) << suite.error().message;
  const auto room = simulation_options(suite->simulations[0].request);
  const auto flat = simulation_options(suite->simulations[1].request);
  ASSERT_TRUE(room && flat);
  EXPECT_EQ(room->room, simulator::RoomKind::furnished);
  EXPECT_EQ(room->duration_s, usual_duration_s(MotionPreset::loop_room));
  EXPECT_TRUE(room->auto_exposure.on && room->blur_samples == 0);
  EXPECT_EQ(flat->room, simulator::RoomKind::flat);
  EXPECT_EQ(flat->duration_s, 120);
  EXPECT_EQ(suite->simulations[3].name, "shake_revisit_0.03s");
  for (const std::size_t i : {2, 3}) {  // 8 ms as well, which is usual without realistic sensors
    const auto shaken = simulation_options(suite->simulations[i].request);
    ASSERT_TRUE(shaken);
    EXPECT_FALSE(shaken->auto_exposure.on);
    EXPECT_EQ(shaken->exposure_s, i == 2 ? 0.008 : 0.03);
    EXPECT_TRUE(shaken->blur_samples == 0 && shaken->untold_shutters);
  }
}

TEST_F(SuiteSimulationsTest, WhatMakesNoSenseIsRefusedWithItsLine) {
  const std::string head = "[[simulations]]\nname = \"a_{seed}\"\n";
  expect_refused(head + "preset = \"quick\"\nseed = 1\n", ":6", "slow | fast | shake");
  expect_refused(head + "preset = \"slow\"\nseeds = 1\n", ":7", "nearest: seed");
  expect_refused(head + "preset = \"slow\"\nseed = -1\n", ":7", "0 or more");
  expect_refused(head + "preset = \"slow\"\nseed = []\n", ":7", "not empty");
  expect_refused(head + "preset = \"slow\"\n", ":5", "{seed}");
  expect_refused(head + "seed = 1\n", ":4", "either 'preset' or 'trajectory'");
  expect_refused(head + "trajectory = \"path.txt\"\nseed = 1\n", ":4", "group");
  expect_refused(head + "preset = \"slow\"\nspeed = 2\nseed = 1\n", ":4", "trajectory");
  expect_refused(head + "preset = \"slow\"\nseed = 1\nsize = \"wide\"\n", ":8", "WIDTHxHEIGHT");
  expect_refused(head + "preset = \"slow\"\nseed = [1, 1]\n", ":4", "made twice");
  expect_refused(head + "preset = [\"slow\", \"fast\"]\nseed = 1\n", ":4", "declared twice");
  expect_refused("[[simulations]]\nname = \"../{seed}\"\npreset = \"slow\"\nseed = 1\n", ":5", "no name");
  expect_refused("[[simulations]]\npreset = \"slow\"\n", ":4", "'name' is missing");
  expect_refused("[[simulation]]\nname = \"a\"\n", ":4", "nearest: simulations");
  expect_refused("[simulations]\nname = \"a\"\n", ":4", "write [[simulations]]");
  expect_refused(std::string(kLists) +
                     "[[criteria]]\ntitle = \"t\"\ngroups = [\"slwo\"]\nvariant = \"full\"\n"
                     "metric = \"fps\"\nstatistic = \"mean\"\nat_least = 1\n",
                 ":11", "nearest: slow");
  expect_refused("[[recordings]]\nname = \"a\"\nsplit = \"left\"\n", ":6", "held-out");
  expect_refused("[[recordings]]\nname = \"a\"\nvariants = [\"ful\"]\n", ":6", "full");
}

TEST_F(SuiteSimulationsTest, ARecordingHasAllFaultsOfTheList) {
  const std::string head = "[[simulations]]\nname = \"a_{preset}\"\npreset = [\"slow\", \"fast\"]\n";
  const auto suite = read(head +
                          "faults = [\"black=1:1.5\", \"brightness=2:3:0.5\"]\n"
                          "calibration_error = \"1:2\"\nuntold_time_offset_s = 0.01\n");
  ASSERT_TRUE(suite.has_value()) << suite.error().message;
  ASSERT_EQ(suite->simulations.size(), 2U);
  const SimulationRequest& request = suite->simulations[1].request;
  EXPECT_EQ(request.faults, (std::vector<std::string>{"black=1:1.5", "brightness=2:3:0.5"}));
  EXPECT_EQ(request.calibration_error, "1:2");
  EXPECT_DOUBLE_EQ(request.untold_time_offset_s, 0.01);
  const auto options = simulation_options(request);
  ASSERT_TRUE(options.has_value()) << options.error().message;
  EXPECT_EQ(options->faults.size(), 2U);
  expect_refused(head + "faults = [\"blakc=1:2\"]\n", ":7", "black");
  expect_refused(head + "calibration_error = \"much\"\n", ":7", "much");
}

TEST_F(SuiteSimulationsTest, JobsKnowWhereTheRecordingIsAndHowItIsMade) {
  const auto suite = read(std::string(kLists) +
                          "[[simulations]]\nname = \"path\"\ntrajectory = \"paths/p.txt\"\ngroup = \"own\"\n"
                          "[[recordings]]\nname = \"freiburg1_*\"\ngroup = \"fr1\"\nvariants = [\"full\"]\n");
  ASSERT_TRUE(suite.has_value()) << suite.error().message;
  BatchOptions options;
  options.simulated = "made";
  options.only = {"recording=slow_rest_2"};
  auto jobs = plan_batch(*suite, options);
  ASSERT_TRUE(jobs.has_value()) << jobs.error().message;  // what is left out needs no --data
  ASSERT_EQ(jobs->jobs.size(), 2U);
  EXPECT_EQ(jobs->jobs[0].recording, std::filesystem::path("made/zr300_slow_rest_2"));
  EXPECT_EQ(jobs->jobs[0].group, "slow");
  EXPECT_EQ(jobs->jobs[1].variant, "dm");
  ASSERT_TRUE(jobs->jobs[0].simulation.has_value());
  EXPECT_EQ(jobs->jobs[0].simulation->seed, 2U);

  options.only = {"recording=slow_rest", "split=held-out", "variant=dm"};
  const auto held_out = plan_batch(*suite, options);
  ASSERT_TRUE(held_out.has_value()) << held_out.error().message;
  options.only[1] = "split=tuning";
  const auto tuning = plan_batch(*suite, options);
  ASSERT_TRUE(tuning.has_value()) << tuning.error().message;
  options.only.erase(options.only.begin() + 1);
  const auto both = plan_batch(*suite, options);
  ASSERT_TRUE(both.has_value()) << both.error().message;
  EXPECT_GT(held_out->jobs.size(), 0U);
  EXPECT_GT(tuning->jobs.size(), 0U);
  EXPECT_EQ(held_out->jobs.size() + tuning->jobs.size(), both->jobs.size());
  for (const BatchJob& job : held_out->jobs) EXPECT_EQ(job.split, kHeldOutSplit);
  for (const BatchJob& job : tuning->jobs) EXPECT_EQ(job.split, kTuningSplit);
  options.only = {"recording=slow_rest", "split=both"};
  EXPECT_EQ(plan_batch(*suite, options).error().code, ErrorCode::usage);

  options.only = {"recording=path"};
  EXPECT_EQ(plan_batch(*suite, options).error().code, ErrorCode::data_missing);
  options.data = folder_ / "data";
  jobs = plan_batch(*suite, options);
  ASSERT_TRUE(jobs.has_value()) << jobs.error().message;
  EXPECT_EQ(jobs->jobs[0].simulation->trajectory, folder_ / "data" / "paths" / "p.txt");

  options.only = {"recording=freiburg1"};
  EXPECT_EQ(plan_batch(*suite, options).error().code, ErrorCode::data_missing);
  for (const char* name : {"data/freiburg1_b", "data/freiburg1_a", "data/freiburg2_a"}) {
    write(std::string(name) + "/rgb.txt", "");
    write(std::string(name) + "/depth.txt", "");
  }
  jobs = plan_batch(*suite, options);
  ASSERT_TRUE(jobs.has_value()) << jobs.error().message;
  ASSERT_EQ(jobs->jobs.size(), 2U);
  EXPECT_EQ(jobs->jobs[0].recording.filename(), "freiburg1_a");
  EXPECT_EQ(jobs->jobs[1].recording.filename(), "freiburg1_b");
  EXPECT_EQ(jobs->jobs[1].group, "fr1");
}

TEST_F(SuiteSimulationsTest, RecordingsAreMadeOnceAndUsedAgain) {
  const auto suite = read(
      "[[simulations]]\nname = \"tiny_{seed}\"\nformat = \"tum\"\npreset = \"slow\"\nstart = \"motion\"\n"
      "seed = [1, 2]\nduration_s = 0.1\nsize = \"160x120\"\nblur_samples = 1\n");
  ASSERT_TRUE(suite.has_value()) << suite.error().message;
  BatchOptions options;
  options.simulated = folder_ / "made";
  options.only = {"recording=tiny_2"};
  const auto jobs = plan_batch(*suite, options);
  ASSERT_TRUE(jobs.has_value()) << jobs.error().message;
  std::vector<bool> reused;
  SimulatingControl control;
  control.finished = [&](const std::vector<std::string>& lines) { reused.push_back(lines.empty()); };
  for (int repetition = 0; repetition < 2; ++repetition) {
    const auto made = make_simulated_recordings(jobs->jobs, 1, control);
    ASSERT_TRUE(made.has_value()) << made.error().message;
  }
  EXPECT_EQ(reused, (std::vector<bool>{false, true}));  // once for both variants
  EXPECT_TRUE(std::filesystem::exists(folder_ / "made" / "tiny_2" / "simulation.toml"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "made" / "tiny_1"));
}

}  // namespace
}  // namespace fusebench
