// The sensor.yaml files of EuRoC MAV's folders.
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "datasets/calibration/rig_calibration.hpp"

namespace fusebench::formats::euroc {

/// Of a folder that holds cam0, and depth0 and imu0 if they are there.
struct EurocRig {
  calibration::RigCalibration calibration;
  SE3 T_body_color;
  bool imu_is_body = false;
};

/// Errors, with file:line: data_missing (cam0/sensor.yaml), data_corrupt (a key that is missing or no number,
/// a T_BS that is no rigid transform, a camera model other than pinhole, a distortion that
/// distortion_model.hpp does not support, depth with a distortion of its own).
[[nodiscard]] Result<EurocRig> read_euroc_rig(const std::filesystem::path& mav0);

}  // namespace fusebench::formats::euroc
