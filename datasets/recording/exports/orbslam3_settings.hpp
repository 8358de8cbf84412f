// The settings file of ORB-SLAM3 (Campos et al., T-RO 2021), in its version 1.0.
#pragma once

#include <string>

#include "datasets/recording/exports/export_summary.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::exports {

/// YAML with camera (pixels, no distortion), depth factor, IMU if the recording has one (T_b_c1 =
/// T_imu_camera, continuous-time densities, rate), and ORB and viewer keys at the values of ORB-SLAM3's own
/// TUM files. Real numbers have a decimal point: its reader takes nothing else for one.
[[nodiscard]] std::string orbslam3_settings(const recording::Recording& recording, const DepthStorage& depth);

/// "  data: [...]": a pose as the rows of a 4x4 matrix.
[[nodiscard]] std::string matrix_yaml(const SE3& T);

}  // namespace fusebench::exports
