// Recordings that hang when they are opened, or take all memory: a hang is played by waiting for ever.
#include "eval/suites/engine/opened_recordings.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "tests/datasets/images/child_process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench::engine {

namespace {

Result<void> hang() {
  while (true) pause();
}

TEST(OpeningTrial, GoesWellOrHasTheErrorOfTheOpening) {
  EXPECT_TRUE(try_opening([] { return Result<void>(); }, {}, nullptr));
  const auto refused = try_opening(
      []() -> Result<void> { return fail(ErrorCode::data_corrupt, "rgb.txt:3: no number", "look there"); },
      {}, nullptr);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::data_corrupt);
  EXPECT_EQ(refused.error().message, "rgb.txt:3: no number");
  EXPECT_EQ(refused.error().hint, "look there");
}

TEST(OpeningTrial, AHangEndsAtTheLimitWithAReason) {
  const auto hung = try_opening(hang, {.stall_s = 0.1}, nullptr);
  ASSERT_FALSE(hung);
  EXPECT_EQ(hung.error().code, ErrorCode::run_failed);
  EXPECT_EQ(hung.error().message, "opening the recording: hung: no progress for 0.1 s (limits.stall_s)");
}

TEST(OpeningTrial, ReadingIsProgress) {
  const testing::TemporaryFolder folder;
  const auto file = folder.write("images", std::string(100'000, 'x'));
  const auto slow = [&]() -> Result<void> {
    for (int part = 0; part < 8; ++part) {
      const std::string content = testing::read_bytes(file);
      usleep(200'000);
    }
    return {};
  };
  EXPECT_TRUE(try_opening(slow, {.stall_s = 1.0}, nullptr));
}

TEST(OpeningTrial, ACrashAndTooMuchMemoryAreReasons) {
  const auto crashed = try_opening([]() -> Result<void> { std::abort(); }, {}, nullptr);
  ASSERT_FALSE(crashed);
  EXPECT_NE(crashed.error().message.find("opening the recording: ended by signal 6"), std::string::npos)
      << crashed.error().message;
  if (!testing::kMemoryIsMeasured) return;
  const std::size_t here = testing::data_bytes();
  const auto greedy = try_opening(
      []() -> Result<void> {
        std::vector<std::vector<char>> blocks;
        while (true) blocks.emplace_back(std::size_t{1} << 24, 'x');
      },
      {.memory_bytes = here + (std::size_t{100} << 20)}, nullptr);
  ASSERT_FALSE(greedy);
  EXPECT_NE(greedy.error().message.find("out of memory: the limit is "), std::string::npos)
      << greedy.error().message;
}

TEST(OpeningTrial, EndsWhenItIsStopped) {
  const std::atomic<bool> stop = true;
  const auto stopped = try_opening(hang, {}, &stop);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().message, "stopped by the user");
}

}  // namespace
}  // namespace fusebench::engine
