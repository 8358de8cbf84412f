#include "core/baselines/infinitam/fern_relocaliser.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "core/baselines/infinitam/depth_pyramid.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/systems_config.hpp"

namespace fusebench::baselines::infinitam {

namespace {

constexpr int kLevel = 4;                   // pyramid level: 40x30 for 640x480
constexpr double kSmoothing_px = 2.5;       // standard deviation
constexpr int kSmoothingReach_px = 5;       // two standard deviations
constexpr double kKeptDissimilarity = 0.2;  // a frame is stored if its dissimilarity to all others is larger
constexpr std::uint64_t kSeed = 20150711;

/// Mean over measured pixels; 0 if none is within reach.
DepthImage smoothed(const DepthImage& image) {
  DepthImage result(image.width, image.height);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      double sum = 0, weights = 0;
      for (int dy = -kSmoothingReach_px; dy <= kSmoothingReach_px; ++dy) {
        for (int dx = -kSmoothingReach_px; dx <= kSmoothingReach_px; ++dx) {
          if (!image.contains(x + dx, y + dy) || !(image(x + dx, y + dy) > 0)) continue;
          const double weight = std::exp(-(dx * dx + dy * dy) / (2 * kSmoothing_px * kSmoothing_px));
          sum += weight * static_cast<double>(image(x + dx, y + dy));
          weights += weight;
        }
      }
      if (weights > 0) result(x, y) = static_cast<float>(sum / weights);
    }
  }
  return result;
}

}  // namespace

FernRelocaliser::FernRelocaliser(const PinholeCamera& camera, const config::DepthConfig& depth,
                                 config::PeerDefects defects) {
  // The published program draws positions in an image of half the size of the tested image.
  const int level = defects == config::PeerDefects::as_published ? kLevel + 1 : kLevel;
  const PinholeCamera small = camera_of_level(camera, level);
  std::mt19937_64 generator(kSeed);
  for (Test& test : tests_) {
    test.x = static_cast<int>(ferns::uniform(generator) * small.width_px);
    test.y = static_cast<int>(ferns::uniform(generator) * small.height_px);
    test.depth_m = static_cast<float>(depth.min_m + ferns::uniform(generator) * (depth.max_m - depth.min_m));
  }
}

ferns::FernCode FernRelocaliser::code_of(const DepthImage& depth_m) const {
  const DepthImage small = smoothed(depth_pyramid(depth_m, kLevel + 1).back());
  ferns::FernCode code{};
  for (std::size_t i = 0; i < tests_.size(); ++i) {
    const Test& test = tests_[i];
    if (small(test.x, test.y) >= test.depth_m) ferns::pass(code, i);
  }
  return code;
}

const FernRelocaliser::StoredFrame* FernRelocaliser::nearest(const ferns::FernCode& code) const {
  const auto found = std::ranges::min_element(
      frames_, {}, [&](const StoredFrame& frame) { return ferns::dissimilarity(frame.code, code); });
  return found == frames_.end() ? nullptr : &*found;
}

bool FernRelocaliser::offer(const ferns::FernCode& code, const SE3& T_world_camera) {
  const StoredFrame* const like = nearest(code);
  if (like != nullptr && ferns::dissimilarity(like->code, code) <= kKeptDissimilarity) return false;
  frames_.push_back({code, T_world_camera});
  return true;
}

const SE3* FernRelocaliser::most_similar(const ferns::FernCode& code) const {
  const StoredFrame* const found = nearest(code);
  return found == nullptr ? nullptr : &found->T_world_camera;
}

}  // namespace fusebench::baselines::infinitam
