// The IMU of Intel's RealSense cameras, whose recordings say where it sits and not how noisy it is.
#pragma once

#include <string_view>

#include "core/base/types.hpp"

namespace fusebench::reading {

/// The ZR300, D435i and D455 have the same chip, Bosch's BMI055: the noise of FMDataset's ZR300
/// (configs/recordings/zr300_fmdataset.toml). The variances that the firmware gives are no densities.
[[nodiscard]] ImuNoise realsense_imu_noise();

inline constexpr std::string_view kRealsenseNoiseSource =
    "the IMU's noise is that of FMDataset's ZR300, which has the same chip";

}  // namespace fusebench::reading
