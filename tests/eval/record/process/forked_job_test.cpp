// Work in a process of its own: whatever becomes of it, this process learns it and lives on.
#include "eval/record/process/forked_job.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <vector>

#include "core/base/io/staged_folder.hpp"
#include "tests/datasets/images/child_process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace process;

namespace {

using Work = std::function<void(const JobReporter& reporter)>;

JobEnd end_of(const Work& work, const JobLimits& limits = {}) {
  auto job = ForkedJob::start(work, limits);
  EXPECT_TRUE(job.has_value());
  while (true) {
    pollfd descriptor{job->descriptor(), POLLIN, 0};
    ::poll(&descriptor, 1, 20);
    if (auto end = job->poll()) return std::move(*end);
  }
}

TEST(ForkedJob, TellsWhatCameOut) {
  const JobEnd end = end_of([](const JobReporter& reporter) {
    reporter.progress(3, 7);
    reporter.finished("ok");
  });
  EXPECT_EQ(end.finished, "ok");
  EXPECT_FALSE(end.error.has_value());
  EXPECT_TRUE(end.reason.empty());
  EXPECT_GT(end.peak_rss_bytes, 1'000'000U);
}

TEST(ForkedJob, ErrorsArriveAsTheyAre) {
  const JobEnd end = end_of([](const JobReporter& reporter) {
    reporter.failed({ErrorCode::data_corrupt, "a\tmessage\nof two lines", "a hint"});
  });
  ASSERT_TRUE(end.error.has_value());
  EXPECT_EQ(end.error->code, ErrorCode::data_corrupt);
  EXPECT_EQ(end.error->message, "a message of two lines");
  EXPECT_EQ(end.error->hint, "a hint");
}

TEST(ForkedJob, ACrashIsAReasonWithThePlaceAndTheLastWords) {
  const JobEnd end = end_of([](const JobReporter& reporter) {
    reporter.progress(117, 240);
    std::fputs("last words\n", stderr);
    std::abort();
  });
  EXPECT_EQ(end.reason, "ended by signal 6 (Aborted) after frame 117 of 240");
  EXPECT_EQ(end.output, "last words\n");
}

TEST(ForkedJob, AKillFromOutsideSaysSo) {
  const JobEnd end = end_of([](const JobReporter&) { std::raise(SIGKILL); });
  EXPECT_NE(end.reason.find("killed from outside"), std::string::npos) << end.reason;
}

TEST(ForkedJob, AnExitWithoutAWordIsNoResult) {
  const JobEnd end = end_of([](const JobReporter&) { _exit(3); });
  EXPECT_EQ(end.reason, "ended with exit code 3 and no result");
}

TEST(ForkedJob, AnExceptionIsAnError) {
  const JobEnd end = end_of([](const JobReporter&) { throw std::runtime_error("oh"); });
  ASSERT_TRUE(end.error.has_value());
  EXPECT_EQ(end.error->code, ErrorCode::internal);
  EXPECT_EQ(end.error->message, "oh");
}

TEST(ForkedJob, AHangIsEnded) {
  const Work hang = [](const JobReporter& reporter) {
    reporter.progress(5, 9);
    while (true) pause();
  };
  EXPECT_EQ(end_of(hang, {.stall_s = 0.2}).reason,
            "hung: no progress for 0.2 s (limits.stall_s) after frame 5 of 9");
  EXPECT_EQ(end_of(hang, {.time_s = 0.2}).reason,
            "took longer than 0.2 s (limits.time_s) after frame 5 of 9");
}

TEST(ForkedJob, ProgressIsNoHang) {
  const JobEnd end = end_of(
      [](const JobReporter& reporter) {
        for (std::size_t i = 0; i < 8; ++i) {
          reporter.progress(i, 8);
          usleep(100'000);
        }
        reporter.finished("ok");
      },
      {.stall_s = 0.5});
  EXPECT_EQ(end.finished, "ok");
}

TEST(ForkedJob, MemoryHasALimit) {
  if (!testing::kMemoryIsMeasured) GTEST_SKIP() << "a sanitizer ends a program that is out of memory itself";
  const JobEnd end = end_of(
      [](const JobReporter& reporter) {
        reporter.progress(2, 3);
        std::vector<std::vector<char>> hoard;
        while (true) hoard.emplace_back(10'000'000, 'x');
      },
      {.memory_bytes = 400'000'000});
  ASSERT_TRUE(end.error.has_value()) << end.reason;
  EXPECT_EQ(end.error->message, "out of memory after frame 2 of 3: the limit is 400 MB (limits.memory_mb)");
}

TEST(ForkedJob, OutputIsKeptFromItsEnd) {
  const JobEnd end = end_of([](const JobReporter& reporter) {
    for (int i = 0; i < 100'000; ++i) std::printf("%d\n", i);
    reporter.finished("");
  });
  EXPECT_TRUE(end.output.ends_with("99999\n"));
  EXPECT_LT(end.output.size(), 20'000U);
}

class ForkedJobThatWrites : public testing::InTemporaryFolder {
 protected:
  /// Fills a staged folder, says so, and never gets to its end.
  [[nodiscard]] Work writes_until(const std::function<void()>& what_happens) const {
    return [this, what_happens](const JobReporter& reporter) {
      auto folder = io::StagedFolder::create(place_);
      if (!folder || !folder->write("frames.csv", "half")) _exit(4);
      reporter.progress(1, 2);
      what_happens();
    };
  }
  [[nodiscard]] bool is_clean() const { return std::filesystem::is_empty(place_.parent_path()); }

  std::filesystem::path place_ = folder_ / "run";
};

TEST_F(ForkedJobThatWrites, LeavesNothingWhenItCrashes) {
  auto job = ForkedJob::start(writes_until([] { std::abort(); }), {}, place_);
  ASSERT_TRUE(job.has_value());
  std::optional<JobEnd> end;
  while (!(end = job->poll())) usleep(1000);
  EXPECT_EQ(end->reason, "ended by signal 6 (Aborted) after frame 1 of 2");
  EXPECT_TRUE(is_clean());
}

TEST_F(ForkedJobThatWrites, LeavesNothingWhenItIsNotWantedAnyMore) {
  {
    auto job = ForkedJob::start(writes_until([] { pause(); }), {}, place_);
    ASSERT_TRUE(job.has_value());
    while (job->done() == 0) {
      ASSERT_FALSE(job->poll().has_value());
      usleep(1000);
    }
    EXPECT_FALSE(is_clean());
  }
  EXPECT_TRUE(is_clean());
}

}  // namespace
}  // namespace fusebench
