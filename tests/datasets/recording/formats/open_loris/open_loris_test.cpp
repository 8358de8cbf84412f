#include "datasets/recording/formats/open_loris/open_loris.hpp"

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

using testing::expect_contains;

constexpr std::string_view kSensors = R"(%YAML:1.0
# published so
d400_color_optical_frame:
   sensor_type: camera
   fps: 30
   width: 8
   height: 6
   model: pinhole
   intrinsics: !!opencv-matrix
      rows: 1
      cols: 4
      dt: d
      data: [ 10., 3.5,
          11., 2.5 ]
   distortion_model: radial-tangential
   distortion_coefficients: !!opencv-matrix
      rows: 1
      cols: 4
      data: [ 0., 0., 0., 0. ]
)";
constexpr std::string_view kTransforms = R"(%YAML:1.0
trans_matrix:
 -
   parent_frame: base_link
   child_frame: laser
   matrix: !!opencv-matrix
      rows: 4
      cols: 4
      data: [ 1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0.25, 0, 0, 0, 1 ]
 -
   parent_frame: d400_color_optical_frame
   child_frame: laser
   matrix: !!opencv-matrix
      data: [ 0, -1, 0, 0, 0, 0, -1, 0, 1, 0, 0, 0, 0, 0, 0, 1 ]
 - { parent_frame: d400_color_optical_frame, child_frame: d400_gyroscope,
     matrix: !!opencv-matrix { rows: 4, cols: 4, data: [1,0,0,0.125, 0,1,0,0, 0,0,1,0, 0,0,0,1] } }
)";

class OpenLoris : public testing::InTemporaryFolder {
 protected:
  OpenLoris() {
    std::string color;
    std::string depth;
    for (int k = 0; k < 3; ++k) {
      write(fmt::format("color/{}.png", k), "");
      write(fmt::format("aligned_depth/{}.png", k), "");
      EXPECT_TRUE(write_png(folder_ / "color" / fmt::format("{}.png", k), ColorImage(8, 6, Rgb{9, 8, 7})));
      EXPECT_TRUE(
          write_png(folder_ / "aligned_depth" / fmt::format("{}.png", k), Image<std::uint16_t>(8, 6, 1500)));
      color += fmt::format("100.{} color/{}.png\n", k, k);
      depth += fmt::format("100.{}01 aligned_depth/{}.png\n", k, k);
    }
    write("color.txt", "#Timestamp Filename\n" + color);
    write("aligned_depth.txt", depth);
    write("sensors.yaml", kSensors);
    write("trans_matrix.yaml", kTransforms);
    write("groundtruth.txt", "#T\n99.9 0 0 0 0 0 0 1\n100.3 1 2 3 0 0 0 1\n");
    std::string samples;
    for (int i = 0; i < 80; ++i) samples += fmt::format("{:.3f} 0.1 -9.8 0.2\n", 99.9 + 0.005 * i);
    write("d400_gyroscope.txt", "# t x y z\n" + samples);
    write("d400_accelerometer.txt", samples);
  }
};

TEST_F(OpenLoris, IsReadAsPublished) {
  EXPECT_EQ(recognise_format(folder_), "openloris");
  const auto recording = open_recording(folder_);
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_EQ(recording->frames.size(), 3);
  EXPECT_EQ(recording->rig.camera.fx_px, 10) << "intrinsics go fx, cx, fy, cy";
  EXPECT_EQ(recording->rig.camera.fy_px, 11);
  EXPECT_EQ(recording->rig.camera.cx_px, 3.5);
  EXPECT_EQ(recording->load_frame(0)->depth_m(3, 3), 1.5F) << "millimetres";
  EXPECT_EQ(recording->imu.size(), 80);
  EXPECT_EQ(recording->rig.T_imu_camera.translation, Vector3d(-0.125, 0, 0));
  EXPECT_GT(recording->rig.imu_noise.gyroscope_radps_sqrthz, 0);
}

TEST_F(OpenLoris, PosesOfTheRobotBecomeThoseOfTheCamera) {
  const auto recording = open_recording(folder_);
  ASSERT_TRUE(recording) << recording.error().message;
  const SE3 T_world_color = recording->ground_truth[1].T_world_camera;
  EXPECT_LT((T_world_color.translation - Vector3d(1.5, 2, 3.25)).norm(), 1e-9) << "where the laser is";
  // The camera looks along the robot's x.
  EXPECT_LT((T_world_color.rotation * Vector3d(0, 0, 1) - Vector3d(1, 0, 0)).norm(), 1e-9);
  EXPECT_LT((T_world_color.rotation * Vector3d(1, 0, 0) - Vector3d(0, -1, 0)).norm(), 1e-9);
}

TEST_F(OpenLoris, ModelOfDistortionIsRead) {
  std::string sensors(kSensors);
  const auto replace = [&](std::string_view from, std::string_view to) {
    sensors.replace(sensors.find(from), from.size(), to);
    write("sensors.yaml", sensors);
  };
  replace("data: [ 0., 0., 0., 0. ]", "data: [ 0.25, 0., 0., 0. ]");
  replace("distortion_model: radial-tangential", "distortion_model: plumb_bob");
  EXPECT_EQ(open_recording(folder_).value().calibration->color.distortion.k1, 0.25);
  replace("distortion_model: plumb_bob", "distortion_model: kannala_brandt");
  const auto refused = open_recording(folder_);
  ASSERT_FALSE(refused);
  expect_contains(refused.error().message,
                  "sensors.yaml:15: distortion model kannala_brandt is not supported");
}

TEST_F(OpenLoris, WhatIsWrongIsNamed) {
  const auto refusal = [&] {
    const auto opened = open_recording(folder_);
    EXPECT_FALSE(opened);
    return opened ? std::string() : opened.error().message;
  };
  write("trans_matrix.yaml",
        "trans_matrix:\n - parent_frame: a\n   child_frame: b\n   matrix: { data: [1, 2] }\n");
  expect_contains(refusal(),
                  "trans_matrix.yaml:4: trans_matrix.0.matrix.data must be a list of 16 finite numbers");
  write("trans_matrix.yaml", "# nothing\n");
  expect_contains(refusal(),
                  "trans_matrix.yaml: no chain of transforms from base_link to d400_color_optical_frame");
  write("sensors.yaml", "d400_color_optical_frame:\n  width: 8\n  intrinsics: [1, 2, 3]\n");
  expect_contains(refusal(), "sensors.yaml: needs the key d400_color_optical_frame.intrinsics.data");
}

}  // namespace
}  // namespace fusebench
