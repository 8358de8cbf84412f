#include <numbers>

#include "core/base/error.hpp"
#include "core/base/geometry.hpp"
#include "datasets/simulator/scene/room.hpp"
#include "datasets/simulator/sensors/image_sensors.hpp"
#include "tests/perf/kernel_counts.hpp"

namespace fusebench::perf {

using namespace simulator::scene;
using namespace simulator::render;
using namespace simulator::sensors;

namespace {

constexpr std::int64_t kMiddle_ns = 500'000'000;
const PinholeCamera kCamera{320, 240, 262.0, 262.0, 159.5, 119.5};

/// Turns at 2 rad/s and moves at 1 m/s in the middle of the room, the optical axis level.
synthetic_imu::PoseSpline turning_motion(const Vector3d& centre_m) {
  synthetic_imu::PoseSpline spline(0, 2 * kMiddle_ns, 100'000'000);
  for (std::size_t i = 0; i < spline.position_world_m.size(); ++i) {
    const double time_s = seconds_between(kMiddle_ns, spline.control_time_ns(i));
    spline.position_world_m[i] = centre_m + Vector3d(time_s, 0, 0);
    spline.rotation_world_body[i] = so3_exp({0, 0, 2 * time_s}) * so3_exp({-std::numbers::pi / 2, 0, 0});
  }
  return spline;
}

template <class Pixel>
std::size_t pixels_that(const Image<Pixel>& image, const auto& holds) {
  const auto count = static_cast<std::size_t>(std::ranges::count_if(image.data, holds));
  return count > image.data.size() / 2 ? image.data.size() : 0;
}

}  // namespace

void count_simulator_kernels(KernelCounts& counts) {
  const SimulatedScene room = make_room(1);
  const Renderer renderer(room);
  const Workers alone(1);
  const synthetic_imu::PoseSpline motion = turning_motion(room.free_space.center());
  ColorSensor color;
  color.camera.pinhole = kCamera;
  color.read_noise_grey = 1;
  color.shot_noise = 0.01;
  const simulator::rays::RayField rays(color.camera, alone);
  ColorImage image;
  counts.count(
      "simulated_color", "pixel",
      [&] { image = expose_color(renderer, color, rays, motion, {}, kMiddle_ns, 1, 0, alone); },
      [&] { return pixels_that(image, [](const Rgb& pixel) { return pixel[1] > 20; }); });
  DepthSensor depth;
  depth.camera = kCamera;
  depth.noise = DepthNoise::zr300;
  Image<std::uint16_t> raw;
  counts.count(
      "simulated_depth", "pixel",
      [&] { raw = sense_depth(renderer, depth, motion, {}, kMiddle_ns, 1, 0, alone); },
      [&] { return pixels_that(raw, [](std::uint16_t value) { return value > 300 && value < 6000; }); });
}

}  // namespace fusebench::perf
