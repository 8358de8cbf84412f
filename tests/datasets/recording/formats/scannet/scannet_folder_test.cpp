#include "datasets/recording/formats/scannet/scannet_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "datasets/images/image_files.hpp"
#include "datasets/open_recording.hpp"
#include "tests/support/expect_text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace images;
using namespace recording;
using namespace datasets;

namespace {

using testing::any_contains;
using testing::expect_contains;

constexpr std::string_view kColorMatrix = "20 0 7.5 0\n0 21 5.5 0\n0 0 1 0\n0 0 0 1\n";
constexpr std::string_view kDepthMatrix = "10 0 3.5 0\n0 11 2.5 0\n0 0 1 0\n0 0 0 1\n";
constexpr std::string_view kIdentity = "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";

/// Frames 0, 1 and 10: colour of 16x12 pixels, depth of 8x6 at 1.5 m.
class ScanNetFolder : public testing::InTemporaryFolder {
 protected:
  ScanNetFolder() {
    for (const int k : {0, 1, 10}) {
      const auto jpeg = encode_jpeg(ColorImage(16, 12, Rgb{200, 100, 50}), 95);
      EXPECT_TRUE(jpeg);
      write(fmt::format("color/{}.jpg", k), {reinterpret_cast<const char*>(jpeg->data()), jpeg->size()});
      write(fmt::format("depth/{}.png", k), "");
      EXPECT_TRUE(write_png(folder_ / "depth" / fmt::format("{}.png", k), Image<std::uint16_t>(8, 6, 1500)));
      write(fmt::format("pose/{}.txt", k), fmt::format("1 0 0 {}\n0 1 0 0.5\n0 0 1 2\n0 0 0 1\n", k));
    }
    write("intrinsic/intrinsic_color.txt", kColorMatrix);
    write("intrinsic/intrinsic_depth.txt", kDepthMatrix);
    write("intrinsic/extrinsic_color.txt", "1 0 0 0.25\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    write("intrinsic/extrinsic_depth.txt", kIdentity);
  }
  [[nodiscard]] std::string refusal() const {
    const auto opened = open_recording(folder_);
    EXPECT_FALSE(opened);
    return opened ? std::string() : opened.error().message;
  }
};

TEST_F(ScanNetFolder, FramesCamerasAndPoses) {
  EXPECT_EQ(recognise_format(folder_), "scannet");
  const auto recording = open_recording(folder_);
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_EQ(recording->frames.size(), 3);
  EXPECT_EQ(recording->frames[2].timestamp_ns, 333'333'333) << "frame 10 comes after 1";
  EXPECT_EQ(recording->rig.camera.fx_px, 20);
  ASSERT_TRUE(recording->calibration->depth);
  EXPECT_EQ(recording->calibration->depth->pinhole.fy_px, 11);
  EXPECT_EQ(recording->calibration->depth->pinhole.width_px, 8);
  EXPECT_LT((recording->calibration->depth->T_color_depth.translation - Vector3d(-0.25, 0, 0)).norm(), 1e-12);
  ASSERT_EQ(recording->ground_truth.size(), 3);
  EXPECT_LT((recording->ground_truth[1].T_world_camera.translation - Vector3d(1.25, 0.5, 2)).norm(), 1e-12)
      << "poses are of depth";
  EXPECT_TRUE(recording->truth_label.starts_with("pseudo ground truth: BundleFusion"));
  const auto frame = recording->load_frame(0);
  ASSERT_TRUE(frame) << frame.error().message;
  EXPECT_EQ(frame->depth_m.width, 16);
}

TEST_F(ScanNetFolder, LostPosesAreCounted) {
  write("pose/1.txt", "-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf\n");
  const auto recording = open_recording(folder_);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->ground_truth.size(), 2);
  EXPECT_TRUE(any_contains(recording->warnings, "1 of 3 poses are no numbers"));
}

TEST_F(ScanNetFolder, OneCameraWhereColourHasNoMatrix) {
  std::filesystem::remove(folder_ / "intrinsic/intrinsic_color.txt");
  expect_contains(refusal(), "image of 16x12 pixels, but the camera's calibration is for 8x6");
  for (const char* name : {"0", "1", "10"}) {
    const auto jpeg = encode_jpeg(ColorImage(8, 6, Rgb{200, 100, 50}), 95);
    write(fmt::format("color/{}.jpg", name), {reinterpret_cast<const char*>(jpeg->data()), jpeg->size()});
  }
  const auto recording = open_recording(folder_);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->rig.camera.fx_px, 10);
  EXPECT_FALSE(recording->calibration->depth);
}

TEST_F(ScanNetFolder, WhatIsWrongIsNamed) {
  write("intrinsic/intrinsic_depth.txt", "1 0 0\n0 1 0\n0 0 1\n");
  expect_contains(refusal(), "intrinsic_depth.txt:1: expected 4 columns");
  write("intrinsic/intrinsic_depth.txt", kDepthMatrix);
  write("pose/1.txt", "2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1\n");
  expect_contains(refusal(), "pose/1.txt: the pose is no rigid transform");
}

}  // namespace
}  // namespace fusebench
