#include "datasets/simulator/sensors/depth_distortion.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"

namespace fusebench::simulator::sensors {

namespace {

/// Index of the ideal image's pixel at a pixel of the distorted image, -1: none.
std::int32_t ideal_pixel(const calibration::CalibratedCamera& camera, int u, int v) {
  const PinholeCamera& p = camera.pinhole;
  const Vector2d on_plane = camera.distortion.undistort({(u - p.cx_px) / p.fx_px, (v - p.cy_px) / p.fy_px});
  const Vector2d pixel = p.project({on_plane.x(), on_plane.y(), 1.0});
  if (!(std::abs(pixel.x()) < 1e6 && std::abs(pixel.y()) < 1e6)) return -1;
  const int x = static_cast<int>(std::lround(pixel.x()));
  const int y = static_cast<int>(std::lround(pixel.y()));
  const bool inside = x >= 0 && y >= 0 && x < p.width_px && y < p.height_px;
  return inside ? y * p.width_px + x : -1;
}

}  // namespace

DepthDistortion::DepthDistortion(const calibration::CalibratedCamera& camera, const Workers& workers)
    : source_(camera.pinhole.width_px, camera.pinhole.height_px) {
  workers.for_rows(source_.height, [&](int v) {
    for (int u = 0; u < source_.width; ++u) source_(u, v) = ideal_pixel(camera, u, v);
  });
}

Image<std::uint16_t> DepthDistortion::distorted(const Image<std::uint16_t>& ideal) const {
  check(ideal.width == source_.width && ideal.height == source_.height, "depth has the size of its camera");
  Image<std::uint16_t> result(ideal.width, ideal.height);
  std::ranges::transform(source_.data, result.data.begin(), [&](std::int32_t source) {
    return source < 0 ? std::uint16_t{0} : ideal.data[static_cast<std::size_t>(source)];
  });
  return result;
}

}  // namespace fusebench::simulator::sensors
