#include "core/io/staged_file.hpp"

#include <gtest/gtest.h>

#include <iterator>

#include "core/io/whole_file.hpp"
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

TEST_F(StagedFileTest, FollowsALinkAndWritesToADevice) {
  write("kept.ply", "old");
  fs::create_symlink("kept.ply", folder_ / "link.ply");
  ASSERT_FALSE(write_file_atomically(folder_ / "link.ply", "new"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.ply"));
  EXPECT_EQ(testing::read_bytes(folder_ / "kept.ply"), "new");
  fs::create_symlink("nowhere", folder_ / "broken.ply");
  EXPECT_EQ(write_file_atomically(folder_ / "broken.ply", "new"), std::errc::no_such_file_or_directory);
  fs::create_symlink("/dev/null", folder_ / "device.ply");
  ASSERT_FALSE(write_file_atomically(folder_ / "device.ply", "new"));
  EXPECT_TRUE(fs::is_character_file(folder_ / "device.ply"));
  EXPECT_EQ(count(), 4);
}

}  // namespace
}  // namespace fusebench
