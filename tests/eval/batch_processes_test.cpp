#include "eval/batch_processes.hpp"

#include <gtest/gtest.h>

#include "eval/child_processes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {
namespace {

class BatchProcessesTest : public testing::InTemporaryFolder {
 protected:
  [[nodiscard]] std::vector<BatchJob> jobs(std::size_t count) const {
    std::vector<BatchJob> jobs;
    for (std::size_t i = 0; i < count; ++i) {
      BatchJob job;
      job.recording = folder_ / fmt_name(i);
      job.variant = "full";
      job.group = "g";
      job.spec.out = folder_ / "out";
      jobs.push_back(job);
    }
    return jobs;
  }
  static std::string fmt_name(std::size_t i) { return "recording" + std::to_string(i); }

  /// What a process of a job with a record would print; `before` is run first.
  [[nodiscard]] JobCommand reporting(const std::string& before = "") const {
    return [this, before](std::size_t index) {
      RunRecord record;
      record.status = RunStatus::ok;
      record.reason = "";
      record.frames = {index, index, 0};
      const std::filesystem::path folder = std::filesystem::path("done") / fmt_name(index);
      write(folder / "record.json", to_json(record));
      const std::string json = R"({"runs": [{"reason": "", "skipped": false, "resumed": true, "folder": ")" +
                               (folder_ / folder).string() + "\"}]}";
      return std::vector<std::string>{"/bin/sh", "-c", before + "printf '%s' '" + json + "'", "job",
                                      std::to_string(index)};
    };
  }
};

TEST_F(BatchProcessesTest, OutcomesAreInTheOrderOfTheJobs) {
  // The first to start is the last to end.
  std::vector<std::size_t> ended;
  const auto outcomes = run_batch_in_processes(
      jobs(3), 3, reporting("if [ $1 = 0 ]; then sleep 0.5; fi; "),
      {[&](std::size_t index, const BatchOutcome&) { ended.push_back(index); }, nullptr});
  ASSERT_TRUE(outcomes.has_value()) << outcomes.error().message;
  ASSERT_EQ(outcomes->size(), 3U);
  EXPECT_EQ(ended.back(), 0U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ((*outcomes)[i].recording, fmt_name(i));
    EXPECT_EQ((*outcomes)[i].status, RunStatus::ok);
    EXPECT_EQ((*outcomes)[i].group, "g");
    EXPECT_TRUE((*outcomes)[i].resumed);
    EXPECT_EQ((*outcomes)[i].record.frames.total, i);
  }
}

TEST_F(BatchProcessesTest, NoMoreThanAskedForRunAtATime) {
  // Each process notes that it is there, and how many are.
  const std::string here = (folder_ / "here").string();
  std::filesystem::create_directories(here);
  const std::string before = "touch " + here + "/$1; ls " + here + " | wc -l >> " + here +
                             "_counts; sleep 0.1; rm " + here + "/$1; ";
  ASSERT_TRUE(run_batch_in_processes(jobs(6), 2, reporting(before)).has_value());
  std::istringstream counts(testing::read_bytes(here + "_counts"));
  int lines = 0;
  for (int count = 0; counts >> count; ++lines) EXPECT_LE(count, 2);
  EXPECT_EQ(lines, 6);
}

TEST_F(BatchProcessesTest, AProcessThatDiesIsARowWithAReason) {
  const auto command = [](std::size_t index) {
    const std::vector<std::string> scripts = {"kill -9 $$", "echo 'error: no luck' >&2; exit 5",
                                              "echo nonsense"};
    return std::vector<std::string>{"/bin/sh", "-c", scripts[index]};
  };
  const auto outcomes = run_batch_in_processes(jobs(3), 2, command);
  ASSERT_TRUE(outcomes.has_value());
  EXPECT_NE((*outcomes)[0].reason.find("signal 9"), std::string::npos) << (*outcomes)[0].reason;
  EXPECT_NE((*outcomes)[1].reason.find("exit code 5: no luck"), std::string::npos) << (*outcomes)[1].reason;
  EXPECT_NE((*outcomes)[2].reason.find("exit code 0"), std::string::npos) << (*outcomes)[2].reason;
  for (const BatchOutcome& outcome : *outcomes) {
    EXPECT_EQ(outcome.status, RunStatus::failed);
    const auto record =
        read_record(folder_ / "out" / outcome.recording / "full" / "not-started" / "record.json");
    ASSERT_TRUE(record.has_value()) << record.error().message;
    EXPECT_EQ(record->reason, outcome.reason);
  }
}

TEST_F(BatchProcessesTest, StoppingAsksTheProcessesToStopAndWaits) {
  std::atomic<bool> stop = false;
  const std::string mark = (folder_ / "interrupted").string();
  const std::string before = "if [ $1 = 1 ]; then trap 'sleep 0.2; touch " + mark +
                             "; exit 130' INT; while :; do sleep 0.02; done; fi; ";
  const auto outcomes = run_batch_in_processes(
      jobs(3), 2, reporting(before), {[&](std::size_t, const BatchOutcome&) { stop = true; }, &stop});
  ASSERT_FALSE(outcomes.has_value());
  EXPECT_EQ(outcomes.error().code, ErrorCode::run_failed);
  EXPECT_TRUE(std::filesystem::exists(mark));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(BatchProcessesTest, AProgramThatIsNotThereIsAnError) {
  const auto child = ChildProcess::start({(folder_ / "absent").string()});
  ASSERT_FALSE(child.has_value());
  EXPECT_EQ(child.error().code, ErrorCode::io);
}

}  // namespace
}  // namespace fusebench
