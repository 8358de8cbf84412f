#include "core/base/io/staged_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/temporary_folder.hpp"

namespace {

/// What was written through to the disk while a test listened, in order, by the names that it had then.
std::vector<std::filesystem::path>* synced = nullptr;
/// What cannot be, while a test says so.
const std::filesystem::path* unsyncable = nullptr;

}  // namespace

/// In place of the C library's, for this program.
extern "C" int fsync(int descriptor) {
  if (synced != nullptr || unsyncable != nullptr) {
    const auto place = std::filesystem::read_symlink(fmt::format("/proc/self/fd/{}", descriptor));
    if (synced != nullptr) synced->push_back(place);
    if (unsyncable != nullptr && place == *unsyncable) {
      errno = EIO;
      return -1;
    }
  }
  return static_cast<int>(syscall(SYS_fsync, descriptor));
}

namespace fusebench {

using namespace io;

namespace {

using StagedFolderTest = testing::InTemporaryFolder;

std::size_t entries(const std::filesystem::path& folder) {
  std::size_t count = 0;
  for (auto entry = std::filesystem::recursive_directory_iterator(folder);
       entry != std::filesystem::recursive_directory_iterator(); ++entry) {
    ++count;
  }
  return count;
}

TEST_F(StagedFolderTest, NothingIsSeenBeforeTheCommit) {
  const auto place = folder_ / "out" / "recording" / "full" / "0123";
  {
    auto run = StagedFolder::create(place);
    ASSERT_TRUE(run.has_value());
    ASSERT_TRUE(run->write("record.json", "{}").has_value());
    EXPECT_FALSE(std::filesystem::exists(place));
    ASSERT_TRUE(run->commit().has_value());
  }
  EXPECT_EQ(testing::read_bytes(place / "record.json"), "{}");
  EXPECT_EQ(entries(folder_ / "out" / "recording" / "full"), 2U);
}

TEST_F(StagedFolderTest, AnAbandonedRunLeavesNothing) {
  {
    auto run = StagedFolder::create(folder_ / "out" / "recording" / "full" / "0123");
    ASSERT_TRUE(run.has_value());
    ASSERT_TRUE(run->write("record.json", "{}").has_value());
  }
  EXPECT_EQ(entries(folder_), 0U);
}

TEST_F(StagedFolderTest, AnAbandonedRunKeepsWhatWasThere) {
  write("out/recording/full/0123/record.json", "old");
  { auto run = StagedFolder::create(folder_ / "out" / "recording" / "full" / "0123"); }
  EXPECT_EQ(testing::read_bytes(folder_ / "out/recording/full/0123/record.json"), "old");
}

TEST_F(StagedFolderTest, TheOldRunIsReplacedWhole) {
  write("0123/record.json", "old");
  write("0123/extra.txt", "old");
  auto run = StagedFolder::create(folder_ / "0123");
  ASSERT_TRUE(run && run->write("record.json", "new") && run->commit());
  EXPECT_EQ(testing::read_bytes(folder_ / "0123/record.json"), "new");
  EXPECT_EQ(entries(folder_), 2U);
}

TEST_F(StagedFolderTest, APlaceThatCannotBeWrittenIsAnIoError) {
  const auto file = write("file", "not a folder");
  const auto run = StagedFolder::create(file / "recording" / "0123");
  ASSERT_FALSE(run.has_value());
  EXPECT_EQ(run.error().code, ErrorCode::io);
  EXPECT_EQ(entries(folder_), 1U);
}

TEST_F(StagedFolderTest, TwoOfOnePlaceDoNotDisturbEachOther) {
  auto first = StagedFolder::create(folder_ / "0123");
  auto second = StagedFolder::create(folder_ / "0123");
  ASSERT_TRUE(first && second);
  EXPECT_NE(first->path(), second->path());
  ASSERT_TRUE(first->write("record.json", "first") && second->write("record.json", "second"));
  ASSERT_TRUE(second->commit() && first->commit());
  EXPECT_EQ(testing::read_bytes(folder_ / "0123/record.json"), "first");
  EXPECT_EQ(entries(folder_), 2U);
}

/// A machine that shares the disk has a process of the same number.
TEST_F(StagedFolderTest, ANameThatIsTakenIsLeftAlone) {
  const std::string process = std::to_string(getpid());
  write(".0123." + process + ".tmp/record.json", "theirs");
  write(".0123." + process + "-1.tmp/new/record.json", "theirs, too");
  auto run = StagedFolder::create(folder_ / "0123");
  ASSERT_TRUE(run && run->write("record.json", "ours") && run->commit());
  EXPECT_EQ(testing::read_bytes(folder_ / "0123/record.json"), "ours");
  EXPECT_EQ(testing::read_bytes(folder_ / (".0123." + process + ".tmp") / "record.json"), "theirs");
  EXPECT_EQ(testing::read_bytes(folder_ / (".0123." + process + "-1.tmp") / "new" / "record.json"),
            "theirs, too");
}

/// How many of many threads failed, each with many calls of `once`.
template <class Once>
int failures_of(const Once& once) {
  std::atomic<int> failures = 0;
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 4; ++thread) {
    threads.emplace_back([&, name = std::to_string(thread)] {
      for (int i = 0; i < 200; ++i) failures += once(name) ? 0 : 1;
    });
  }
  for (std::thread& thread : threads) thread.join();
  return failures;
}

/// Just when others need these.
TEST_F(StagedFolderTest, AbandonedFoldersTakeTheirEmptyParentsWithThem) {
  const int failures = failures_of([&](const std::string& name) {
    const auto run = StagedFolder::create(folder_ / "out" / "recording" / name);
    return run && run->write("record.json", "{}");
  });
  EXPECT_EQ(failures, 0);
}

TEST_F(StagedFolderTest, CommitsToOnePlaceAllSucceed) {
  const int failures = failures_of([&](const std::string& name) {
    auto run = StagedFolder::create(folder_ / "0123");
    return run && run->write("record.json", name) && run->write("log.txt", name) && run->commit();
  });
  EXPECT_EQ(failures, 0);
  EXPECT_EQ(testing::read_bytes(folder_ / "0123/record.json"), testing::read_bytes(folder_ / "0123/log.txt"));
  EXPECT_EQ(entries(folder_), 3U);
}

TEST_F(StagedFolderTest, ASlashAtTheEndIsTheSamePlace) {
  auto run = StagedFolder::create(folder_ / "0123" / "");
  ASSERT_TRUE(run && run->write("record.json", "{}") && run->commit());
  EXPECT_EQ(testing::read_bytes(folder_ / "0123/record.json"), "{}");
}

/// Or a power cut would leave the name of a run with zeros behind it.
TEST_F(StagedFolderTest, EverythingIsOnTheDiskBeforeItHasItsName) {
  std::vector<std::filesystem::path> order;
  auto run = StagedFolder::create(folder_ / "out" / "recording" / "0123");
  ASSERT_TRUE(run && run->write("record.json", "{}"));
  std::filesystem::create_directories(run->file("images"));
  ASSERT_TRUE(run->write("images/1.png", "pixels"));
  const auto hidden = std::filesystem::canonical(run->path());
  synced = &order;
  const auto done = run->commit();
  synced = nullptr;
  ASSERT_TRUE(done.has_value());
  const auto root = std::filesystem::canonical(folder_);
  const auto at = [&](const std::filesystem::path& path) {
    return std::ranges::find(order, path) - order.begin();
  };
  const auto missing = static_cast<std::ptrdiff_t>(order.size());
  // The folder goes after what is in it, and the names of the new folders last.
  for (const char* name : {"record.json", "images", "images/1.png"})
    EXPECT_LT(at(hidden / name), at(hidden)) << name;
  EXPECT_LT(at(hidden), at(root / "out" / "recording"));
  EXPECT_LT(at(root / "out" / "recording"), missing);
  EXPECT_LT(at(root / "out"), missing);
  EXPECT_LT(at(root), missing);
  for (const auto& place : order) EXPECT_EQ(std::ranges::count(order, place), 1) << place;
}

TEST_F(StagedFolderTest, ANameThatCannotBeSyncedIsAnErrorIfItIsOfANewFolder) {
  const auto root = std::filesystem::canonical(folder_);
  std::filesystem::create_directories(folder_ / "there");
  const auto commits = [&](const std::filesystem::path& place) {
    auto run = StagedFolder::create(place);
    EXPECT_TRUE(run && run->write("record.json", "{}"));
    unsyncable = &root;
    const bool done = run->commit().has_value();
    unsyncable = nullptr;
    return done;
  };
  EXPECT_TRUE(commits(folder_ / "there" / "0123"));
  EXPECT_FALSE(commits(folder_ / "new" / "0123"));
}

TEST_F(StagedFolderTest, AFolderIsRemovedWhole) {
  write("0123/images/1.png", "pixels");
  EXPECT_FALSE(remove_atomically(folder_ / "0123"));
  EXPECT_EQ(entries(folder_), 0U);
  EXPECT_TRUE(remove_atomically(folder_ / "0123"));
  EXPECT_EQ(entries(folder_), 0U);
}

}  // namespace
}  // namespace fusebench
