// The names that files give to models of lens distortion.
#pragma once

#include <span>
#include <string_view>

#include "core/base/error.hpp"
#include "datasets/calibration/camera_model.hpp"

namespace fusebench::calibration {

/// Distortion by the name of its model and its coefficients in OpenCV's order, k1 k2 p1 p2 [k3 ...], of which
/// those behind k3 must be 0. Supported is the radial-tangential model under the names of EuRoC
/// (radial-tangential), Kalibr (radtan), ROS (plumb_bob) and others (brown_conrady, opencv); case, spaces,
/// hyphens and underscores do not count, and no name means this model. Coefficients that are all 0 are no
/// distortion, whatever the name. Errors: data_corrupt (another model, more coefficients; the message has
/// neither file nor line).
[[nodiscard]] Result<BrownConrady> distortion_of_model(std::string_view model,
                                                       std::span<const double> coefficients);

}  // namespace fusebench::calibration
