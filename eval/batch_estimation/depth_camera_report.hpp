// The depth camera of a recording, estimated from where edges of depth lie on those of colour.
#pragma once

#include <string>

#include "core/base/error.hpp"
#include "core/base/parallel.hpp"
#include "datasets/calibration/rig_calibration.hpp"
#include "datasets/inspection/measures/registration_fit.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::batch_estimation {

struct DepthCameraEstimate {
  inspection::measures::RegistrationFit fit;
  calibration::DepthCamera as_read;  ///< the calibration's; the colour camera, if depth counts as registered
  calibration::DepthCamera fitted;
};

/// Errors: run_failed if the images have too few edges.
[[nodiscard]] Result<DepthCameraEstimate> estimate_depth_camera(const recording::Recording& recording,
                                                                const Workers& workers);

/// The recording's calibration with the fitted depth camera.
[[nodiscard]] calibration::RigCalibration rig_with_depth_camera(const recording::Recording& recording,
                                                                const DepthCameraEstimate& estimate);

[[nodiscard]] std::string to_text(const DepthCameraEstimate& estimate, const recording::Recording& recording);
[[nodiscard]] std::string to_json(const DepthCameraEstimate& estimate, const recording::Recording& recording);

}  // namespace fusebench::batch_estimation
