// Formats that are folders of PNGs: TUM, Open3D, EuRoC.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "datasets/images/image_files.hpp"
#include "datasets/open_recording.hpp"
#include "datasets/recording/exports/export_recording.hpp"
#include "datasets/recording/reading/side_files.hpp"
#include "datasets/recording/state_truth.hpp"
#include "tests/datasets/recording/exports/made_recording.hpp"
#include "tests/support/expect_text.hpp"

namespace fusebench {

using namespace exports;
using testing::expect_contains;
using testing::made_frame;
using testing::made_recording;

namespace {

class FolderExports : public testing::InTemporaryFolder {
 protected:
  const std::filesystem::path out_ = folder_ / "room";
  [[nodiscard]] std::string text(std::string_view name) const { return testing::read_bytes(out_ / name); }
  void export_to(ExportFormat format, const recording::Recording& recording) const {
    const auto done = export_recording(recording, format, out_);
    ASSERT_TRUE(done) << done.error().message;
  }
  static recording::Recording with_imu(int count) {
    recording::Recording recording = made_recording(8, 6, count);
    testing::add_made_imu(recording);
    return recording;
  }
};

TEST_F(FolderExports, TumIsReadBackAsTheRecording) {
  recording::Recording recording = with_imu(4);
  recording.simulated = true;
  recording.truth_label = recording::kPseudoGroundTruth;
  recording.accelerometer = {{testing::kMadeFirst_ns, {0.5, -9.75, 0.25}}};
  recording.state_truth = {{testing::kMadeFirst_ns, {}}};
  recording.state_truth[0].state.velocity_world_mps = {0.5, 0.25, -1};
  export_to(ExportFormat::tum, recording);
  const auto read = datasets::open_recording(out_);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->format, "tum");
  EXPECT_TRUE(read->simulated);
  EXPECT_EQ(read->truth_label, recording::kPseudoGroundTruth);
  EXPECT_EQ(read->rig.camera.fx_px, 525);
  EXPECT_EQ(read->rig.imu_noise.accelerometer_mps2_sqrthz, 0.02);
  EXPECT_LT(pose_minus(read->rig.T_imu_camera, recording.rig.T_imu_camera).norm(), 1e-12);
  ASSERT_EQ(read->frames.size(), 4);
  ASSERT_EQ(read->imu.size(), recording.imu.size());
  for (std::size_t i = 0; i < read->imu.size(); ++i) {
    EXPECT_EQ(read->imu[i].timestamp_ns, recording.imu[i].timestamp_ns);
    EXPECT_EQ(read->imu[i].angular_velocity_radps, recording.imu[i].angular_velocity_radps);
  }
  ASSERT_EQ(read->accelerometer.size(), 1);
  EXPECT_EQ(read->accelerometer[0].specific_force_mps2, Vector3d(0.5, -9.75, 0.25));
  ASSERT_EQ(read->state_truth.size(), 1);
  EXPECT_EQ(read->state_truth[0].state.velocity_world_mps, Vector3d(0.5, 0.25, -1));
  ASSERT_EQ(read->ground_truth.size(), 4);
  EXPECT_EQ(read->ground_truth[3].T_world_camera.translation, Vector3d(0.75, -0.5, 2));
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(read->frames[k].timestamp_ns, recording.frames[k].timestamp_ns);
    EXPECT_EQ(read->frames[k].depth_timestamp_ns, recording.frames[k].depth_timestamp_ns);
    const auto frame = read->load_frame(k);
    ASSERT_TRUE(frame) << frame.error().message;
    const RgbdFrame made = made_frame(8, 6, static_cast<int>(k));
    EXPECT_EQ(frame->color.data, made.color.data);
    for (std::size_t i = 0; i < made.depth_m.data.size(); ++i) {
      const float depth_m = made.depth_m.data[i];
      EXPECT_EQ(frame->depth_m.data[i], depth_m > 13.107F || depth_m < 0.0001F ? 0 : depth_m) << i;
    }
  }
}

TEST_F(FolderExports, TumListsPairColourFirst) {
  export_to(ExportFormat::tum, made_recording(8, 6, 2));
  EXPECT_EQ(text("associations.txt"),
            "1000.000000000 rgb/1000.000000000.png 1000.002000000 depth/1000.002000000.png\n"
            "1000.040000000 rgb/1000.040000000.png 1000.042000000 depth/1000.042000000.png\n");
  expect_contains(text("groundtruth.txt"), "1000.040000000 0.25 -0.5 2 0 0 0 1\n");
  expect_contains(text("orbslam3.yaml"), "RGBD.DepthMapFactor: 5000.0\n");
  EXPECT_EQ(text("orbslam3.yaml").find("IMU."), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(out_ / "imu.csv"));
  EXPECT_FALSE(std::filesystem::exists(out_ / "simulation.toml"));
}

TEST_F(FolderExports, TumRefusesDepthImagesOfOneStamp) {
  recording::Recording recording = made_recording(8, 6, 2);
  recording.frames[1].depth_timestamp_ns = recording.frames[0].depth_timestamp_ns;
  const auto done = export_recording(recording, ExportFormat::tum, out_);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::data_corrupt);
  expect_contains(done.error().message, "depth images of frames 0 and 1");
}

TEST_F(FolderExports, Orbslam3SettingsHaveTheCameraInTheImu) {
  export_to(ExportFormat::tum, with_imu(2));
  const std::string yaml = text("orbslam3.yaml");
  expect_contains(yaml, "%YAML:1.0\n---\nFile.version: \"1.0\"\n");
  expect_contains(yaml, "Camera1.fx: 525.0\nCamera1.fy: 524.5\nCamera1.cx: 3.5\nCamera1.cy: 2.25\n");
  expect_contains(yaml, "Camera.width: 8\nCamera.height: 6\nCamera.fps: 25\n");
  expect_contains(yaml, "0.125,\n");
  expect_contains(yaml, "-0.25,\n");
  expect_contains(yaml, "0.0, 0.0, 0.0, 1.0]\n");
  expect_contains(yaml,
                  "IMU.NoiseGyro: 0.001\nIMU.NoiseAcc: 0.02\nIMU.GyroWalk: 5.e-05\nIMU.AccWalk: 0.0006\n"
                  "IMU.Frequency: 100.0\n");
}

TEST_F(FolderExports, Open3dHasEqualNumbersOfImagesNamedByNumber) {
  export_to(ExportFormat::open3d, made_recording(8, 6, 3));
  std::vector<std::string> names;
  for (const auto& [name, bytes] : testing::files_below(out_)) names.push_back(name);
  EXPECT_EQ(names, (std::vector<std::string>{"color/000000.png", "color/000001.png", "color/000002.png",
                                             "config.json", "depth/000000.png", "depth/000001.png",
                                             "depth/000002.png", "frame_times.txt", "intrinsic.json"}));
  for (int k = 0; k < 3; ++k) {
    const std::string name = "00000" + std::to_string(k) + ".png";
    const RgbdFrame made = made_frame(8, 6, k);
    EXPECT_EQ(images::read_color(out_ / "color" / name).value().data, made.color.data);
    EXPECT_EQ(images::read_depth16(out_ / "depth" / name).value().data,
              testing::stored_depth(made, 1000, 65535).data);
  }
}

TEST_F(FolderExports, Open3dIntrinsicsAreColumnByColumn) {
  export_to(ExportFormat::open3d, made_recording(8, 6, 1));
  const auto intrinsic = nlohmann::json::parse(text("intrinsic.json"));
  EXPECT_EQ(intrinsic["width"], 8);
  EXPECT_EQ(intrinsic["height"], 6);
  EXPECT_EQ(intrinsic["intrinsic_matrix"].get<std::vector<double>>(),
            (std::vector<double>{525, 0, 0, 0, 524.5, 0, 3.5, 2.25, 1}));
  const auto config = nlohmann::json::parse(text("config.json"));
  EXPECT_EQ(config["depth_scale"], 1000);
  EXPECT_EQ(config["path_dataset"], ".");
  EXPECT_EQ(config["path_intrinsic"], "intrinsic.json");
}

TEST_F(FolderExports, EurocHasItsTablesAndImages) {
  export_to(ExportFormat::euroc, with_imu(2));
  EXPECT_EQ(text("mav0/cam0/data.csv"),
            "#timestamp [ns],filename\n1000000000000,1000000000000.png\n1000040000000,1000040000000.png\n");
  EXPECT_EQ(text("times.txt"), "1000000000000\n1000040000000\n");
  expect_contains(text("mav0/imu0/data.csv"), "\n999900000000,0.5,-0.25,0,0,0,9.75\n");
  expect_contains(text("mav0/cam0/sensor.yaml"), "intrinsics: [525.0, 524.5, 3.5, 2.25]");
  expect_contains(text("mav0/imu0/sensor.yaml"), "gyroscope_noise_density: 0.001 ");
  const RgbdFrame made = made_frame(8, 6, 1);
  EXPECT_EQ(images::read_grey(out_ / "mav0/cam0/data/1000040000000.png").value().data, made.grey.data);
  EXPECT_EQ(images::read_depth16(out_ / "mav0/depth0/data/1000040000000.png").value().data,
            testing::stored_depth(made, 1000, 65535).data);
  const auto imu = reading::read_imu_table(out_ / "mav0/imu0/data.csv", io::TimeUnit::nanoseconds);
  ASSERT_TRUE(imu) << imu.error().message;
  EXPECT_EQ(imu->size(), 41);
}

TEST_F(FolderExports, EurocPosesAreOfTheImu) {
  export_to(ExportFormat::euroc, with_imu(2));
  // The camera at (0, -0.5, 2), turned as the world; x of the IMU is the camera's z, y is -x, z is -y. The
  // IMU lies at -R^T t = -(0.25, -0.5, 0.125) in the camera: R^T = rows (0 -1 0), (0 0 -1), (1 0 0).
  const std::string truth = text("mav0/state_groundtruth_estimate0/data.csv");
  expect_contains(truth, "\n1000000000000,-0.25,0,1.875,0.5,");
  EXPECT_EQ(std::ranges::count(truth.substr(truth.find('\n') + 1), ','), 2 * 7);
}

TEST_F(FolderExports, EurocStatesAreReadBack) {
  recording::Recording recording = with_imu(2);
  filter::StampedState state{testing::kMadeFirst_ns, {}};
  state.state.T_world_imu = {so3_exp({0.1, 0.2, 0.3}), {1, 2, 3}};
  state.state.velocity_world_mps = {0.5, 0.25, -1};
  state.state.accelerometer_bias_mps2 = {0.125, 0, 0};
  recording.state_truth = {state};
  export_to(ExportFormat::euroc, recording);
  const auto read = recording::read_state_truth(out_ / "mav0/state_groundtruth_estimate0/data.csv");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), 1);
  EXPECT_LT(pose_minus(read->front().state.T_world_imu, state.state.T_world_imu).norm(), 1e-12);
  EXPECT_EQ(read->front().state.velocity_world_mps, state.state.velocity_world_mps);
  EXPECT_EQ(read->front().state.accelerometer_bias_mps2, state.state.accelerometer_bias_mps2);
}

TEST_F(FolderExports, EurocWithoutImuIsOfTheCamera) {
  export_to(ExportFormat::euroc, made_recording(8, 6, 2));
  EXPECT_FALSE(std::filesystem::exists(out_ / "mav0/imu0"));
  expect_contains(text("mav0/state_groundtruth_estimate0/data.csv"), "\n1000040000000,0.25,-0.5,2,1,0,0,0\n");
}

}  // namespace
}  // namespace fusebench
