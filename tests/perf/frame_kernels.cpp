#include <optional>

#include "core/estimator/preprocessing/depth_gates.hpp"
#include "core/estimator/preprocessing/rolling_shutter_compensation.hpp"
#include "tests/bench/bench_scene.hpp"
#include "tests/bench/frame_answers.hpp"
#include "tests/bench/golden_frames.hpp"
#include "tests/perf/kernel_counts.hpp"

namespace fusebench::perf {

using namespace preprocessing;

namespace {

/// Of a real recording, since what inflating costs depends on what is in the file.
void count_decoding(KernelCounts& counts) {
  const testing::ImagePairFiles files = testing::golden_pair_files();
  std::optional<Result<testing::ImagePair>> pair;
  counts.count(
      "decode_png_pair", "pixel", [&] { pair = testing::read_pair(files); },
      [&] {
        check(pair->has_value() && testing::is_golden_pair(**pair), "these are the images");
        return (*pair)->color.data.size() + (*pair)->depth.data.size();
      });
}

void count_motion_compensation(KernelCounts& counts, const testing::BenchScene& scene) {
  const Workers workers(1);
  RgbdFrame frame;
  counts.count(
      "motion_compensation", "pixel",
      [&] {
        compensate_motion(scene.sensed, scene.camera, scene.frame_timing(), scene.velocity, workers, frame);
      },
      [&] {
        check(testing::is_as_rendered(frame, scene), "the rolling shutter is compensated");
        return frame.grey.data.size();
      });
}

void count_color_compensation(KernelCounts& counts, const testing::BenchScene& scene) {
  const Workers workers(1);
  ColorImage color;
  counts.count(
      "color_compensation", "pixel",
      [&] {
        compensate_color(scene.sensed, scene.camera, scene.frame_timing(), scene.velocity,
                         scene.ungated_depth_m, workers, color);
      },
      [&] {
        check(testing::is_color_compensated(color, scene.ungated_depth_m, scene),
              "colour is what the plain search finds");
        return color.data.size();
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
        check(static_cast<int>(pyramid.size()) == scene.config.patches.levels &&
                  testing::is_pyramid_of(pyramid, scene.frame.grey),
              "all levels are those of the plain filter");
        check(testing::is_gated(gated_m, scene.frame.depth_m, scene.config.depth),
              "depth is gated, pixel by pixel");
        return scene.frame.grey.data.size();
      });
}

}  // namespace

void count_frame_kernels(KernelCounts& counts, const testing::BenchScene& scene) {
  count_decoding(counts);
  count_motion_compensation(counts, scene);
  count_color_compensation(counts, scene);
  count_preparation(counts, scene);
}

}  // namespace fusebench::perf
