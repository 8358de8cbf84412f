#include "datasets/recording/formats/seven_scenes/seven_scenes.hpp"

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

constexpr std::string_view kPose = "1 0 0 0.5\n0 1 0 -0.25\n0 0 1 2\n0 0 0 1\n";

/// Three frames of a wall two metres before the depth camera.
class SevenScenes : public testing::InTemporaryFolder {
 protected:
  SevenScenes() {
    for (int k = 0; k < 3; ++k) write_frame(k, 640, 480);
    write("frame-000002.pose.txt", "-1.#IND -1.#IND 0 0\nnan nan nan -inf\n0 0 0 0\n0 0 0 1\n");
  }
  void write_frame(int k, int width, int height) const {
    EXPECT_TRUE(write_png(folder_ / fmt::format("frame-{:06}.color.png", k),
                          ColorImage(width, height, Rgb{9, 8, 7})));
    Image<std::uint16_t> depth(width, height, 2000);
    depth(0, 0) = 65535;
    depth(1, 0) = 0;
    EXPECT_TRUE(write_png(folder_ / fmt::format("frame-{:06}.depth.png", k), depth));
    write(fmt::format("frame-{:06}.pose.txt", k), kPose);
  }
  [[nodiscard]] Error refusal() const {
    const auto opened = open_recording(folder_);
    EXPECT_FALSE(opened);
    return opened ? Error{} : opened.error();
  }
};

TEST_F(SevenScenes, FramesCountAndPosesAreTheColourCameras) {
  EXPECT_EQ(recognise_format(folder_), "7scenes");
  const auto recording = open_recording(folder_);
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_EQ(recording->frames.size(), 3);
  EXPECT_EQ(recording->frames[2].timestamp_ns, 66'666'667);
  EXPECT_EQ(recording->rig.camera.fx_px, 525);
  ASSERT_TRUE(recording->calibration->depth);
  EXPECT_EQ(recording->calibration->depth->pinhole.fx_px, 585);
  ASSERT_EQ(recording->ground_truth.size(), 2) << "the third pose is no number";
  EXPECT_TRUE(any_contains(recording->warnings, "1 of 3 poses are no numbers"));
  EXPECT_TRUE(recording->truth_label.starts_with("pseudo ground truth: tracked by KinectFusion"));
  // A point of the depth camera is at one place of the world, whichever camera it is told from.
  const SE3 T_color_depth = recording->calibration->depth->T_color_depth;
  const Vector3d point_depth(0.2, -0.1, 1.5);
  const Vector3d by_color = recording->ground_truth[0].T_world_camera * (T_color_depth * point_depth);
  EXPECT_LT((by_color - (point_depth + Vector3d(0.5, -0.25, 2))).norm(), 1e-9);
}

TEST_F(SevenScenes, DepthIsRegisteredToColour) {
  const auto recording = open_recording(folder_);
  ASSERT_TRUE(recording) << recording.error().message;
  const auto frame = recording->load_frame(0);
  ASSERT_TRUE(frame) << frame.error().message;
  // The ray of a colour pixel meets the wall, z = 2 m in the depth camera.
  const SE3 T_depth_color = recording->calibration->depth->T_color_depth.inverse();
  for (const auto& [u, v] : {std::pair{320, 240}, std::pair{150, 100}, std::pair{500, 400}}) {
    const Vector3d direction = T_depth_color.rotation * recording->rig.camera.back_project(u, v, 1);
    const double expected_m = (2 - T_depth_color.translation.z()) / direction.z();
    EXPECT_NEAR(frame->depth_m(u, v), expected_m, 1e-3) << u << " " << v;
  }
  EXPECT_EQ(frame->depth_m(0, 0), 0) << "the colour camera sees more than the depth camera";
}

TEST_F(SevenScenes, ACameraOfItsOwnFileIsThatOfColourAndDepth) {
  write("camera-intrinsics.txt", "585 0 320\n0 585 240\n0 0 1\n");
  EXPECT_TRUE(open_recording(folder_)->calibration->depth) << "that of 7-Scenes' depth";
  write("camera-intrinsics.txt", "572.8 0 320\n0 542.7 240\n0 0 1\n");
  const auto recording = open_recording(folder_);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_FALSE(recording->calibration->depth);
  EXPECT_EQ(recording->rig.camera.fy_px, 542.7);
  EXPECT_EQ(recording->ground_truth[0].T_world_camera.translation, Vector3d(0.5, -0.25, 2));
  const auto frame = recording->load_frame(1);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->depth_m(0, 0), 0);
  EXPECT_EQ(frame->depth_m(1, 0), 0);
  EXPECT_EQ(frame->depth_m(2, 0), 2);
}

TEST_F(SevenScenes, WhatIsWrongIsNamed) {
  write("frame-000001.pose.txt", "1 0 0 0\n0 1 0\n");
  expect_contains(refusal().message, "frame-000001.pose.txt:2: expected 4 columns");
  write("frame-000001.pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n");
  expect_contains(refusal().message, "frame-000001.pose.txt: has 3 rows of the 4");
  write("frame-000001.pose.txt", "1 0 0 0\n0 1 0 0\n0 0 -1 0\n0 0 0 1\n");
  expect_contains(refusal().message, "frame-000001.pose.txt: the pose is no rigid transform");
  write("frame-000001.pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0.5 0 2 1\n");
  expect_contains(refusal().message, "the last row of 4x4 is 0 0 0 1");
  write("frame-000001.pose.txt", "1 0 0 x\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  expect_contains(refusal().message, "frame-000001.pose.txt:1: ");
  write("frame-000001.pose.txt", kPose);
  write("camera-intrinsics.txt", "585 1 320\n0 585 240\n0 0 1\n");
  expect_contains(refusal().message, "camera-intrinsics.txt: the camera's matrix is not");
  std::filesystem::remove(folder_ / "camera-intrinsics.txt");
  EXPECT_TRUE(write_png(folder_ / "frame-1.depth.png", Image<std::uint16_t>(8, 6, 1)));
  expect_contains(refusal().message, "two files of frame 1: frame-000001.depth.png and frame-1.depth.png");
  std::filesystem::remove(folder_ / "frame-1.depth.png");
  for (int k = 0; k < 3; ++k) std::filesystem::remove(folder_ / fmt::format("frame-{:06}.color.png", k));
  expect_contains(refusal().message, "no frame has both frame-<k>.color.png");
}

TEST_F(SevenScenes, ImagesOfAnotherSizeAreRefused) {
  write_frame(0, 320, 240);
  const Error error = refusal();
  EXPECT_EQ(error.code, ErrorCode::data_corrupt);
  expect_contains(error.message, "image of 320x240 pixels, but the camera's calibration is for 640x480");
}

}  // namespace
}  // namespace fusebench
