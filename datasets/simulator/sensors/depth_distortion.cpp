#include "datasets/simulator/sensors/depth_distortion.hpp"

#include <cmath>

#include "core/base/error.hpp"

namespace fusebench::simulator::sensors {

Image<std::uint16_t> distort_depth(const Image<std::uint16_t>& ideal,
                                   const calibration::CalibratedCamera& camera) {
  const PinholeCamera& p = camera.pinhole;
  check(ideal.width == p.width_px && ideal.height == p.height_px, "depth has the size of its camera");
  Image<std::uint16_t> distorted(ideal.width, ideal.height);
  for (int v = 0; v < ideal.height; ++v) {
    for (int u = 0; u < ideal.width; ++u) {
      const Vector2d on_plane =
          camera.distortion.undistort({(u - p.cx_px) / p.fx_px, (v - p.cy_px) / p.fy_px});
      const Vector2d pixel = p.project({on_plane.x(), on_plane.y(), 1.0});
      if (!(std::abs(pixel.x()) < 1e6 && std::abs(pixel.y()) < 1e6)) continue;
      const int x = static_cast<int>(std::lround(pixel.x()));
      const int y = static_cast<int>(std::lround(pixel.y()));
      if (ideal.contains(x, y)) distorted(u, v) = ideal(x, y);
    }
  }
  return distorted;
}

}  // namespace fusebench::simulator::sensors
