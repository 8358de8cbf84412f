// How edges of depth move where depth was read by a wrong depth camera, and that camera.
#pragma once

#include "core/base/types.hpp"
#include "datasets/calibration/rig_calibration.hpp"
#include "datasets/inspection/measures/depth_edges.hpp"

namespace fusebench::inspection::measures {

/// How depth images as they are read have to move to lie on colour: what parallel cameras do to each other
/// that have other focal lengths and centres, and stand apart.
struct RegistrationModel {
  double scale = 1;           ///< focal length of colour over that of depth
  Vector2d shift_px{0, 0};    ///< of the centre, or a small turn
  Vector2d baseline_m{0, 0};  ///< the depth camera's place in the colour camera, x and y

  [[nodiscard]] Vector2d move(const DepthEdge& edge, const PinholeCamera& camera) const;
};

/// The depth camera that the model asks for in place of the one with which depth was read. Exact for parallel
/// cameras; small turns become a shift of the centre.
[[nodiscard]] calibration::DepthCamera fitted_depth_camera(const RegistrationModel& model,
                                                           const PinholeCamera& color,
                                                           const calibration::DepthCamera& as_read);

/// The inverse: the model by which `fitted` replaces `as_read`.
[[nodiscard]] RegistrationModel model_between(const calibration::DepthCamera& as_read,
                                              const calibration::DepthCamera& fitted,
                                              const PinholeCamera& color);

}  // namespace fusebench::inspection::measures
