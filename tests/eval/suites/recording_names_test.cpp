#include "eval/suites/recording_names.hpp"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace suites;

namespace {

class RecordingNames : public testing::InTemporaryFolder {
 protected:
  void add_recording(const std::string& name) {
    write(name + "/rgb.txt", "");
    write(name + "/depth.txt", "");
  }
};

TEST_F(RecordingNames, AreThoseOfFolders) {
  add_recording("data/fr1_rpy");
  EXPECT_EQ(*find_recording("fr1_rpy", folder_ / "data"), folder_ / "data" / "fr1_rpy");
  EXPECT_EQ(find_recording((folder_ / "data" / "fr1_rpy").string() + "/", {})->filename(), "fr1_rpy");
  const auto missing = find_recording("fr1_rpx", folder_ / "data");
  ASSERT_FALSE(missing.has_value());
  EXPECT_EQ(missing.error().code, ErrorCode::data_missing);
  EXPECT_NE(missing.error().hint.find("fr1_rpy"), std::string::npos);
  EXPECT_EQ(recordings_under(folder_ / "absent").error().code, ErrorCode::data_missing);
  for (const auto* name : {"fr1_xyy", "fr1*"})
    EXPECT_NE(find_recordings(name, folder_ / "absent").error().message.find("cannot be listed"),
              std::string::npos);
  std::filesystem::create_directories(folder_ / "empty" / "scene" / "inner");
  EXPECT_EQ(recordings_under(folder_ / "empty").error().code, ErrorCode::data_missing);
}

TEST_F(RecordingNames, MayLieOneLevelDeeper) {
  add_recording("data/scene/walk");
  add_recording("data/plain");
  add_recording("data/.hidden/walk2");
  add_recording("data/a/b/too_deep");
  const std::vector<std::filesystem::path> expected = {folder_ / "data" / "plain",
                                                       folder_ / "data" / "scene" / "walk"};
  EXPECT_EQ(recordings_under(folder_ / "data").value(), expected);
  EXPECT_EQ(find_recording("walk", folder_ / "data").value(), expected[1]);
  EXPECT_EQ(find_recording("scene/walk", folder_ / "data").value(), expected[1]);
}

TEST_F(RecordingNames, OfTheCatalogueAreFound) {
  add_recording("data/rgbd_dataset_freiburg1_desk");
  EXPECT_EQ(find_recording("fr1_desk", folder_ / "data").value(),
            folder_ / "data" / "rgbd_dataset_freiburg1_desk");
  // A folder of that very name goes first.
  add_recording("data/fr1_desk");
  EXPECT_EQ(find_recording("fr1_desk", folder_ / "data").value(), folder_ / "data" / "fr1_desk");

  const auto absent = find_recording("fr2_desk", folder_ / "data");
  ASSERT_FALSE(absent.has_value());
  EXPECT_EQ(absent.error().code, ErrorCode::data_missing);
  EXPECT_NE(absent.error().message.find("rgbd_dataset_freiburg2_desk"), std::string::npos)
      << absent.error().message;
  EXPECT_NE(absent.error().hint.find("fetch_datasets.sh fr2_desk"), std::string::npos) << absent.error().hint;
  // No address: the sentence says where it is published.
  EXPECT_NE(find_recording("dorm1_slow", folder_ / "data").error().hint.find("Google Drive"),
            std::string::npos);
  EXPECT_NE(find_recording("fr2_desk", {}).error().message.find("known recording"), std::string::npos);
  EXPECT_NE(find_recording("fr2_dsk", folder_ / "data").error().hint.find("did you mean fr2_desk"),
            std::string::npos);
}

TEST_F(RecordingNames, OfAMissingRecordingItIsSaidHowToGoOn) {
  add_recording("slow");
  const auto found = find_recordings("rgbd_dataset_freiburg1_rpy*", folder_);
  ASSERT_FALSE(found.has_value());
  EXPECT_NE(found.error().hint.find("fetch_datasets.sh"), std::string::npos) << found.error().hint;
  EXPECT_NE(found.error().hint.find("--only recording="), std::string::npos) << found.error().hint;
}

}  // namespace
}  // namespace fusebench
