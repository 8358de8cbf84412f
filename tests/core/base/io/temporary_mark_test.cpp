#include "core/base/io/temporary_mark.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "core/base/io/staged_file.hpp"
#include "core/base/io/staged_folder.hpp"
#include "core/base/io/whole_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace io;

namespace {

namespace fs = std::filesystem;

class TemporaryMarkTest : public testing::InTemporaryFolder {
 protected:
  /// Runs work that ends its process, so that no destructor cleans up.
  static void in_a_process(const std::function<void()>& work) {
    const pid_t process = fork();
    if (process == 0) {
      work();
      _exit(1);
    }
    int status = -1;
    ASSERT_EQ(waitpid(process, &status, 0), process);
    ASSERT_EQ(status, 0);
  }
};

TEST_F(TemporaryMarkTest, RemovesAFileThatWasNotCommitted) {
  write("page.html", "old");
  in_a_process([&] {
    auto file = StagedFile::create(folder_ / "page.html");
    if (!file || write_whole_file(file->path(), "half")) _exit(1);
    remove_marked_places();
    _exit(0);
  });
  EXPECT_EQ(testing::read_bytes(folder_ / "page.html"), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(TemporaryMarkTest, RemovesAFolderThatWasNotCommittedWithTheParentsThatItMade) {
  write("kept/other", "mine");
  in_a_process([&] {
    auto folder = StagedFolder::create(folder_ / "kept" / "a" / "b" / "run");
    if (!folder || !folder->write("record.json", "{}")) _exit(1);
    fs::create_directories(folder->file("work") / "deep" / "er");
    fs::create_directory_symlink(folder_ / "kept", folder->file("link"));
    for (int i = 0; i < 200; ++i)
      if (write_whole_file(folder->file("work") / ("file_with_a_long_name_" + std::to_string(i)), "x"))
        _exit(1);
    remove_marked_places();
    _exit(0);
  });
  EXPECT_FALSE(fs::exists(folder_ / "kept" / "a"));
  EXPECT_EQ(testing::read_bytes(folder_ / "kept" / "other"), "mine") << "links are not followed";
}

TEST_F(TemporaryMarkTest, LeavesWhatWasCommittedAndParentsThatHoldSomethingElse) {
  in_a_process([&] {
    auto file = StagedFile::create(folder_ / "page.html");
    if (!file || write_whole_file(file->path(), "new") || file->commit()) _exit(1);
    auto first = StagedFolder::create(folder_ / "runs" / "first");
    if (!first || !first->write("record.json", "{}") || !first->commit()) _exit(1);
    auto second = StagedFolder::create(folder_ / "more" / "second");
    if (!second || write_whole_file(folder_ / "more" / "note", "mine")) _exit(1);
    remove_marked_places();
    _exit(0);
  });
  EXPECT_EQ(testing::read_bytes(folder_ / "page.html"), "new");
  EXPECT_TRUE(fs::exists(folder_ / "runs" / "first" / "record.json"));
  EXPECT_TRUE(fs::exists(folder_ / "more" / "note"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "more"), fs::directory_iterator()), 1);
}

TEST_F(TemporaryMarkTest, EndsWithItsOwnerAndMoves) {
  const fs::path kept = write("kept", "");
  const fs::path marked = write("marked", "");
  in_a_process([&] {
    { const TemporaryMark ended(TemporaryMark::Kind::file, kept); }
    TemporaryMark first(TemporaryMark::Kind::file, marked);
    const TemporaryMark second = std::move(first);
    remove_marked_places();
    _exit(0);
  });
  EXPECT_TRUE(fs::exists(kept));
  EXPECT_FALSE(fs::exists(marked));
}

TEST_F(TemporaryMarkTest, MoreThanThereIsRoomForAreNoError) {
  std::vector<TemporaryMark> marks;
  for (int i = 0; i < 2 * kMostMarks; ++i) marks.emplace_back(TemporaryMark::Kind::file, folder_ / "no_file");
  marks.clear();
  const fs::path file = write("marked", "");
  in_a_process([&] {
    const TemporaryMark mark(TemporaryMark::Kind::file, file);
    remove_marked_places();
    _exit(0);
  });
  EXPECT_FALSE(fs::exists(file));
}

}  // namespace
}  // namespace fusebench
