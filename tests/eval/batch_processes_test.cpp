#include "eval/batch_processes.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <chrono>
#include <thread>

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
      job.spec.variant = "full";
      job.spec.out = folder_ / "out";
      jobs.push_back(job);
    }
    return jobs;
  }
  static std::string fmt_name(std::size_t i) { return "recording" + std::to_string(i); }

  /// The record of a job's run.
  static RunRecord record_of(const BatchJob& job, std::size_t index) {
    RunRecord record;
    record.status = RunStatus::ok;
    record.reason = "";
    record.recording.name = job.recording.filename().string();
    record.variant = job.variant;
    record.config_hash = config_hash(job.spec.config.values);
    record.frames = {index + 1, index + 1, 0};
    return record;
  }

  /// What a process of a job with that record would print; `before` is run first.
  [[nodiscard]] std::vector<std::string> process_with(const RunRecord& record, const std::string& before = "",
                                                      std::size_t index = 0,
                                                      const std::string& status = "ok") const {
    const std::filesystem::path folder = std::filesystem::path("done") / fmt_name(index);
    write(folder / "record.json", to_json(record));
    const std::string json = R"({"runs": [{"status": ")" + status +
                             R"(", "reason": "", "skipped": false, "resumed": true, "folder": ")" +
                             (folder_ / folder).string() + "\"}]}";
    return {"/bin/sh", "-c", before + "printf '%s' '" + json + "'", "job", std::to_string(index)};
  }

  [[nodiscard]] JobCommand reporting(const std::string& before = "") const {
    return [this, before](std::size_t index) {
      return process_with(record_of(jobs(index + 1).back(), index), before, index);
    };
  }

  /// How the one job of a process ends.
  [[nodiscard]] BatchOutcome outcome(const std::vector<std::string>& command) const {
    const auto outcomes = run_batch_in_processes(jobs(1), 1, [&](std::size_t) { return command; });
    return outcomes ? outcomes->front() : without_results(jobs(1).front(), outcomes.error().message);
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
    EXPECT_EQ((*outcomes)[i].record.frames.total, i + 1);
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

/// What lies in the folder may be of an earlier run, or of another question.
TEST_F(BatchProcessesTest, OnlyTheRecordOfTheJobCounts) {
  const RunRecord right = record_of(jobs(1).front(), 0);
  EXPECT_EQ(outcome(process_with(right)).status, RunStatus::ok);
  std::vector<RunRecord> wrong(3, right);
  wrong[0].recording.name = "another";
  wrong[1].variant = "dm";
  wrong[2].config_hash = "0123";
  for (const RunRecord& record : wrong) {
    const BatchOutcome ended = outcome(process_with(record));
    EXPECT_EQ(ended.status, RunStatus::failed);
    EXPECT_NE(ended.reason.find("is not the record of this run"), std::string::npos) << ended.reason;
    EXPECT_TRUE(ended.folder.empty());
    EXPECT_EQ(ended.record.recording.name, right.recording.name);
    EXPECT_EQ(ended.record.variant, "full");
    EXPECT_EQ(ended.record.config_hash, right.config_hash);
    EXPECT_EQ(ended.record.frames.total, 0U);
  }
  // The process failed, and says so, or says nothing: the good record is of an earlier run.
  const BatchOutcome told = outcome(process_with(right, "", 0, "failed"));
  EXPECT_EQ(told.status, RunStatus::failed);
  EXPECT_EQ(told.record.status, RunStatus::failed);
  EXPECT_TRUE(told.folder.empty());
  EXPECT_EQ(outcome(process_with(right, "kill -9 $$; ")).status, RunStatus::failed);
  std::vector<std::string> crash = process_with(right);
  crash[2] += "; exit 5";
  EXPECT_EQ(outcome(crash).status, RunStatus::failed);
  crash = process_with(right);
  crash[2] += "; kill -9 $$";
  EXPECT_EQ(outcome(crash).status, RunStatus::failed);
}

TEST_F(BatchProcessesTest, ARunThatDidNotStartIsNamedInFull) {
  const std::string json =
      R"({"runs": [{"status": "failed", "reason": "no such folder", "skipped": false, "resumed": false, )"
      R"("folder": ""}]})";
  const BatchOutcome ended = outcome({"/bin/sh", "-c", "printf '%s' '" + json + "'; exit 4"});
  EXPECT_EQ(ended.status, RunStatus::failed);
  EXPECT_EQ(ended.reason, "no such folder");
  EXPECT_EQ(ended.record.reason, "no such folder");
  EXPECT_EQ(ended.record.recording.name, "recording0");
  EXPECT_EQ(ended.record.variant, "full");
  EXPECT_EQ(ended.record.config_hash, config_hash(Config{}));
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

/// Each of two ends only when the other was asked as well, and gives up after a while.
TEST_F(BatchProcessesTest, AllAreAskedToStopBeforeAnyIsWaitedFor) {
  std::atomic<bool> stop = false;
  const std::string place = folder_.string();
  const JobCommand command = [&](std::size_t index) {
    const std::string own = std::to_string(index);
    const std::string other = std::to_string(1 - index);
    const std::string tidy = "touch " + place + "/asked" + own + "; i=0; while [ ! -e " + place + "/asked" +
                             other + " ] && [ $i -lt 200 ]; do sleep 0.02; i=$((i + 1)); done; [ -e " +
                             place + "/asked" + other + " ] && touch " + place + "/met" + own + "; exit 130";
    const std::string script =
        "trap '" + tidy + "' INT; touch " + place + "/ready" + own + "; while :; do sleep 0.02; done";
    return std::vector<std::string>{"/bin/sh", "-c", script};
  };
  std::thread user([&] {
    const auto is_there = [&](const char* name) { return std::filesystem::exists(folder_ / name); };
    while (!is_there("ready0") || !is_there("ready1")) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    stop = true;
  });
  EXPECT_FALSE(run_batch_in_processes(jobs(2), 2, command, {{}, &stop}).has_value());
  user.join();
  EXPECT_TRUE(std::filesystem::exists(folder_ / "met0"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "met1"));
}

std::optional<ChildEnd> end_of(ChildProcess& child) {
  for (int i = 0; i < 1000; ++i) {
    if (auto end = child.poll()) return end;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return std::nullopt;
}

TEST(ChildProcess, OneThatSomebodyElseWaitedForHasEnded) {
  auto child = ChildProcess::start({"/bin/sh", "-c", "echo said"});
  ASSERT_TRUE(child.has_value()) << child.error().message;
  ASSERT_GT(waitpid(-1, nullptr, 0), 0);
  const auto end = end_of(*child);
  ASSERT_TRUE(end.has_value());
  EXPECT_EQ(end->how(), "an unknown state");
  EXPECT_EQ(end->output, "said\n");
}

/// A second interrupt could keep it from tidying up.
TEST(ChildProcess, IsInterruptedOnce) {
  const testing::TemporaryFolder folder;
  const std::string place = folder.path().string();
  {
    auto child = ChildProcess::start(
        {"/bin/sh", "-c",
         "trap 'echo x >>" + place + "/asked; i=0; while [ $i -lt 10 ]; do sleep 0.02; i=$((i + 1)); done; " +
             "[ $(wc -l <" + place + "/asked) = 1 ] && touch " + place + "/once; exit 130' INT; touch " +
             place + "/ready; while :; do sleep 0.02; done"});
    ASSERT_TRUE(child.has_value());
    while (!std::filesystem::exists(folder.path() / "ready")) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    child->interrupt();
    while (!std::filesystem::exists(folder.path() / "asked")) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    child->interrupt();
  }
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "once"));
}

TEST(ChildProcess, DoesNotInheritTheFilesOfOthers) {
  const std::vector<std::string> list = {"/bin/sh", "-c", "ls -l /proc/$$/fd | grep -c '(deleted)'"};
  auto first = ChildProcess::start(list);
  auto second = ChildProcess::start(list);
  ASSERT_TRUE(first && second);
  for (ChildProcess* child : {&*first, &*second}) {
    const auto end = end_of(*child);
    ASSERT_TRUE(end.has_value());
    EXPECT_EQ(end->output, "2\n");  // its own output and errors
  }
}

TEST_F(BatchProcessesTest, AProgramThatIsNotThereIsAnError) {
  const auto child = ChildProcess::start({(folder_ / "absent").string()});
  ASSERT_FALSE(child.has_value());
  EXPECT_EQ(child.error().code, ErrorCode::io);
}

}  // namespace
}  // namespace fusebench
