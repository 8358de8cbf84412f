#include "core/staged_folder.hpp"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace fusebench {
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

}  // namespace
}  // namespace fusebench
