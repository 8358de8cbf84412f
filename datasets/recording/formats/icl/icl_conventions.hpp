// What both packings of ICL-NUIM have in common: the camera and left-handed poses.
//
// The renderer's camera looks along z with x to the right and y UP, a left-handed frame; that is what the
// published fy = -480 says. The images themselves are stored top-down like any other, so a camera with y down
// has fy = +480, and poses are reflected: T_cv = F T F with F = diag(1, -1, 1). Both halves are needed. With
// one of them the trajectory looks plausible and is wrong, since no rigid alignment absorbs a reflection.
#pragma once

#include "core/base/geometry.hpp"
#include "datasets/calibration/rig_calibration.hpp"

namespace fusebench::formats::icl {

/// F T F: a pose of the renderer as a pose of a camera with y down in a world with y down. Its own inverse.
[[nodiscard]] SE3 icl_reflect(const SE3& T_world_camera);

/// 640x480, 481.2, +480, 319.5, 239.5, no distortion (configs/recordings/icl_nuim.toml; the published fy is
/// -480).
[[nodiscard]] calibration::RigCalibration icl_calibration();

}  // namespace fusebench::formats::icl
