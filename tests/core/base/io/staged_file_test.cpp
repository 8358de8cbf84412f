#include "core/base/io/staged_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <iterator>
#include <string>

#include "core/base/io/whole_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace io;

namespace {

namespace fs = std::filesystem;

class StagedFileTest : public testing::InTemporaryFolder {
 protected:
  [[nodiscard]] std::ptrdiff_t count() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }
};

TEST_F(StagedFileTest, HasItsNameOnceItIsCommitted) {
  write("mesh.ply", "old");
  auto file = StagedFile::create(folder_ / "mesh.ply");
  ASSERT_TRUE(file);
  EXPECT_TRUE(is_staged_file(file->path()));
  ASSERT_FALSE(write_whole_file(file->path(), "new"));
  EXPECT_EQ(testing::read_bytes(folder_ / "mesh.ply"), "old");
  ASSERT_FALSE(file->commit());
  EXPECT_EQ(testing::read_bytes(folder_ / "mesh.ply"), "new");
  EXPECT_EQ(count(), 1);
}

TEST_F(StagedFileTest, LeavesNothingWithoutACommit) {
  {
    auto file = StagedFile::create(folder_ / "mesh.ply");
    ASSERT_TRUE(file);
    ASSERT_FALSE(write_whole_file(file->path(), "half"));
    EXPECT_EQ(count(), 1);
  }
  EXPECT_EQ(count(), 0);
  EXPECT_EQ(StagedFile::create(folder_ / "absent" / "mesh.ply").error(),
            std::errc::no_such_file_or_directory);
}

TEST_F(StagedFileTest, ReplacesALinkAndNotItsTarget) {
  write("others.ply", "old");
  for (const char* const target : {"others.ply", "nowhere", "/dev/null"}) {
    fs::create_symlink(target, folder_ / "link.ply");
    ASSERT_FALSE(write_file_atomically(folder_ / "link.ply", "new")) << target;
    EXPECT_FALSE(fs::is_symlink(folder_ / "link.ply")) << target;
    EXPECT_EQ(testing::read_bytes(folder_ / "link.ply"), "new") << target;
    fs::remove(folder_ / "link.ply");
  }
  EXPECT_EQ(testing::read_bytes(folder_ / "others.ply"), "old");
  EXPECT_FALSE(fs::exists(folder_ / "nowhere"));
  EXPECT_EQ(count(), 1);
}

TEST_F(StagedFileTest, FollowsALinkAmongTheFoldersAboveIt) {
  fs::create_directory(folder_ / "disk");
  fs::create_directory_symlink("disk", folder_ / "results");
  ASSERT_FALSE(write_file_atomically(folder_ / "results" / "mesh.ply", "new"));
  EXPECT_EQ(testing::read_bytes(folder_ / "disk" / "mesh.ply"), "new");
  EXPECT_EQ(write_file_atomically(folder_ / "results", "new"), std::errc::is_a_directory);
  EXPECT_TRUE(fs::is_symlink(folder_ / "results"));
}

TEST_F(StagedFileTest, WritesToADeviceAndToAnOpenFileOfTheProcess) {
  ASSERT_FALSE(write_file_atomically("/dev/null", "new"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  const fs::path target = write("output.txt", "old");
  const int descriptor = open(target.c_str(), O_WRONLY);
  ASSERT_GE(descriptor, 0);
  ASSERT_FALSE(write_file_atomically("/proc/self/fd/" + std::to_string(descriptor), "new"));
  close(descriptor);
  EXPECT_EQ(testing::read_bytes(target), "new");
  EXPECT_EQ(count(), 1);
}

}  // namespace
}  // namespace fusebench
