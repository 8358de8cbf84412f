#include "core/baselines/elasticfusion/surfels/smooth_depth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/base/simd/lanes.hpp"
#include "core/baselines/image_rows.hpp"

namespace fusebench::baselines::elasticfusion::surfels {

namespace {

using simd::Float8;
using simd::Int8;

constexpr int kReach_px = 6;
constexpr int kSide = 2 * kReach_px + 1;
constexpr double kSigma_px = 4.5;
constexpr float kSigma_m = 0.03F;
constexpr int kLanes = static_cast<int>(simd::kLanes);

/// exp(-e) as (1 - e/32)^32: an error of 3 % at 1.5 standard deviations, 0 beyond eight.
Float8 falling(Float8 e) {
  Float8 value = simd::max(simd::all_lanes(0.0F), 1.0F - e * (1.0F / 32));
  for (int i = 0; i < 5; ++i) value *= value;
  return value;
}

/// Adds a border of zeros, so that each window of eight pixels is inside.
Image<float> with_border(const DepthImage& depth_m) {
  Image<float> padded(depth_m.width + 2 * kReach_px + kLanes, depth_m.height + 2 * kReach_px);
  for (int y = 0; y < depth_m.height; ++y)
    std::copy_n(depth_m.data.data() + depth_m.index(0, y), depth_m.width,
                padded.data.data() + padded.index(kReach_px, y + kReach_px));
  return padded;
}

std::array<float, kSide * kSide> spatial_weights() {
  std::array<float, kSide * kSide> weights{};
  for (int dy = -kReach_px; dy <= kReach_px; ++dy) {
    for (int dx = -kReach_px; dx <= kReach_px; ++dx)
      weights[static_cast<std::size_t>((dy + kReach_px) * kSide + dx + kReach_px)] =
          static_cast<float>(std::exp(-(dx * dx + dy * dy) / (2 * kSigma_px * kSigma_px)));
  }
  return weights;
}

}  // namespace

DepthImage smooth_depth(const DepthImage& depth_m, const Workers& workers) {
  const Image<float> padded = with_border(depth_m);
  const auto weights = spatial_weights();
  DepthImage smooth(depth_m.width, depth_m.height);
  const auto at = [&](int x, int y) -> Float8 {
    const float* const corner = padded.data.data() + padded.index(x, y);
    const Float8 middle = simd::load(padded.data.data() + padded.index(x + kReach_px, y + kReach_px));
    const Float8 none{};
    if (!simd::any(middle > 0.0F)) return none;
    Float8 sum{}, total{};
    for (int row = 0; row < kSide; ++row) {
      const float* const pixels = corner + row * padded.width;
      for (int column = 0; column < kSide; ++column) {
        const Float8 value = simd::load(pixels + column);
        const Float8 off = (value - middle) * (1.0F / (std::numbers::sqrt2_v<float> * kSigma_m));
        const Float8 weight = weights[static_cast<std::size_t>(row * kSide + column)] * falling(off * off);
        const Float8 counted = value > 0.0F ? weight : none;
        sum = simd::multiply_add(counted, value, sum);
        total += counted;
      }
    }
    return middle > 0.0F ? sum / total : none;
  };
  workers.for_chunks(static_cast<std::size_t>(depth_m.height), kRowsAtOnce,
                     [&](std::size_t begin, std::size_t end) {
                       std::array<float, simd::kLanes> eight{};
                       for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
                         for (int x = 0; x < depth_m.width; x += kLanes) {
                           simd::store(at(x, y), eight.data());
                           std::copy_n(eight.begin(), std::min(kLanes, depth_m.width - x),
                                       smooth.data.data() + smooth.index(x, y));
                         }
                       }
                     });
  return smooth;
}

}  // namespace fusebench::baselines::elasticfusion::surfels
