#include "datasets/recording/exports/orbslam3_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "datasets/recording/exports/sensor_tables.hpp"

namespace fusebench::exports {

namespace {

// The distance between projector and camera of structured-light sensors; the reader makes a virtual second
// image with it.
constexpr double kBaseline_m = 0.075;

std::string imu_settings(const recording::Recording& recording) {
  std::string text = "\n# camera to IMU\nIMU.T_b_c1: !!opencv-matrix\n  rows: 4\n  cols: 4\n  dt: f\n" +
                     matrix_yaml(recording.rig.T_imu_camera);
  const ImuNoise& noise = recording.rig.imu_noise;
  fmt::format_to(std::back_inserter(text),
                 "IMU.InsertKFsWhenLost: 0\n"
                 "# rad/s/sqrt(Hz), m/s^2/sqrt(Hz), rad/s^2/sqrt(Hz), m/s^3/sqrt(Hz), Hz\n"
                 "IMU.NoiseGyro: {:#}\nIMU.NoiseAcc: {:#}\nIMU.GyroWalk: {:#}\nIMU.AccWalk: {:#}\n"
                 "IMU.Frequency: {:#}\n",
                 noise.gyroscope_radps_sqrthz, noise.accelerometer_mps2_sqrthz,
                 noise.gyroscope_bias_radps2_sqrthz, noise.accelerometer_bias_mps3_sqrthz,
                 std::round(imu_rate_hz(recording)));
  return text;
}

}  // namespace

std::string matrix_yaml(const SE3& T) {
  const Matrix3d R = T.rotation_matrix();
  std::string text = "  data: [";
  for (int row = 0; row < 3; ++row) {
    fmt::format_to(std::back_inserter(text), "{:#}, {:#}, {:#}, {:#},\n         ", R(row, 0), R(row, 1),
                   R(row, 2), T.translation[row]);
  }
  return text + "0.0, 0.0, 0.0, 1.0]\n";
}

std::string orbslam3_settings(const recording::Recording& recording, const DepthStorage& depth) {
  const PinholeCamera& camera = recording.rig.camera;
  std::string text = fmt::format(
      "%YAML:1.0\n---\nFile.version: \"1.0\"\n\nCamera.type: \"PinHole\"\n"
      "Camera1.fx: {:#}\nCamera1.fy: {:#}\nCamera1.cx: {:#}\nCamera1.cy: {:#}\n"
      "Camera1.k1: 0.0\nCamera1.k2: 0.0\nCamera1.p1: 0.0\nCamera1.p2: 0.0\n"
      "Camera.width: {}\nCamera.height: {}\nCamera.fps: {}\n"
      "# 0: BGR, the order in which OpenCV reads image files\nCamera.RGB: 0\n\n"
      "Stereo.ThDepth: 40.0\nStereo.b: {:#}\nRGBD.DepthMapFactor: {:#}\n",
      camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px, camera.width_px, camera.height_px,
      std::max(1L, std::lround(frame_rate_hz(recording))), kBaseline_m, depth.units_per_metre);
  if (!recording.imu.empty()) text += imu_settings(recording);
  text +=
      "\nORBextractor.nFeatures: 1000\nORBextractor.scaleFactor: 1.2\nORBextractor.nLevels: 8\n"
      "ORBextractor.iniThFAST: 20\nORBextractor.minThFAST: 7\n\n"
      "Viewer.KeyFrameSize: 0.05\nViewer.KeyFrameLineWidth: 1.0\nViewer.GraphLineWidth: 0.9\n"
      "Viewer.PointSize: 2.0\nViewer.CameraSize: 0.08\nViewer.CameraLineWidth: 3.0\n"
      "Viewer.ViewpointX: 0.0\nViewer.ViewpointY: -0.7\nViewer.ViewpointZ: -1.8\nViewer.ViewpointF: 500.0\n";
  return text;
}

}  // namespace fusebench::exports
