#include "core/base/io/abandoned.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <string>
#include <vector>

#include "core/base/io/staged_file.hpp"
#include "core/base/io/staged_folder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

/// The name of what nobody may remove while a test says so: rights would not keep root from it.
const std::string* unremovable = nullptr;

}  // namespace

/// In place of the C library's, for this program.
extern "C" int unlinkat(int folder, const char* name, int flags) {
  if (unremovable != nullptr && *unremovable == name) {
    errno = EACCES;
    return -1;
  }
  return static_cast<int>(syscall(SYS_unlinkat, folder, name, flags));
}

namespace fusebench {

using namespace io;

namespace {

class AbandonedTest : public testing::InTemporaryFolder {
 protected:
  /// A file or folder as something that was last written so long ago.
  static void make_older(const std::filesystem::path& place, std::chrono::hours by) {
    std::filesystem::last_write_time(place, std::filesystem::file_time_type::clock::now() - by);
  }
  std::filesystem::path write_old(const std::string& name, int hours) const {
    const auto file = write(name, "half");
    make_older(file, std::chrono::hours(hours));
    return file;
  }
};

/// A lock as the process that writes there holds it.
class Held {
 public:
  explicit Held(const std::filesystem::path& place) : descriptor_(open(place.c_str(), O_RDONLY | O_CLOEXEC)) {
    EXPECT_EQ(flock(descriptor_, LOCK_EX | LOCK_NB), 0);
  }
  ~Held() { close(descriptor_); }
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;

 private:
  int descriptor_;
};

TEST_F(AbandonedTest, OnlyTemporaryFoldersOfThisProgramAreAbandonedOnes) {
  for (const char* ours : {".a.77.tmp/new/record.json", ".b.77-3.tmp/old/record.json", ".c.d.5.tmp/new/f"})
    write(ours, "");
  std::filesystem::create_directories(folder_ / ".c.d.5.tmp" / "old");
  const std::vector<std::string> theirs = {".notes.tmp/f",     ".rec1.tmp/full/01234567/record.json",
                                           ".a.78.tmp/note",   ".b.x7.tmp/new/f",
                                           ".77.tmp/new/f",    "a.77.tmp/new/f",
                                           ".a.77-.tmp/new/f", ".a.79.tmp/new"};
  for (const std::string& file : theirs) write(file, "theirs");
  const auto seen = remove_abandoned(folder_, true).removed;
  EXPECT_EQ(seen.size(), 3U);
  EXPECT_TRUE(std::filesystem::exists(folder_ / ".a.77.tmp"));
  auto removed = remove_abandoned(folder_).removed;
  std::ranges::sort(removed);
  const std::vector<std::filesystem::path> expected = {folder_ / ".a.77.tmp", folder_ / ".b.77-3.tmp",
                                                       folder_ / ".c.d.5.tmp"};
  EXPECT_EQ(removed, expected);
  for (const auto& path : expected) EXPECT_FALSE(std::filesystem::exists(path)) << path;
  for (const std::string& file : theirs) EXPECT_EQ(testing::read_bytes(folder_ / file), "theirs") << file;
}

TEST_F(AbandonedTest, WhatCannotBeRemovedIsNotCountedAsRemoved) {
  for (const char* file : {".a.77.tmp/new/record.json", ".b.77.tmp/new/log.txt"}) write(file, "half");
  const std::string name = "record.json";
  unremovable = &name;
  const Abandoned first = remove_abandoned(folder_);
  unremovable = nullptr;
  EXPECT_EQ(first.removed, std::vector{folder_ / ".b.77.tmp"});
  ASSERT_EQ(first.kept.size(), 1U);
  EXPECT_EQ(first.kept[0].path, folder_ / ".a.77.tmp");
  EXPECT_EQ(first.kept[0].reason, std::errc::permission_denied);
  EXPECT_TRUE(std::filesystem::exists(folder_ / ".a.77.tmp"));
  const Abandoned again = remove_abandoned(folder_);
  EXPECT_EQ(again.removed, std::vector{folder_ / ".a.77.tmp"});
  EXPECT_TRUE(again.kept.empty());
}

TEST_F(AbandonedTest, OfOneProcessThatHasEndedOnlyItsOwnGoes) {
  write(".run.77.tmp/new/frames.csv", "half");
  write(".run.77-1.tmp/new/frames.csv", "half");
  write(".run.78.tmp/new/frames.csv", "of another process");
  write(".other.77.tmp/new/frames.csv", "of another place");
  remove_abandoned_of(folder_ / "run", 77);
  EXPECT_FALSE(std::filesystem::exists(folder_ / ".run.77.tmp"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / ".run.77-1.tmp"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / ".run.78.tmp"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / ".other.77.tmp"));
  write(".run.77.tmp/new/frames.csv", "of a process of another machine with this number");
  const Held held(folder_ / ".run.77.tmp");
  remove_abandoned_of(folder_ / "run", 77);
  EXPECT_TRUE(std::filesystem::exists(folder_ / ".run.77.tmp"));
}

TEST_F(AbandonedTest, FilesOfDeadProcessesGoAfterAnHour) {
  const auto dead = write_old(".table.csv.77.tmp", 2);
  const auto again = write_old(".page.html.78-2.tmp", 2);
  const auto living = write_old(".other.csv.79.tmp", 2);
  const Held held(living);
  const auto just_now = write(".third.csv.80.tmp", "half");
  std::vector<std::filesystem::path> expected = {again, dead};
  EXPECT_EQ(remove_abandoned(folder_, true).removed.size(), 2U);
  EXPECT_TRUE(std::filesystem::exists(dead));
  auto removed = remove_abandoned(folder_).removed;
  std::ranges::sort(removed);
  EXPECT_EQ(removed, expected);
  EXPECT_FALSE(std::filesystem::exists(dead) || std::filesystem::exists(again));
  EXPECT_TRUE(std::filesystem::exists(living) && std::filesystem::exists(just_now));
}

TEST_F(AbandonedTest, OnlyPlainFilesWithNamesOfThisProgramGo) {
  const auto target = write_old("kept.txt", 30);
  std::filesystem::create_symlink(target, folder_ / ".link.77.tmp");
  std::filesystem::create_symlink(folder_ / "nowhere", folder_ / ".broken.77.tmp");
  std::filesystem::create_directories(folder_ / "elsewhere" / "new");
  std::filesystem::create_directory_symlink(folder_ / "elsewhere", folder_ / ".folder.77.tmp");
  ASSERT_EQ(mkfifo((folder_ / ".pipe.77.tmp").c_str(), 0600), 0);
  for (const char* name : {".notes.tmp", "table.77.tmp", ".77.tmp", ".a.x7.tmp", ".a.77-.tmp", ".a.77.tmp~",
                           ".tmp", ".a.b-77.tmp"})
    write_old(name, 30);
  EXPECT_TRUE(remove_abandoned(folder_).removed.empty());
  for (const char* name :
       {".link.77.tmp", ".broken.77.tmp", ".folder.77.tmp", ".pipe.77.tmp", ".tmp", "kept.txt"})
    EXPECT_TRUE(std::filesystem::exists(std::filesystem::symlink_status(folder_ / name))) << name;
}

TEST_F(AbandonedTest, AFileThatIsWrittenAgainTakesItsLeftoversAway) {
  const auto dead = write_old(".table.csv.77.tmp", 2);
  const auto living = write_old(".table.csv.78.tmp", 2);
  const Held held(living);
  const auto just_now = write(".table.csv.79.tmp", "half");
  const auto of_another = write_old(".other.csv.77.tmp", 30);
  ASSERT_FALSE(write_file_atomically(folder_ / "table.csv", "whole"));
  EXPECT_EQ(testing::read_bytes(folder_ / "table.csv"), "whole");
  EXPECT_FALSE(std::filesystem::exists(dead));
  for (const auto& file : {living, just_now, of_another})
    EXPECT_EQ(testing::read_bytes(file), "half") << file;
}

TEST_F(AbandonedTest, AFileUnderTheOwnNumberIsNotOverwritten) {
  const std::string own = ".table.csv." + std::to_string(getpid()) + ".tmp";
  const auto taken = write(own, "of another machine");
  ASSERT_FALSE(write_file_atomically(folder_ / "table.csv", "ours"));
  EXPECT_EQ(testing::read_bytes(folder_ / "table.csv"), "ours");
  EXPECT_EQ(testing::read_bytes(taken), "of another machine");
}

/// A run of another machine, whose locks may not be seen here, may write nothing for hours.
TEST_F(AbandonedTest, AFolderThatIsWrittenAgainTakesThoseOfYesterdayAway) {
  for (const char* file :
       {".0123.77.tmp/new/log.txt", ".0123.78.tmp/new/log.txt", ".0123.79.tmp/new/log.txt"})
    write_old(file, 30);
  for (const char* folder : {".0123.77.tmp", ".0123.78.tmp", ".0123.79.tmp"}) {
    make_older(folder_ / folder / "new", std::chrono::hours(30));
    make_older(folder_ / folder, std::chrono::hours(30));
  }
  make_older(folder_ / ".0123.78.tmp/new/log.txt", std::chrono::hours(2));
  const Held held(folder_ / ".0123.79.tmp");
  auto again = StagedFolder::create(folder_ / "0123");
  ASSERT_TRUE(again && again->commit());
  EXPECT_FALSE(std::filesystem::exists(folder_ / ".0123.77.tmp"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / ".0123.78.tmp"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / ".0123.79.tmp"));
}

}  // namespace
}  // namespace fusebench
