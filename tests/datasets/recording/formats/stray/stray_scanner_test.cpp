#include "datasets/recording/formats/stray/stray_scanner.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "datasets/images/image_files.hpp"
#include "datasets/open_recording.hpp"
#include "datasets/recording/formats/stray/stray_tables.hpp"
#include "tests/support/expect_text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace images;
using namespace recording;
using namespace formats::stray;
using namespace datasets;

namespace {

using testing::any_contains;
using testing::expect_contains;

constexpr std::string_view kImuCalibration =
    "[color]\nfx_px = 26.6\nfy_px = 26.6\ncx_px = 15.5\ncy_px = 11.5\n[depth]\nwidth_px = 8\nheight_px = 6\n"
    "fx_px = 6.65\nfy_px = 6.65\ncx_px = 3.5\ncy_px = 2.5\nT_color_depth = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, "
    "0]\n"
    "[imu]\nT_imu_color = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]\ngyroscope_noise_radps_sqrthz = 1e-3\n"
    "accelerometer_noise_mps2_sqrthz = 1e-2\ngyroscope_bias_walk_radps2_sqrthz = 1e-5\n"
    "accelerometer_bias_walk_mps3_sqrthz = 1e-4\n";

/// Three frames: colour of 32x24 pixels (of a video of 1920x1440), depth of 8x6.
class StrayScanner : public testing::InTemporaryFolder {
 protected:
  StrayScanner() {
    std::string odometry = "timestamp, frame, x, y, z, qx, qy, qz, qw, fx, fy, cx, cy, more, more\n";
    for (int k = 0; k < 3; ++k) {
      for (const char* folder : {"rgb", "depth", "confidence"})
        write(fmt::format("{}/{:06}.png", folder, k), "");
      EXPECT_TRUE(write_png(file("rgb", k), ColorImage(32, 24, Rgb{9, 8, 7})));
      EXPECT_TRUE(write_png(file("depth", k), Image<std::uint16_t>(8, 6, 2000)));
      GreyImage levels(8, 6, 2);
      levels(0, 0) = 0;
      EXPECT_TRUE(write_png(file("confidence", k), levels));
      odometry += fmt::format("{}, {:06}, {}, 0.5, 0, 0, 0, 0, 1.0, 1600, 1600, 959.5, 719.5, , \n",
                              100 + k / 32.0, k, k);
    }
    write("odometry.csv", odometry);
    write("camera_matrix.csv", "1600.0, 0.0, 959.5\n0.0, 1600.0, 719.5\n0.0, 0.0, 1.0");
  }
  [[nodiscard]] std::filesystem::path file(const char* folder, int k) const {
    return folder_ / folder / fmt::format("{:06}.png", k);
  }
  void write_imu(double gravity) const {
    std::string text = "timestamp, a_x, a_y, a_z, alpha_x, alpha_y, alpha_z\n";
    for (int i = 0; i < 30; ++i)
      text += fmt::format("{:.3f}, 0.0, 0.0, {}, 0.1, 0.2, 0.3\n", 99.9 + 0.01 * i, -gravity);
    write("imu.csv", text);
  }
  [[nodiscard]] Error refusal() const {
    const auto opened = open_recording(folder_);
    EXPECT_FALSE(opened);
    return opened ? Error{} : opened.error();
  }
};

TEST_F(StrayScanner, CameraIsScaledToTheImagesAndDepthRegistered) {
  EXPECT_EQ(recognise_format(folder_), "stray");
  const auto recording = open_recording(folder_);
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_EQ(recording->frames.size(), 3);
  EXPECT_EQ(recording->frames[1].timestamp_ns, 100'031'250'000);
  EXPECT_NEAR(recording->rig.camera.fx_px, 1600.0 / 60, 1e-9);
  EXPECT_NEAR(recording->rig.camera.cx_px, 960.0 / 60 - 0.5, 1e-9);
  ASSERT_TRUE(recording->calibration->depth);
  EXPECT_NEAR(recording->calibration->depth->pinhole.fx_px, 1600.0 / 240, 1e-9);
  EXPECT_EQ(recording->ground_truth[2].T_world_camera.translation, Vector3d(2, 0.5, 0));
  EXPECT_TRUE(recording->truth_label.starts_with("pseudo ground truth: ARKit"));
  const auto frame = recording->load_frame(0);
  ASSERT_TRUE(frame) << frame.error().message;
  EXPECT_EQ(frame->depth_m.width, 32);
  EXPECT_EQ(frame->depth_m(16, 12), 2);
  EXPECT_EQ(frame->depth_m(1, 1), 0) << "of confidence 0";
  EXPECT_EQ(frame->depth_m(6, 1), 2);
}

TEST_F(StrayScanner, AccelerationsOfBothVersionsBecomeSpecificForce) {
  write("calibration.toml", kImuCalibration);
  for (const auto& [gravity, unit] : {std::pair{1.0, "in g"}, std::pair{9.80665, "in m/s^2"}}) {
    write_imu(gravity);
    const auto recording = open_recording(folder_);
    ASSERT_TRUE(recording) << recording.error().message;
    ASSERT_EQ(recording->imu.size(), 30);
    EXPECT_NEAR(recording->imu[0].specific_force_mps2.z(), 9.80665, 1e-9) << "on a table, screen upwards";
    EXPECT_EQ(recording->imu[0].angular_velocity_radps, Vector3d(0.1, 0.2, 0.3));
    EXPECT_TRUE(any_contains(recording->notes, unit));
  }
  write_imu(0.01);
  const auto without = open_recording(folder_);
  ASSERT_TRUE(without);
  EXPECT_TRUE(without->imu.empty());
  EXPECT_TRUE(any_contains(without->warnings, "neither the length of gravity in g nor in m/s^2"));
}

TEST_F(StrayScanner, ACalibrationWithoutADepthCameraGetsThatOfColourScaled) {
  write("calibration.toml",
        "[color]\nfx_px = 26\nfy_px = 28\ncx_px = 15.5\ncy_px = 11.5\n[imu]\n"
        "T_imu_color = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]\ngyroscope_noise_radps_sqrthz = 1e-3\n"
        "accelerometer_noise_mps2_sqrthz = 1e-2\ngyroscope_bias_walk_radps2_sqrthz = 1e-5\n"
        "accelerometer_bias_walk_mps3_sqrthz = 1e-4\n");
  write_imu(1);
  const auto recording = open_recording(folder_);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->imu.size(), 30);
  ASSERT_TRUE(recording->calibration->depth);
  EXPECT_EQ(recording->calibration->depth->pinhole.width_px, 8);
  EXPECT_EQ(recording->calibration->depth->pinhole.fx_px, 6.5);
  EXPECT_EQ(recording->calibration->depth->pinhole.fy_px, 7);
  const auto frame = recording->load_frame(0);
  ASSERT_TRUE(frame) << frame.error().message;
  EXPECT_EQ(frame->depth_m(16, 12), 2);
}

TEST_F(StrayScanner, DepthOfAnotherSizeThanItsCameraIsRefusedOnce) {
  std::string calibration(kImuCalibration);
  const std::string_view size = "width_px = 8\nheight_px = 6";
  write("calibration.toml",
        calibration.replace(calibration.find(size), size.size(), "width_px = 4\nheight_px = 3"));
  const Error error = refusal();
  EXPECT_EQ(error.code, ErrorCode::data_corrupt);
  expect_contains(error.message, "depth of 8x6 pixels, but the depth camera of the calibration has 4x3");
  expect_contains(error.hint, "[depth] of a calibration.toml");
}

TEST_F(StrayScanner, AVideoIsNotDecodedAndTheCommandIsSaid) {
  std::filesystem::remove_all(folder_ / "rgb");
  const Error error = refusal();
  EXPECT_EQ(error.code, ErrorCode::data_missing);
  expect_contains(error.message, "rgb.mp4: videos are not decoded");
  expect_contains(error.hint, "ffmpeg -noautorotate -i rgb.mp4");
}

TEST_F(StrayScanner, FramesNumberedFromOneAreRefused) {
  for (int k = 3; k > 0; --k) std::filesystem::rename(file("rgb", k - 1), file("rgb", k));
  const Error error = refusal();
  expect_contains(error.message, "colour is numbered from 1, but depth from 0");
  expect_contains(error.hint, "-start_number 0");
}

TEST_F(StrayScanner, RotatedImagesAreRefused) {
  for (int k = 0; k < 3; ++k) EXPECT_TRUE(write_png(file("rgb", k), ColorImage(24, 32, Rgb{9, 8, 7})));
  expect_contains(refusal().message, "odometry.csv: the centre (959.5, 719.5) is not that of a video");
  expect_contains(refusal().hint, "-noautorotate");
}

TEST_F(StrayScanner, FocalLengthsThatChangeAreNamedAndTheMedianIsUsed) {
  std::string odometry = "timestamp, frame, x, y, z, qx, qy, qz, qw, fx, fy, cx, cy, distortion_center_x\n";
  for (const auto& [k, f_px] : {std::pair{0, 1440}, std::pair{1, 1500}, std::pair{2, 1590}})
    odometry += fmt::format("{}, {}, 0, 0, 0, 0, 0, 0, 1, {}, {}, 959.5, 719.5, 960\n", 100 + k / 32.0, k,
                            f_px, f_px);
  write("odometry.csv", odometry);
  const auto recording = open_recording(folder_);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_NEAR(recording->rig.camera.fx_px, 1500.0 / 60, 1e-9) << "camera_matrix.csv is the last frame's";
  EXPECT_TRUE(any_contains(recording->warnings,
                           "odometry.csv: the focal length changes by 10.0 % (from 1440.0 "
                           "px in frame 0 to 1590.0 px in frame 2)"));
  EXPECT_TRUE(any_contains(recording->warnings, "odometry.csv: columns distortion_center_x are not used"));
  write("calibration.toml", kImuCalibration);
  EXPECT_TRUE(any_contains(open_recording(folder_)->warnings, "focal length changes"))
      << "a calibration is one camera too";
}

TEST_F(StrayScanner, CameraMatrixIsUsedWhereFramesHaveNoIntrinsics) {
  write("camera_matrix.csv", "1500.0, 0.0, 959.5\n0.0, 1500.0, 719.5\n0.0, 0.0, 1.0");
  EXPECT_NEAR(open_recording(folder_)->rig.camera.fx_px, 1600.0 / 60, 1e-9);
  const std::string names = "timestamp, frame, x, y, z, qx, qy, qz, qw";
  for (const std::string more : {"", ", fx, fy, cx, cy"}) {
    write("odometry.csv",
          names + more + "\n1, 0, 0, 0, 0, 0, 0, 0, 1" + (more.empty() ? "" : ", , , , ") + "\n");
    const auto recording = open_recording(folder_);
    ASSERT_TRUE(recording) << recording.error().message;
    EXPECT_NEAR(recording->rig.camera.fx_px, 1500.0 / 60, 1e-9);
  }
  write("odometry.csv", names + ", fx, fy, cx, cy\n1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 2, 3\n");
  expect_contains(refusal().message, "odometry.csv:2: focal lengths fx and fy must be above 0");
  write("odometry.csv", names + ", fx, fy, cx, cy\n1, 0, 0, 0, 0, 0, 0, 0, 1, nan, 1, 2, 3\n");
  expect_contains(refusal().message, "odometry.csv:2: fx: expected a finite number, got 'nan'");
}

TEST_F(StrayScanner, WhatIsWrongIsNamed) {
  const std::string good = testing::read_bytes(folder_ / "odometry.csv");
  write("odometry.csv", "1, 0, 0, 0, 0, 0, 0, 0, 1\n");
  expect_contains(refusal().message,
                  "odometry.csv:1: expected the line of names that begins with: timestamp, frame");
  write("odometry.csv", "timestamp, frame, x, y, z, qx, qy, qz, qw\n");
  expect_contains(refusal().message, "odometry.csv: has no rows");
  write("odometry.csv",
        "timestamp, frame, x, y, z, qx, qy, qz, qw\n1, 0, 0, 0, 0, 0, 0, 0, 1\n1, 1, 0, 0, 0, 0, 0, 0, 1\n");
  expect_contains(refusal().message, "odometry.csv:3: times and numbers of frames must both rise");
  write("odometry.csv", "timestamp, frame, x, y, z, qx, qy, qz, qw\n1, 0, 0, 0, 0, 0, 0, 0, 0\n");
  expect_contains(refusal().message, "odometry.csv:2: the quaternion");
  write("odometry.csv", "timestamp, frame, x, y, z, qx, qy, qz, qw\n1, 0, 0, 0, 0, 0, 0, 0\n");
  expect_contains(refusal().message, "odometry.csv:2: expected 9 columns: timestamp frame x y");
  write("odometry.csv", good);
  write("imu.csv", "timestamp, a_x, a_y, a_z, alpha_x, alpha_y, alpha_z\n2,0,0,1,0,0,0\n1,0,0,1,0,0,0\n");
  expect_contains(refusal().message, "imu.csv:3: time runs backwards");
  std::filesystem::remove(folder_ / "imu.csv");
  EXPECT_TRUE(write_png(file("confidence", 1), GreyImage(4, 4)));
  const auto opened = open_recording(folder_);
  ASSERT_TRUE(opened) << opened.error().message;
  expect_contains(opened->load_frame(1).error().message,
                  "confidence/000001.png: expected 8x6 pixels, got 4x4");
}

}  // namespace
}  // namespace fusebench
