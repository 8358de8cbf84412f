#include "eval/record/run_files/run_set.hpp"

#include <gtest/gtest.h>

namespace fusebench::run_files {

namespace {

RunIdentity run_of(std::string variant, RunOptions options = {}) {
  RunIdentity run;
  run.recording = "fr1_rpy";
  run.fingerprint = "00";
  run.variant = std::move(variant);
  run.options = std::move(options);
  run.wrote_options = true;
  run.frames = 240;
  run.imu = "recorded";
  run.run = "3e015db8";
  return run;
}

std::vector<std::string> run_labels(const std::vector<RunIdentity>& runs) { return RunSet(runs).labels(); }

using Texts = std::vector<std::string>;

TEST(RunSetTest, VariantsAloneNeedNoMore) {
  EXPECT_EQ(run_labels(std::vector{run_of("full"), run_of("dm")}), (Texts{"full", "dm"}));
}

TEST(RunSetTest, EditsThatAllRunsShareAreNotToldOfEach) {
  const std::vector runs = {run_of("full", {{"depth.max_m", "4"}, {"tsdf.voxel_m", "0.01"}}),
                            run_of("full", {{"depth.max_m", "4"}, {"tsdf.voxel_m", "0.02"}}),
                            run_of("dm", {{"depth.max_m", "4"}})};
  EXPECT_EQ(run_labels(runs), (Texts{"full tsdf.voxel_m=0.01", "full tsdf.voxel_m=0.02", "dm"}));
  EXPECT_EQ(RunSet(runs).shared_options(), "depth.max_m=4");
}

TEST(RunSetTest, AnEditedRunBesideOtherVariantsIsNotTakenForThePlainOne) {
  EXPECT_EQ(run_labels(std::vector{run_of("full", {{"tsdf.voxel_m", "0.01"}}), run_of("dm")}),
            (Texts{"full tsdf.voxel_m=0.01", "dm"}));
}

TEST(RunSetTest, RunsThatDoNotKnowTheirOptionsHaveNoSayInWhatIsShared) {
  std::vector runs = {run_of("full", {{"depth.max_m", "4"}}), run_of("imported")};
  runs[1].wrote_options = false;
  EXPECT_EQ(run_labels(runs), (Texts{"full", "imported"}));
}

TEST(RunSetTest, AnImportedRunOfUnknownImuSaysWhatIsNotSaid) {
  std::vector runs = {run_of("ORB-SLAM3"), run_of("ORB-SLAM3")};
  runs[0].imu = "not said";
  runs[1].imu = "none";
  EXPECT_EQ(run_labels(runs), (Texts{"ORB-SLAM3 IMU not said", "ORB-SLAM3 no IMU"}));
}

TEST(RunSetTest, WindowsRepetitionsAndImusAreToldWhereTheyDiffer) {
  std::vector runs = {run_of("full"), run_of("full"), run_of("full"), run_of("dm")};
  runs[1].repetition = 2;
  runs[2].first_frame = 100;
  runs[2].frames = 50;
  runs[2].imu = "synthetic IMU";
  EXPECT_EQ(run_labels(runs), (Texts{"full repetition 1 recorded IMU", "full repetition 2 recorded IMU",
                                     "full frames 100:150 repetition 1 synthetic IMU", "dm"}));
}

TEST(RunSetTest, APartOfARecordingIsNamedWithoutOtherWindows) {
  std::vector runs = {run_of("full")};
  runs[0].whole_frames = 300;
  EXPECT_EQ(RunSet(runs).window_labels(), (Texts{"frames 0:240"}));
  EXPECT_EQ(run_labels(runs), (Texts{"full"}));  // it distinguishes nothing
  runs[0].whole_frames = 0;                      // unknown
  EXPECT_EQ(RunSet(runs).window_labels(), (Texts{""}));
  runs[0].first_frame = 100;
  EXPECT_EQ(RunSet(runs).window_labels(), (Texts{"frames 100:340"}));
}

TEST(RunSetTest, AWholeRecordingHasNoWindowNextToPartsOfIt) {
  std::vector runs = {run_of("full"), run_of("full"), run_of("full")};
  runs[1].frames = 60;
  runs[1].whole_frames = 240;
  runs[2].frames = 0;  // it failed before it opened the recording
  EXPECT_EQ(RunSet(runs).window_labels(), (Texts{"", "frames 0:60", ""}));
}

TEST(RunSetTest, ConfigurationsAreApartByImuAndNotByRepetition) {
  std::vector runs = {run_of("full"), run_of("full"), run_of("full"), run_of("full"), run_of("dm")};
  runs[1].repetition = 2;
  runs[2].imu = "synthetic IMU";
  runs[2].recording = "fr1_xyz";
  runs[3].fingerprint.clear();
  EXPECT_EQ(RunSet(runs).configuration_labels(), (Texts{"full recorded IMU", "full recorded IMU",
                                                        "full synthetic IMU", "full recorded IMU", "dm"}));
}

TEST(RunSetTest, WhatNothingTellsApartHasTheNameOfItsFolder) {
  std::vector runs = {run_of("full"), run_of("full"), run_of("full")};
  runs[1].run = "0be4a4cc";
  runs[2].recording = "fr1_xyz";
  EXPECT_EQ(run_labels(runs), (Texts{"full (3e015db8)", "full (0be4a4cc)", "full"}));
}

TEST(RunSetTest, EditsAreWhatNeitherProgramNorVariantSays) {
  record::RunRecord record;
  record.config = {{"a.b", std::int64_t{8}, "default"},
                   {"a.c", std::int64_t{8}, "variant dm"},
                   {"a.d", 0.01, "sweep"},
                   {"a.e", std::string("x"), "suite.toml:4"}};
  const RunIdentity run = identity_of(FoundRun{"runs/r/full/01234567", record});
  EXPECT_TRUE(run.wrote_options);
  EXPECT_EQ(run.run, "01234567");
  EXPECT_EQ(RunSet({run, run_of("full")}).differing_options(), (Texts{"a.d=0.01 a.e=x", ""}));
}

}  // namespace

}  // namespace fusebench::run_files
