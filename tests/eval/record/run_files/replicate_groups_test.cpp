#include "eval/record/run_files/run_set.hpp"

#include <gtest/gtest.h>

namespace fusebench::run_files {
namespace {

using Groups = std::vector<std::vector<std::size_t>>;

FoundRun run_of(const std::string& variant, int replicate, const std::string& config_hash = "a") {
  FoundRun run;
  run.record.recording.name = "desk";
  run.record.variant = variant;
  run.record.config_hash = config_hash;
  run.record.replicate = replicate;
  return run;
}

TEST(ReplicateGroups, AreOfOneRequestAndInTheOrderOfReplicates) {
  const std::vector<FoundRun> runs = {run_of("full", 2), run_of("no-imu", 0), run_of("full", 0),
                                      run_of("full", 1, "b"), run_of("full", 1)};
  EXPECT_EQ(RunSet(runs).replicate_groups(), (Groups{{2, 4, 0}, {1}, {3}}));
}

TEST(ReplicateGroups, TheSameReplicateTwiceIsAnotherRun) {
  const std::vector<FoundRun> runs = {run_of("imported", 0), run_of("imported", 0)};
  EXPECT_EQ(RunSet(runs).replicate_groups(), (Groups{{0}, {1}}));
  EXPECT_TRUE(RunSet(std::vector<RunIdentity>()).replicate_groups().empty());
}

}  // namespace
}  // namespace fusebench::run_files
