// The depth camera of a recording, measured by edges of depth on edges of colour
// (datasets/inspection/measures/registration_fit.hpp), and its use in place of the calibration's.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "datasets/inspection/measures/registration_fit.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::preparation {

struct MeasuredDepthCamera {
  calibration::DepthCamera as_read;
  calibration::DepthCamera fitted;
  inspection::measures::DepthCameraSigma sigma;  ///< of fitted
  double moved_px = 0;                           ///< by fitted in place of as_read, rms over edges of depth
  double sigma_px = 0;                           ///< of that
  bool is_used = false;  ///< significant, with a gain that is no chance; else as_read is kept
};

[[nodiscard]] MeasuredDepthCamera measured_depth_camera(const inspection::measures::RegistrationFit& fit);

/// One line: what was measured, with standard deviations, and what is used.
[[nodiscard]] std::string to_line(const MeasuredDepthCamera& measured);

[[nodiscard]] nlohmann::ordered_json json_of(const MeasuredDepthCamera& measured);
/// Throws Json::exception where the document is damaged.
[[nodiscard]] MeasuredDepthCamera depth_camera_of(const nlohmann::ordered_json& json);

/// Does nothing unless measured.is_used. Depth of every loaded frame, which is on the colour image by
/// as_read, is registered to it by fitted; the recording's calibration has fitted, and a note says so.
void use_depth_camera(recording::Recording& recording, const MeasuredDepthCamera& measured);

}  // namespace fusebench::preparation
