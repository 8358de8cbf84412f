#include "datasets/recording/formats/record3d/record3d_export.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "datasets/images/image_files.hpp"
#include "datasets/open_recording.hpp"
#include "tests/datasets/images/child_process.hpp"
#include "tests/support/expect_text.hpp"
#include "tests/support/repository.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace images;
using namespace recording;
using namespace datasets;

namespace {

using testing::expect_contains;

/// Two frames: colour of 8x6 pixels, depth of 4x3 in floats of 32 and of 16 bits.
class Record3d : public testing::InTemporaryFolder {
 protected:
  Record3d() {
    const auto golden = testing::repository_root() / "tests" / "golden" / "record3d";
    write("EXR_RGBD/depth/0.exr", testing::read_bytes(golden / "float.exr"));
    write("EXR_RGBD/depth/1.exr", testing::read_bytes(golden / "half.exr"));
    for (const char* name : {"0", "1"}) {
      const auto jpeg = encode_jpeg(ColorImage(8, 6, Rgb{200, 100, 50}), 95);
      EXPECT_TRUE(jpeg);
      write(fmt::format("EXR_RGBD/rgb/{}.jpg", name),
            {reinterpret_cast<const char*>(jpeg->data()), jpeg->size()});
    }
    write_metadata("[0, 0, 0, 1, 0, 0, 0], [0, 0, 0.70710678, 0.70710678, 1, 2, 3]", "");
  }
  void write_metadata(std::string_view poses, std::string_view more) const {
    write("EXR_RGBD/metadata.json",
          fmt::format(
              R"({{"w": 8, "h": 6, "dw": 4, "dh": 3, "fps": 60, "K": [10, 0, 0, 0, 11, 0, 3.5, 2.5, 1], )"
              R"("poses": [{}]{}}})",
              poses, more));
  }
  [[nodiscard]] std::string refusal() const {
    const auto opened = open_recording(folder_);
    EXPECT_FALSE(opened);
    return opened ? std::string() : opened.error().message;
  }
};

TEST_F(Record3d, ARateOfZeroIsNotUsed) {
  write_metadata("[0, 0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 1, 2, 3]", R"(, "fps": 0)");
  const auto recording = open_recording(folder_);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->frames[1].timestamp_ns, 33'333'333);
  EXPECT_TRUE(testing::any_contains(recording->warnings, "metadata.json: fps = 0 is not used"));
}

TEST_F(Record3d, DepthInMetresAndPosesOfACameraWithYUp) {
  EXPECT_EQ(recognise_format(folder_), "record3d");
  EXPECT_EQ(recognise_format(folder_ / "EXR_RGBD"), "record3d");
  const auto recording = open_recording(folder_);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->frames[1].timestamp_ns, 16'666'667) << "fps";
  EXPECT_EQ(recording->rig.camera.fy_px, 11);
  EXPECT_EQ(recording->calibration->depth->pinhole.fx_px, 5);
  for (std::size_t k = 0; k < 2; ++k) {
    const auto frame = recording->load_frame(k);
    ASSERT_TRUE(frame) << frame.error().message;
    EXPECT_EQ(frame->depth_m(0, 2), 0) << "-1 m is no measurement";
    EXPECT_NEAR(frame->depth_m(5, 2), 1, 1e-3);
    EXPECT_NEAR(frame->depth_m(7, 2), 2, 1e-3);
  }
  // ARKit's camera looks along -z, with y up: forwards is -z of the first frame, and down is -y.
  const SE3& first = recording->ground_truth[0].T_world_camera;
  EXPECT_LT((first.rotation * Vector3d(0, 0, 1) - Vector3d(0, 0, -1)).norm(), 1e-9);
  EXPECT_LT((first.rotation * Vector3d(0, 1, 0) - Vector3d(0, -1, 0)).norm(), 1e-9);
  const SE3& second = recording->ground_truth[1].T_world_camera;
  EXPECT_LT((second * Vector3d(1, 0, 0) - Vector3d(1, 3, 3)).norm(), 1e-6) << "turned about z by 90 degrees";
  EXPECT_TRUE(recording->truth_label.starts_with("pseudo ground truth: ARKit"));
}

TEST_F(Record3d, FocalLengthsOfEachFrameAreNamedAndTheMedianIsUsed) {
  write_metadata("",
                 R"(, "perFrameIntrinsicCoeffs": [[10, 11, 3, 2], [11, 12, 3.25, 2.25]], "lens": "wide")");
  const auto recording = open_recording(folder_);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->rig.camera.fx_px, 11);
  EXPECT_EQ(recording->rig.camera.cy_px, 2.25);
  EXPECT_EQ(recording->rig.camera.width_px, 8);
  EXPECT_TRUE(testing::any_contains(recording->warnings, "metadata.json: the focal length changes by 9.1 %"));
  EXPECT_TRUE(testing::any_contains(recording->warnings, "metadata.json: not used: lens"));
  write_metadata("", R"(, "perFrameIntrinsicCoeffs": [[10, 11, 3]])");
  expect_contains(refusal(), "perFrameIntrinsicCoeffs[0], a list of 4 finite numbers");
}

TEST_F(Record3d, TheGivenFrameRateReplacesThatOfTheFile) {
  ReadOptions options;
  options.frame_rate_hz = 50;
  EXPECT_EQ(open_recording(folder_, {"", options}).value().frames[1].timestamp_ns, 20'000'000);
}

/// A run is a process that is forked from the engine, which has opened the recording: threads that the
/// decoder had there are none that it has here.
TEST_F(Record3d, AForkedProcessDecodesAsItsParentDid) {
  const auto recording = open_recording(folder_);
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_TRUE(recording->load_frame(0));
  const testing::ChildResult result = testing::run_in_child(std::size_t{1} << 30, [&] {
    alarm(60);  // it waited for ever
    const auto frame = recording->load_frame(1);
    return frame ? std::string("decoded") : frame.error().message;
  });
  EXPECT_TRUE(result.ended_well);
  EXPECT_EQ(result.text, "decoded");
}

TEST_F(Record3d, TheFrontCameraHasNoPosesAndStampsGoBeforeTheRate) {
  write_metadata("[0, 0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0, 0]", R"(, "frameTimestamps": [10.5, 10.75])");
  const auto recording = open_recording(folder_);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_TRUE(recording->ground_truth.empty());
  EXPECT_EQ(recording->frames[1].timestamp_ns, 10'750'000'000);
}

TEST_F(Record3d, PackedRecordingsAreRefusedWithWhatUnpacksThem) {
  for (const auto& [name, remedy] :
       {std::pair{"room.r3d", "EXR + RGB"}, {"room.mkv", "azure_kinect_mkv_reader.py"}}) {
    const auto refused = open_recording(write(name, "any"));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::configuration);
    EXPECT_NE(refused.error().message.find("are not read"), std::string::npos) << refused.error().message;
    EXPECT_NE(refused.error().hint.find(remedy), std::string::npos) << refused.error().hint;
  }
}

TEST_F(Record3d, WhatIsWrongIsNamed) {
  write_metadata("[0, 0, 0, 1, 0, 0, 0]", "");
  EXPECT_TRUE(open_recording(folder_)) << "one pose does not move, and counts as none";
  write_metadata("[0, 0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0]", "");
  expect_contains(refusal(), "metadata.json: needs the key poses[1], a list of 7 finite numbers");
  write_metadata("[0, 0, 0, 0, 0, 0, 0]", "");
  expect_contains(refusal(), "metadata.json: poses[0]: its quaternion");
  write_metadata("", R"(, "frameTimestamps": [2, 1])");
  expect_contains(refusal(), "metadata.json: frameTimestamps do not rise at frame 1");
  write_metadata("", R"(, "frameTimestamps": [2])");
  expect_contains(refusal(), "metadata.json: frameTimestamps has 1 entries, but there is a frame 1");
  write_metadata("", "");
  write("EXR_RGBD/depth/0.exr", "no EXR");
  expect_contains(refusal(), "depth/0.exr: ");
  EXPECT_TRUE(write_png(folder_ / "EXR_RGBD" / "depth" / "0.exr", GreyImage(4, 3)));
  expect_contains(refusal(), "depth/0.exr: ");
}

}  // namespace
}  // namespace fusebench
