#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "core/depth_gates.hpp"
#include "core/motion_compensation.hpp"
#include "datasets/image_files.hpp"
#include "tests/perf/kernel_counts.hpp"
#include "tests/support/rolling_shutter.hpp"

namespace fusebench::perf {

namespace {

std::size_t with_depth(const DepthImage& depth_m) {
  return static_cast<std::size_t>(
      std::ranges::count_if(depth_m.data, [](float z) { return std::isfinite(z) && z > 0; }));
}

double mean_grey(const GreyImage& image) {
  double sum = 0;
  for (const std::uint8_t level : image.data) sum += level;
  return sum / static_cast<double>(image.data.size());
}

/// Of a real recording, since what inflating costs depends on what is in the file.
void count_decoding(KernelCounts& counts) {
  const std::filesystem::path folder = std::filesystem::path(FUSEBENCH_GOLDEN) / "tum_freiburg1_rpy_5frames";
  std::optional<Result<ColorImage>> color;
  std::optional<Result<Image<std::uint16_t>>> depth;
  counts.count(
      "decode_png_pair", "pixel",
      [&] {
        color = read_color(folder / "rgb" / "1305031229.528748.png");
        depth = read_depth16(folder / "depth" / "1305031229.528784.png");
      },
      [&] {
        check(color->has_value() && depth->has_value(), "both images can be read");
        const auto measured = std::ranges::count_if((*depth)->data, [](std::uint16_t z) { return z > 0; });
        check((*color)->width == 640 && 2 * measured > std::ssize((*depth)->data), "these are the images");
        return (*color)->data.size() + (*depth)->data.size();
      });
}

void count_motion_compensation(KernelCounts& counts, const testing::BenchScene& scene) {
  const Workers workers(1);
  const CameraVelocity velocity{{0.5, 1.8, -0.7}, {0.3, -0.2, 0.1}};
  const SensorTiming timing{.color_readout_s = 0.026, .depth_readout_s = 0.026, .depth_delay_s = 0.01};
  const RgbdFrame rolling =
      testing::render_rolling(testing::TexturedRoom{}, scene.camera, timing, [&](double after_s) {
        return scene.T_world_camera *
               SE3{so3_exp(after_s * velocity.angular_radps), after_s * velocity.linear_mps};
      });
  const auto difference = [&](const RgbdFrame& frame, const RgbdFrame& compensated) {
    double sum = 0;
    for (std::size_t i = 0; i < frame.grey.data.size(); ++i) {
      if (compensated.depth_m.data[i] > 0) sum += std::abs(frame.grey.data[i] - scene.frame.grey.data[i]);
    }
    return sum;
  };
  RgbdFrame frame;
  counts.count(
      "motion_compensation", "pixel",
      [&] { compensate_motion(rolling, scene.camera, timing, velocity, workers, frame); },
      [&] {
        check(2 * with_depth(frame.depth_m) > frame.depth_m.data.size(), "most of the depth is left");
        check(difference(frame, frame) < 0.15 * difference(rolling, frame), "the rolling shutter is undone");
        return frame.grey.data.size();
      });
}

void count_preparation(KernelCounts& counts, const testing::BenchScene& scene) {
  std::vector<GreyImage> pyramid;
  DepthImage gated_m;
  counts.count(
      "pyramid_and_depth_gate", "pixel",
      [&] {
        build_pyramid(scene.frame.grey, scene.config.patches.levels, pyramid);
        gate_depth(scene.frame.depth_m, scene.config.depth, gated_m);
      },
      [&] {
        check(static_cast<int>(pyramid.size()) == scene.config.patches.levels, "there are all levels");
        check(std::abs(mean_grey(pyramid.back()) - mean_grey(scene.frame.grey)) < 2,
              "levels are as bright as the image");
        const std::size_t kept = with_depth(gated_m);
        check(2 * kept > gated_m.data.size() && kept < with_depth(scene.frame.depth_m),
              "edges lose their depth, and most pixels keep it");
        return scene.frame.grey.data.size();
      });
}

}  // namespace

void count_frame_kernels(KernelCounts& counts, const testing::BenchScene& scene) {
  count_decoding(counts);
  count_motion_compensation(counts, scene);
  count_preparation(counts, scene);
}

}  // namespace fusebench::perf
