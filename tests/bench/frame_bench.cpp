// What happens to a frame before it is tracked: pyramid, motion compensation. Arguments: width, threads.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>

#include "core/motion_compensation.hpp"
#include "tests/bench/bench_scene.hpp"
#include "tests/support/rolling_shutter.hpp"

namespace fusebench {
namespace {

using testing::bench_scene;
using testing::BenchScene;

/// One level down, the plain way: 5x5 binomial weights, mirrored without repeating the border.
GreyImage halved(const GreyImage& image) {
  constexpr std::array<int, 5> kWeights = {1, 4, 6, 4, 1};
  const auto mirrored = [](int i, int size) { return i < 0 ? -i : i >= size ? 2 * size - 2 - i : i; };
  GreyImage half((image.width + 1) / 2, (image.height + 1) / 2);
  for (int y = 0; y < half.height; ++y) {
    for (int x = 0; x < half.width; ++x) {
      int sum = 0;
      for (int j = -2; j <= 2; ++j) {
        for (int i = -2; i <= 2; ++i) {
          sum += kWeights[static_cast<std::size_t>(i + 2)] * kWeights[static_cast<std::size_t>(j + 2)] *
                 image(mirrored(2 * x + i, image.width), mirrored(2 * y + j, image.height));
        }
      }
      half(x, y) = static_cast<std::uint8_t>((sum + 128) / 256);
    }
  }
  return half;
}

void pyramid(benchmark::State& state) {
  const BenchScene& scene = bench_scene(static_cast<int>(state.range(0)));
  const auto levels = build_pyramid(scene.frame.grey, 3);
  if (levels[1].data != halved(levels[0]).data || levels[2].data != halved(levels[1]).data) {
    return state.SkipWithError("differs from the plain filter");
  }
  for (auto _ : state) benchmark::DoNotOptimize(build_pyramid(scene.frame.grey, 3));
}

void motion_compensation(benchmark::State& state) {
  const BenchScene& scene = bench_scene(static_cast<int>(state.range(0)));
  const Workers workers(static_cast<int>(state.range(1)));
  const CameraVelocity velocity{{0.5, 1.8, -0.7}, {0.3, -0.2, 0.1}};
  const SensorTiming timing{.color_readout_s = 0.026, .depth_readout_s = 0.026, .depth_delay_s = 0.01};
  const RgbdFrame rolling =
      testing::render_rolling(testing::TexturedRoom{}, scene.camera, timing, [&](double after_s) {
        return scene.T_world_camera *
               SE3{so3_exp(after_s * velocity.angular_radps), after_s * velocity.linear_mps};
      });
  RgbdFrame frame;
  const auto compensate = [&] { compensate_motion(rolling, scene.camera, timing, velocity, workers, frame); };
  compensate();
  double before = 0;
  double after = 0;
  for (std::size_t i = 0; i < frame.grey.data.size(); ++i) {
    if (frame.depth_m.data[i] == 0.0F) continue;
    before += std::abs(rolling.grey.data[i] - scene.frame.grey.data[i]);
    after += std::abs(frame.grey.data[i] - scene.frame.grey.data[i]);
  }
  if (!(after < 0.15 * before)) return state.SkipWithError("the rolling shutter is not undone");
  for (auto _ : state) compensate();
}

BENCHMARK(pyramid)->Arg(320)->Arg(640)->Unit(benchmark::kMillisecond);
BENCHMARK(motion_compensation)
    ->ArgsProduct({{320, 640}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace fusebench
