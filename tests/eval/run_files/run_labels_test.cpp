#include "eval/run_files/run_labels.hpp"

#include <gtest/gtest.h>

namespace fusebench::run_files {

namespace {

RunTraits run_of(std::string variant, std::vector<std::pair<std::string, std::string>> edits = {}) {
  RunTraits traits;
  traits.recording = "fr1_rpy";
  traits.variant = std::move(variant);
  traits.edits = std::move(edits);
  traits.options_known = true;
  traits.frames = 240;
  traits.imu = "recorded";
  traits.folder = "3e015db8";
  return traits;
}

using Texts = std::vector<std::string>;

TEST(RunLabelsTest, VariantsAloneNeedNoMore) {
  EXPECT_EQ(run_labels(std::vector{run_of("full"), run_of("dm")}), (Texts{"full", "dm"}));
}

TEST(RunLabelsTest, EditsThatAllRunsShareAreNotToldOfEach) {
  const std::vector runs = {run_of("full", {{"depth.max_m", "4"}, {"tsdf.voxel_m", "0.01"}}),
                            run_of("full", {{"depth.max_m", "4"}, {"tsdf.voxel_m", "0.02"}}),
                            run_of("dm", {{"depth.max_m", "4"}})};
  EXPECT_EQ(run_labels(runs), (Texts{"full tsdf.voxel_m=0.01", "full tsdf.voxel_m=0.02", "dm"}));
  EXPECT_EQ(shared_edits(runs), "depth.max_m=4");
}

TEST(RunLabelsTest, AnEditedRunBesideOtherVariantsIsNotTakenForThePlainOne) {
  EXPECT_EQ(run_labels(std::vector{run_of("full", {{"tsdf.voxel_m", "0.01"}}), run_of("dm")}),
            (Texts{"full tsdf.voxel_m=0.01", "dm"}));
}

TEST(RunLabelsTest, RunsThatDoNotKnowTheirOptionsHaveNoSayInWhatIsShared) {
  std::vector runs = {run_of("full", {{"depth.max_m", "4"}}), run_of("imported")};
  runs[1].options_known = false;
  EXPECT_EQ(run_labels(runs), (Texts{"full", "imported"}));
}

TEST(RunLabelsTest, AnImportedRunOfUnknownImuSaysWhatIsNotSaid) {
  std::vector runs = {run_of("ORB-SLAM3"), run_of("ORB-SLAM3")};
  runs[0].imu = "not said";
  runs[1].imu = "none";
  EXPECT_EQ(run_labels(runs), (Texts{"ORB-SLAM3 IMU not said", "ORB-SLAM3 no IMU"}));
}

TEST(RunLabelsTest, WindowsRepetitionsAndImusAreToldWhereTheyDiffer) {
  std::vector runs = {run_of("full"), run_of("full"), run_of("full"), run_of("dm")};
  runs[1].repetition = 2;
  runs[2].first_frame = 100;
  runs[2].frames = 50;
  runs[2].imu = "synthetic IMU";
  EXPECT_EQ(run_labels(runs), (Texts{"full frames 0:240 repetition 1 recorded IMU",
                                     "full frames 0:240 repetition 2 recorded IMU",
                                     "full frames 100:150 repetition 1 synthetic IMU", "dm frames 0:240"}));
}

TEST(RunLabelsTest, ConfigurationsAreApartByImuAndNotByRepetition) {
  std::vector runs = {run_of("full"), run_of("full"), run_of("full"), run_of("full"), run_of("dm")};
  runs[1].repetition = 2;
  runs[2].imu = "synthetic IMU";
  runs[2].recording = "fr1_xyz";
  runs[3].imu.clear();
  EXPECT_EQ(configuration_labels(runs), (Texts{"full recorded IMU", "full recorded IMU", "full synthetic IMU",
                                               "full recorded IMU", "dm"}));
}

TEST(RunLabelsTest, WhatNothingTellsApartHasTheNameOfItsFolder) {
  std::vector runs = {run_of("full"), run_of("full"), run_of("full")};
  runs[1].folder = "0be4a4cc";
  runs[2].recording = "fr1_xyz";
  EXPECT_EQ(run_labels(runs), (Texts{"full (3e015db8)", "full (0be4a4cc)", "full"}));
}

TEST(RunLabelsTest, EditsAreWhatNeitherProgramNorVariantSays) {
  record::RunRecord record;
  record.config = {{"a.b", std::int64_t{8}, "default"},
                   {"a.c", std::int64_t{8}, "variant dm"},
                   {"a.d", 0.01, "sweep"},
                   {"a.e", std::string("x"), "suite.toml:4"}};
  const RunTraits traits = traits_of(FoundRun{"runs/r/full/01234567", record});
  EXPECT_TRUE(traits.options_known);
  EXPECT_EQ(traits.folder, "01234567");
  EXPECT_EQ(differing_edits(std::vector{traits, run_of("full")}), (Texts{"a.d=0.01 a.e=x", ""}));
}

}  // namespace

}  // namespace fusebench::run_files
