// The depth camera of a recording, estimated from where edges of depth lie on those of colour.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/base/error.hpp"
#include "core/base/parallel.hpp"
#include "datasets/calibration/rig_calibration.hpp"
#include "datasets/inspection/measures/registration_fit.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::inspection_report {

/// Focal lengths, centre, and place in the colour camera (metres).
[[nodiscard]] nlohmann::ordered_json camera_json(const calibration::DepthCamera& camera);
/// What was measured, without the cameras.
[[nodiscard]] nlohmann::ordered_json registration_json(const inspection::measures::RegistrationFit& fit);

/// Errors: run_failed if the images have too few edges.
[[nodiscard]] Result<inspection::measures::RegistrationFit> estimate_depth_camera(
    const recording::Recording& recording, const Workers& workers);

/// Error run_failed: the fit is no better than the camera that depth was read with, since another half of the
/// frames would move it as far, or too few of the frames gain by it. The measures are those of `inspect`.
[[nodiscard]] Result<void> check_determined(const inspection::measures::RegistrationFit& fit,
                                            const recording::Recording& recording);

/// The recording's calibration with the fitted depth camera.
[[nodiscard]] calibration::RigCalibration rig_with_depth_camera(
    const recording::Recording& recording, const inspection::measures::RegistrationFit& fit);

[[nodiscard]] std::string depth_camera_text(const inspection::measures::RegistrationFit& fit,
                                            const recording::Recording& recording);
[[nodiscard]] std::string depth_camera_json(const inspection::measures::RegistrationFit& fit,
                                            const recording::Recording& recording);

}  // namespace fusebench::inspection_report
