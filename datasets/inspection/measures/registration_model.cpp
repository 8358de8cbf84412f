#include "datasets/inspection/measures/registration_model.hpp"

namespace fusebench::inspection::measures {

Vector2d RegistrationModel::move(const DepthEdge& edge, const PinholeCamera& camera) const {
  const double x = camera.cx_px + scale * (edge.x_px - camera.cx_px) + shift_px.x() +
                   camera.fx_px * baseline_m.x() / edge.depth_m;
  const double y = camera.cy_px + scale * (edge.y_px - camera.cy_px) + shift_px.y() +
                   camera.fy_px * baseline_m.y() / edge.depth_m;
  return {x, y};
}

calibration::DepthCamera fitted_depth_camera(const RegistrationModel& model, const PinholeCamera& color,
                                             const calibration::DepthCamera& as_read) {
  calibration::DepthCamera out = as_read;
  out.pinhole.fx_px /= model.scale;
  out.pinhole.fy_px /= model.scale;
  // A shift of the moved image is one of the centre by the same angle.
  out.pinhole.cx_px -= model.shift_px.x() / color.fx_px * out.pinhole.fx_px;
  out.pinhole.cy_px -= model.shift_px.y() / color.fy_px * out.pinhole.fy_px;
  out.T_color_depth.translation.x() = model.scale * out.T_color_depth.translation.x() + model.baseline_m.x();
  out.T_color_depth.translation.y() = model.scale * out.T_color_depth.translation.y() + model.baseline_m.y();
  return out;
}

RegistrationModel model_between(const calibration::DepthCamera& as_read,
                                const calibration::DepthCamera& fitted, const PinholeCamera& color) {
  RegistrationModel model;
  model.scale = as_read.pinhole.fx_px / fitted.pinhole.fx_px;
  model.shift_px = {(as_read.pinhole.cx_px - fitted.pinhole.cx_px) * color.fx_px / fitted.pinhole.fx_px,
                    (as_read.pinhole.cy_px - fitted.pinhole.cy_px) * color.fy_px / fitted.pinhole.fy_px};
  model.baseline_m =
      (fitted.T_color_depth.translation - model.scale * as_read.T_color_depth.translation).head<2>();
  return model;
}

}  // namespace fusebench::inspection::measures
