#include "datasets/recording/formats/euroc/euroc_folder.hpp"

#include <gtest/gtest.h>

#include "datasets/open_recording.hpp"
#include "datasets/recording/exports/export_recording.hpp"
#include "tests/datasets/recording/exports/made_recording.hpp"
#include "tests/support/expect_text.hpp"

namespace fusebench {

using namespace recording;
using namespace exports;
using namespace datasets;

namespace {

using testing::expect_contains;
using testing::made_frame;

class EurocFolder : public testing::InTemporaryFolder {
 protected:
  const std::filesystem::path place_ = folder_ / "room";
  void export_made(bool with_imu) const {
    Recording recording = testing::made_recording(16, 12, 4);
    if (with_imu) testing::add_made_imu(recording);
    const auto done = export_recording(recording, ExportFormat::euroc, place_);
    ASSERT_TRUE(done) << done.error().message;
  }
  void replace(const std::string& name, std::string_view from, std::string_view to) const {
    std::string text = testing::read_bytes(place_ / name);
    const std::size_t at = text.find(from);
    ASSERT_NE(at, text.npos) << from;
    write("room/" + name, text.replace(at, from.size(), to));
  }
  [[nodiscard]] std::string refusal() const {
    const auto opened = open_recording(place_);
    EXPECT_FALSE(opened);
    return opened ? std::string() : opened.error().message;
  }
};

TEST_F(EurocFolder, WhatIsExportedIsReadBack) {
  export_made(true);
  EXPECT_EQ(recognise_format(place_), "euroc");
  for (const auto& place : {place_, place_ / "mav0"}) {
    const auto read = open_recording(place);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->rig.camera.fx_px, 525);
    EXPECT_EQ(read->rig.camera.fy_px, 524.5);
    EXPECT_FALSE(read->calibration->depth);
    Recording made = testing::made_recording(16, 12, 4);
    testing::add_made_imu(made);
    EXPECT_LT(pose_minus(read->rig.T_imu_camera, made.rig.T_imu_camera).norm(), 1e-9);
    EXPECT_EQ(read->rig.imu_noise.gyroscope_bias_radps2_sqrthz, 0.00005);
    ASSERT_EQ(read->imu.size(), made.imu.size());
    EXPECT_EQ(read->imu[7].specific_force_mps2, made.imu[7].specific_force_mps2);
    ASSERT_EQ(read->ground_truth.size(), 4);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(read->frames[k].timestamp_ns, made.frames[k].timestamp_ns);
      EXPECT_LT(pose_minus(read->ground_truth[k].T_world_camera, made.ground_truth[k].T_world_camera).norm(),
                1e-9);
      const auto frame = read->load_frame(k);
      ASSERT_TRUE(frame) << frame.error().message;
      const RgbdFrame original = made_frame(16, 12, static_cast<int>(k));
      EXPECT_EQ(frame->grey.data, original.grey.data);
      EXPECT_EQ(frame->color(3, 2), (Rgb{original.grey(3, 2), original.grey(3, 2), original.grey(3, 2)}));
      EXPECT_EQ(frame->depth_m(5, 5), original.depth_m(5, 5));
    }
  }
}

TEST_F(EurocFolder, WithoutAnImuPosesAreTheCameras) {
  export_made(false);
  const auto read = open_recording(place_);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->imu_source, ImuSource::none);
  EXPECT_EQ(read->ground_truth[3].T_world_camera.translation, Vector3d(0.75, -0.5, 2));
}

TEST_F(EurocFolder, ADepthCameraOfItsOwnIsRegistered) {
  export_made(false);
  replace("mav0/depth0/sensor.yaml", "0.0,\n         0.0, 1.0", "0.125,\n         0.0, 1.0");
  const auto read = open_recording(place_);
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_TRUE(read->calibration->depth);
  EXPECT_EQ(read->calibration->depth->T_color_depth.translation, Vector3d(0.125, 0, 0));
}

TEST_F(EurocFolder, StereoAloneIsRefusedWithWhatIsMissing) {
  export_made(false);
  std::filesystem::remove_all(place_ / "mav0" / "depth0");
  const auto refused = open_recording(place_);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::data_missing);
  expect_contains(refused.error().message, "mav0: there is no depth0/data.csv beside cam0");
  expect_contains(refused.error().hint, "depth images are needed");
}

TEST_F(EurocFolder, WhatIsWrongIsNamed) {
  export_made(true);
  replace("mav0/cam0/sensor.yaml", "intrinsics: [525.0, ", "intrinsics: [-525.0, ");
  expect_contains(refusal(), "cam0/sensor.yaml:15: focal lengths must be above 0");
  replace("mav0/cam0/sensor.yaml", "intrinsics: [-525.0, ", "intrinsics: [525.0, 1, ");
  expect_contains(refusal(), "cam0/sensor.yaml:15: intrinsics must be a list of 4 finite numbers");
  replace("mav0/cam0/sensor.yaml", "intrinsics: [525.0, 1, ", "intrinsics: [525.0, ");
  replace("mav0/cam0/sensor.yaml", "camera_model: pinhole", "camera_model: omni");
  expect_contains(refusal(),
                  "cam0/sensor.yaml:14: camera_model omni is not supported (supported is pinhole)");
  replace("mav0/cam0/sensor.yaml", "camera_model: omni", "camera_model: pinhole");
  replace("mav0/cam0/sensor.yaml", "radial-tangential", "equidistant");
  EXPECT_TRUE(open_recording(place_)) << "without a distortion the model does not matter";
  replace("mav0/cam0/sensor.yaml", "distortion_coefficients: [0.0,", "distortion_coefficients: [0.1,");
  expect_contains(refusal(), "cam0/sensor.yaml:16: distortion model equidistant is not supported");
  replace("mav0/cam0/sensor.yaml", "equidistant", "radtan");
  const auto radtan = open_recording(place_);
  ASSERT_TRUE(radtan) << radtan.error().message;
  EXPECT_EQ(radtan->calibration->color.distortion.k1, 0.1);
  replace("mav0/cam0/sensor.yaml", "coefficients: [0.1,", "coefficients: [0.1, x,");
  expect_contains(refusal(), "sensor.yaml:17: distortion_coefficients must be a list of finite numbers");
  replace("mav0/cam0/sensor.yaml", "coefficients: [0.1, x,", "coefficients: [0.1,");
  replace("mav0/imu0/sensor.yaml", "gyroscope_noise_density: 0.001", "gyroscope_noise_density: 0");
  expect_contains(refusal(), "imu0/sensor.yaml:13: gyroscope_noise_density must be a density above 0");
  replace("mav0/imu0/sensor.yaml", "gyroscope_noise_density: 0", "gyroscope_noise_density: 0.001");
  replace("mav0/cam0/data.csv", "1000040000000,1000040000000.png", "1000040000000,none.png");
  expect_contains(refusal(), "cam0/data.csv:3: image none.png does not exist");
}

}  // namespace
}  // namespace fusebench
