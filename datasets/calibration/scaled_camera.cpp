#include "datasets/calibration/scaled_camera.hpp"

#include "core/base/error.hpp"

namespace fusebench::calibration {

PinholeCamera scaled_camera(const PinholeCamera& camera, int width_px, int height_px) {
  check(camera.width_px > 0 && camera.height_px > 0, "the camera has a size");
  const double x = static_cast<double>(width_px) / camera.width_px;
  const double y = static_cast<double>(height_px) / camera.height_px;
  return {width_px,
          height_px,
          x * camera.fx_px,
          y * camera.fy_px,
          x * (camera.cx_px + 0.5) - 0.5,
          y * (camera.cy_px + 0.5) - 0.5};
}

}  // namespace fusebench::calibration
