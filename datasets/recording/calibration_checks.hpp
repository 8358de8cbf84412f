// Checks of a calibration against the images that it is of.
#pragma once

#include "core/base/error.hpp"
#include "datasets/calibration/rig_calibration.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::recording {

/// calibration: its colour camera has the size of the images; recording: its frames are in place. Errors
/// data_corrupt: a principal point outside of its image; a read-out longer than the median interval of its
/// images. Warnings: a focal length below 0.3 or above 5 times the width of its image; depth that is delayed
/// by more than 0.1 s.
[[nodiscard]] Result<void> check_calibration(const calibration::RigCalibration& calibration,
                                             Recording& recording);

}  // namespace fusebench::recording
