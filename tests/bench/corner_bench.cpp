// Where new patches go: FAST corners over the image, and which of them are taken.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/config/groups/patches_config.hpp"
#include "core/estimator/patches/corner_selection.hpp"
#include "tests/bench/bench_scene.hpp"
#include "tests/bench/rates.hpp"
#include "tests/bench/scene_arguments.hpp"
#include "tests/support/gated_depth.hpp"

namespace fusebench {

using namespace simd;
using namespace config;
using namespace patches;

namespace {

using testing::BenchScene;
using Corners = std::vector<Eigen::Vector2i>;

/// The segment test in its plain form: nine neighbours in a row on the circle of 16 are all brighter, or all
/// darker, by more than the threshold.
bool is_fast_corner(const GreyImage& image, const Eigen::Vector2i& p, int threshold) {
  constexpr std::array<std::array<int, 2>, 16> kCircle = {{{0, -3},
                                                           {1, -3},
                                                           {2, -2},
                                                           {3, -1},
                                                           {3, 0},
                                                           {3, 1},
                                                           {2, 2},
                                                           {1, 3},
                                                           {0, 3},
                                                           {-1, 3},
                                                           {-2, 2},
                                                           {-3, 1},
                                                           {-3, 0},
                                                           {-3, -1},
                                                           {-2, -2},
                                                           {-1, -3}}};
  int brighter = 0;
  int darker = 0;
  for (std::size_t i = 0; i < 16 + 8; ++i) {
    const auto& offset = kCircle[i % 16];
    const int difference = image(p.x() + offset[0], p.y() + offset[1]) - image(p.x(), p.y());
    brighter = difference > threshold ? brighter + 1 : 0;
    darker = difference < -threshold ? darker + 1 : 0;
    if (brighter >= 9 || darker >= 9) return true;
  }
  return false;
}

/// The largest threshold at which a corner is still one.
int corner_score(const GreyImage& image, const Eigen::Vector2i& p, int threshold) {
  while (threshold < 255 && is_fast_corner(image, p, threshold + 1)) ++threshold;
  return threshold;
}

/// What a selection of corners is made from, and what its corners have to be.
class PlainCorners {
 public:
  PlainCorners(const BenchScene& scene, const DepthImage& depth_m)
      : grey_(scene.frame.grey), depth_m_(depth_m), config_(scene.config.patches) {}

  /// Corners that may be taken, apart from each other; and if there could have been more, every corner that
  /// was not taken is too near to one that was.
  [[nodiscard]] bool are_selected(const Corners& corners) const {
    if (corners.size() <= 20 || corners.size() > static_cast<std::size_t>(config_.max_count)) return false;
    for (std::size_t a = 0; a < corners.size(); ++a) {
      if (!is_candidate(corners[a])) return false;
      for (std::size_t b = 0; b < a; ++b) {
        if (are_near(corners[a], corners[b])) return false;
      }
    }
    return corners.size() == static_cast<std::size_t>(config_.max_count) || !is_room_for_another(corners);
  }

 private:
  [[nodiscard]] bool are_near(const Eigen::Vector2i& a, const Eigen::Vector2i& b) const {
    return (a - b).cast<double>().norm() < config_.min_distance_px;
  }

  /// A corner inside the image, with depth, that has a better score than any pixel around it.
  [[nodiscard]] bool is_candidate(const Eigen::Vector2i& p) const {
    if (!patch_fits(grey_, p, config_.size_px) || !is_fast_corner(grey_, p, config_.fast_threshold))
      return false;
    const int score = corner_score(grey_, p, config_.fast_threshold);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const Eigen::Vector2i neighbour = p + Eigen::Vector2i(dx, dy);
        if (neighbour != p && is_fast_corner(grey_, neighbour, score)) return false;
      }
    }
    return has_depth(p);
  }

  [[nodiscard]] bool has_depth(const Eigen::Vector2i& p) const {
    int measured = 0;
    const Eigen::Vector2i first = p - Eigen::Vector2i::Constant(config_.size_px / 2);
    for (int i = 0; i < config_.size_px * config_.size_px; ++i)
      measured += depth_m_(first.x() + i % config_.size_px, first.y() + i / config_.size_px) > 0 ? 1 : 0;
    return measured >= config_.min_valid_fraction * config_.size_px * config_.size_px;
  }

  [[nodiscard]] bool is_room_for_another(const Corners& taken) const {
    const auto is_free = [&](const Eigen::Vector2i& p) {
      return std::ranges::none_of(taken, [&](const Eigen::Vector2i& q) { return are_near(p, q); });
    };
    for (int y = 0; y < grey_.height; ++y) {
      for (int x = 0; x < grey_.width; ++x) {
        if (is_candidate({x, y}) && is_free({x, y})) return true;
      }
    }
    return false;
  }

  const GreyImage& grey_;
  const DepthImage& depth_m_;
  const PatchConfig& config_;
};

void corner_selection(benchmark::State& state) {
  const BenchScene& scene = testing::scene_of(state);
  const DepthImage depth_m = testing::gated_depth(scene.frame.depth_m, scene.config.depth);
  const auto select = [&] { return select_corners(scene.frame.grey, depth_m, {}, scene.config.patches); };
  if (!PlainCorners(scene, depth_m).are_selected(select()))
    return state.SkipWithError("these are not spread FAST corners");
  for (auto _ : state) benchmark::DoNotOptimize(select());
  const std::size_t pixels = scene.frame.grey.data.size();
  // Grey levels in; corners, and the depth around them, are few.
  testing::report_rates(state, {"pixels", pixels, testing::bytes_of<std::uint8_t>(pixels)});
}

BENCHMARK(corner_selection)
    ->Apply(testing::over_scenes<>)
    ->ArgNames({"scene", "width"})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fusebench
