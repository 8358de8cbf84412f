// calib.txt: InfiniTAM's calibration file, with the two blocks that FMDataset's authors added to it. Numbers
// separated by white space; '%' and '#' begin a comment.
//
//     640 480                     colour: width, height
//     608.446 607.847             fx fy
//     331.332 245.549             cx cy
//     640 480 ...                 depth, the same
//     r11 r12 r13 tx ...          T_color_depth, 3x4 row-major, metres
//     r11 r12 r13 tx ...          T_imu_depth (added)
//     affine 0.001 0.0            metres = 0.001 * value
//     4e-7 5.88e-4 2.5e-9 1.22e-6 variances (added): accelerometer bias and noise, gyroscope bias and noise
//
// Beware: InfiniTAM takes the third block for the inverse, colour to depth. Here it is what FMDataset's file
// means by it.
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "datasets/calibration/rig_calibration.hpp"

namespace fusebench::calibration {

/// Reads such a file; without the two added blocks (InfiniTAM's own layout) there is no IMU in it. It has no
/// place for distortion, so there is none in the result. Errors, with file:line: data_missing; data_corrupt
/// (too few or too many numbers, a value out of range, a matrix that is no rigid transform, a depth scale
/// that is not affine with zero offset).
[[nodiscard]] Result<RigCalibration> read_infinitam_calibration(const std::filesystem::path& file);

}  // namespace fusebench::calibration
