// Images of the simulator: a furnished room at 640x480. Arguments: blur samples (0: by motion) or noise
// model, threads.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>

#include "datasets/simulator/scene/room.hpp"
#include "datasets/simulator/sensors/image_sensors.hpp"
#include "tests/bench/rates.hpp"

namespace fusebench {

using namespace synthetic_imu;
using namespace simulator::scene;
using namespace simulator::render;
using namespace simulator::sensors;

namespace {

constexpr std::int64_t kMiddle_ns = 500'000'000;

const SimulatedScene& room() {
  static const SimulatedScene scene = make_room(1);
  return scene;
}
const Renderer& room_renderer() {
  static const Renderer renderer(room());
  return renderer;
}

PinholeCamera camera() { return {640, 480, 525.0, 525.0, 319.5, 239.5}; }

/// Turns at 2 rad/s in the middle of the room, the optical axis level.
PoseSpline turning() {
  PoseSpline spline(0, 2 * kMiddle_ns, 100'000'000);
  for (std::size_t i = 0; i < spline.position_world_m.size(); ++i) {
    const double angle = 2.0 * seconds_between(kMiddle_ns, spline.control_time_ns(i));
    spline.position_world_m[i] = room().free_space.center();
    spline.rotation_world_body[i] = so3_exp({0, 0, angle}) * so3_exp({-std::numbers::pi / 2, 0, 0});
  }
  return spline;
}

void colour_image(benchmark::State& state) {
  const Workers workers(static_cast<int>(state.range(1)));
  const PoseSpline motion = turning();
  ColorSensor sensor;
  sensor.camera.pinhole = camera();
  sensor.camera.distortion = {0.0644, -0.114, 0.00127, 0.00203, 0};
  sensor.camera.timing.color_readout_s = 0.02;
  sensor.vignetting = 0.2;
  sensor.gain_drift = 0.05;
  sensor.read_noise_grey = 1;
  sensor.shot_noise = 0.01;
  sensor.blur_samples = static_cast<int>(state.range(0));
  const simulator::rays::RayField rays(sensor.camera, workers);
  const auto expose = [&](const Workers& by) {
    return expose_color(room_renderer(), sensor, rays, motion, {}, kMiddle_ns, 1, 0, by);
  };
  if (expose(workers).data != expose(Workers(1)).data) {
    return state.SkipWithError("depends on the number of threads");
  }
  for (auto _ : state) benchmark::DoNotOptimize(expose(workers));
  // The image out.
  const auto pixels =
      static_cast<std::size_t>(camera().width_px) * static_cast<std::size_t>(camera().height_px);
  testing::report_rates(state, {"pixels", pixels, testing::bytes_of<Rgb>(pixels)});
}

void depth_image(benchmark::State& state) {
  const Workers workers(static_cast<int>(state.range(1)));
  const PoseSpline motion = turning();
  DepthSensor sensor;
  sensor.camera = camera();
  const auto sense = [&] {
    return sense_depth(room_renderer(), sensor, motion, {}, kMiddle_ns, 1, 0, workers);
  };
  const Image<std::uint16_t> exact = sense();
  sensor.noise = static_cast<DepthNoise>(state.range(0));
  const Image<std::uint16_t> noisy = sense();
  std::size_t near = 0;
  for (std::size_t i = 0; i < exact.data.size(); ++i) {
    if (exact.data[i] == 0) return state.SkipWithError("the room has a hole");
    if (std::abs(noisy.data[i] - exact.data[i]) < 0.03 * exact.data[i]) ++near;
  }
  if (near < exact.data.size() * 3 / 5) return state.SkipWithError("noise far from the truth");
  for (auto _ : state) benchmark::DoNotOptimize(sense());
  // The image out.
  testing::report_rates(state,
                        {"pixels", exact.data.size(), testing::bytes_of<std::uint16_t>(exact.data.size())});
}

BENCHMARK(colour_image)->ArgsProduct({{0, 1, 8}, {1, 2}})->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(depth_image)->ArgsProduct({{0, 1, 2}, {1, 2}})->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace fusebench
