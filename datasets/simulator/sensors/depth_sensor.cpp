#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "datasets/simulator/random/random_numbers.hpp"
#include "datasets/simulator/sensors/depth_noise.hpp"
#include "datasets/simulator/sensors/image_sensors.hpp"

namespace fusebench::simulator::sensors {

namespace {

// Keys of independent random streams of one seed.
constexpr std::uint64_t kDepthNoise = 0xD0;
constexpr std::uint64_t kDepthErrors = 0xD1;

constexpr int kKinectColumns = 640;

std::uint16_t raw_value(float depth_m, double units_per_metre) {
  const double units = std::floor(static_cast<double>(depth_m) * units_per_metre + 0.5);
  return units > 0 && units <= std::numeric_limits<std::uint16_t>::max() ? static_cast<std::uint16_t>(units)
                                                                         : 0;
}

DepthImage measured_depth(const Image<render::Renderer::Surface>& surfaces, const DepthSensor& sensor,
                          std::uint64_t key, const Workers& workers) {
  const NativePixels native = native_pixels(sensor.noise, sensor.camera);
  switch (sensor.noise) {
    case DepthNoise::handa:
      return structured_light_depth(surfaces, native, key, workers);
    case DepthNoise::zr300:
      return active_stereo_depth(surfaces, native, key, workers);
    case DepthNoise::kinect:
      return kinect_depth(surfaces, native, key, workers);
    case DepthNoise::none:
      break;
  }
  DepthImage depth_m(surfaces.width, surfaces.height);
  std::ranges::transform(surfaces.data, depth_m.data.begin(), &render::Renderer::Surface::depth_m);
  return depth_m;
}

/// Depth image of a surface in a moving frame.
Image<render::Renderer::Surface> seen_by(const render::Renderer& surface, const DepthSensor& sensor,
                                         std::int64_t capture_ns,
                                         const std::function<SE3(std::int64_t)>& T_surface_camera,
                                         const Workers& workers) {
  const int rows = sensor.readout_s == 0 ? 1 : sensor.camera.height_px;
  render::RowPoses poses;
  for (int row = 0; row < rows; ++row) {
    poses.T_world_camera.push_back(
        T_surface_camera(row_time_ns(capture_ns, sensor.readout_s, row, sensor.camera.height_px)));
  }
  Image<render::Renderer::Surface> surfaces;
  surface.render_surfaces(sensor.camera, poses, workers, surfaces, sensor.errors.lost_light);
  return surfaces;
}

/// Merges the nearer depth of each pixel; 0 means no measurement.
void put_before(const Image<render::Renderer::Surface>& nearer, Image<render::Renderer::Surface>& surfaces) {
  for (std::size_t i = 0; i < surfaces.data.size(); ++i) {
    const render::Renderer::Surface& a = nearer.data[i];
    render::Renderer::Surface& b = surfaces.data[i];
    if (a.depth_m > 0 && (b.depth_m <= 0 || a.depth_m < b.depth_m)) b = a;
  }
}

}  // namespace

NativePixels native_pixels(DepthNoise noise, const PinholeCamera& camera) {
  return {camera, noise == DepthNoise::zr300 ? camera.width_px : kKinectColumns};
}

Image<std::uint16_t> sense_depth(const render::Renderer& renderer, const DepthSensor& sensor,
                                 const synthetic_imu::PoseSpline& motion, const SE3& T_body_camera,
                                 std::int64_t capture_ns, std::uint64_t seed, std::uint64_t frame,
                                 const Workers& workers, const MovingObject* before) {
  Image<render::Renderer::Surface> surfaces = seen_by(
      renderer, sensor, capture_ns,
      [&](std::int64_t t_ns) { return motion.evaluate(t_ns).T_world_body * T_body_camera; }, workers);
  if (before != nullptr)
    put_before(seen_by(before->surface, sensor, capture_ns, before->T_object_camera, workers), surfaces);
  if (sensor.errors.any()) {
    const std::uint64_t key = random::mix_key(seed, kDepthErrors);
    apply_depth_errors(sensor.errors, native_pixels(sensor.noise, sensor.camera), key,
                       random::mix_key(key, frame + 1), workers, surfaces);
  }
  const DepthImage depth_m =
      measured_depth(surfaces, sensor, random::mix_key(random::mix_key(seed, kDepthNoise), frame), workers);
  Image<std::uint16_t> raw(depth_m.width, depth_m.height);
  std::ranges::transform(depth_m.data, raw.data.begin(),
                         [&](float depth) { return raw_value(depth, sensor.units_per_metre); });
  return raw;
}

}  // namespace fusebench::simulator::sensors
