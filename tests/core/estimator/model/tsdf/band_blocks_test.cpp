// Against every pixel's ray, felt along in small steps.
#include "core/estimator/model/tsdf/band_blocks.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/tsdf_config.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>

#include "tests/support/analytic_scene.hpp"
#include "tests/support/felt_blocks.hpp"

namespace fusebench {

using namespace config;
using namespace tsdf;

namespace {

using testing::felt_blocks;
using testing::missing;
using Blocks = testing::BlockSet;

// A narrow view, so that a block of 8 cm is wider than kFinePixels at 5 m, one of 4 cm is half as wide, and
// one of 3.2 cm is not.
const PinholeCamera kBandCamera = test_camera(160, 120, 15.0);
const SE3 kTWorldCamera{so3_exp({0.3, -0.2, 0.1}), {-0.3, 0.4, 0.1}};

DepthImage step_and_wall() {
  const AnalyticScene scene{{AnalyticPlane{{0, 0, -1}, -2.2, {9, 9, 9}}}};
  DepthImage depth_m = scene.render(kBandCamera, kTWorldCamera).depth_m;
  for (int y = 30; y < 70; ++y) {
    for (int x = 50; x < 100; ++x) depth_m(x, y) -= 0.4F;  // something before the wall
  }
  for (int y = 0; y < 20; ++y) depth_m(3, y) = 0.0F;  // not measured
  return depth_m;
}

Blocks found_blocks(const DepthImage& depth_m, double block_m, const TsdfConfig& tsdf,
                    const DepthConfig& depth, std::uint32_t frame_number = 0) {
  BandBlocks band;
  const Workers workers(1);
  for (int time = 0; time < 2; ++time) {  // it forgets the image before
    band.find(depth_m, kBandCamera, kTWorldCamera, block_m, tsdf, depth, frame_number, workers);
  }
  const Blocks blocks = testing::block_set(band.blocks());
  EXPECT_EQ(blocks.size(), band.blocks().size()) << "each once";
  return blocks;
}

TEST(BandBlocks, OfFinePixelsAreAllThatTheirRaysPass) {
  const TsdfConfig tsdf{.voxel_m = 0.004};
  const DepthConfig depth;
  const double block_m = 8 * tsdf.voxel_m;
  ASSERT_LT(block_m * kBandCamera.fx_px / depth.max_m, BandBlocks::kFinePixels / 2);
  const DepthImage depth_m = step_and_wall();
  const Blocks felt = felt_blocks(depth_m, kBandCamera, kTWorldCamera, block_m, tsdf, depth);
  const Blocks found = found_blocks(depth_m, block_m, tsdf, depth);
  EXPECT_GT(felt.size(), 100U);
  EXPECT_EQ(missing(felt, found), 0U);
  // Steps may jump a corner that a ray cuts.
  EXPECT_LE(static_cast<double>(missing(found, felt)), 0.03 * static_cast<double>(found.size()));
}

TEST(BandBlocks, OfEverySecondOrFourthPixelMissCornersAtMost) {
  const DepthConfig depth;
  const DepthImage depth_m = step_and_wall();
  for (const auto& [voxel_m, least_px] : {std::pair{0.005, BandBlocks::kFinePixels / 2},  // every second
                                          std::pair{0.01, BandBlocks::kFinePixels}}) {    // every fourth
    const TsdfConfig tsdf{.voxel_m = voxel_m};
    const double block_m = 8 * tsdf.voxel_m;
    ASSERT_GE(block_m * kBandCamera.fx_px / depth.max_m, least_px);
    const Blocks felt = felt_blocks(depth_m, kBandCamera, kTWorldCamera, block_m, tsdf, depth);
    EXPECT_GT(felt.size(), 20U);
    for (const std::uint32_t frame_number : {0U, 1U, 2U, 3U, 0xFFFFFFFFU}) {
      const Blocks found = found_blocks(depth_m, block_m, tsdf, depth, frame_number);
      EXPECT_LE(static_cast<double>(missing(felt, found)), 0.07 * static_cast<double>(felt.size()))
          << voxel_m;
      EXPECT_LE(static_cast<double>(missing(found, felt)), 0.03 * static_cast<double>(found.size()))
          << voxel_m;
    }
  }
}

TEST(BandBlocks, OfAThinObjectAreFoundWithinFourFrames) {
  const TsdfConfig tsdf;
  const DepthConfig depth;
  const double block_m = 8 * tsdf.voxel_m;
  for (const bool upright : {true, false}) {
    for (int place = 60; place < 64; ++place) {
      // A single row or column of pixels at any position relative to the grid of used pixels.
      DepthImage depth_m(kBandCamera.width_px, kBandCamera.height_px);
      for (int i = 8; i < 112; ++i) depth_m(upright ? place : i, upright ? i : place) = 2.0F;
      Blocks found;
      for (std::uint32_t frame_number = 0; frame_number < 4; ++frame_number) {
        found.merge(found_blocks(depth_m, block_m, tsdf, depth, frame_number));
      }
      const Blocks felt = felt_blocks(depth_m, kBandCamera, kTWorldCamera, block_m, tsdf, depth);
      ASSERT_GT(felt.size(), 8U);
      EXPECT_LE(missing(felt, found), felt.size() / 4) << place;
    }
  }
}

TEST(BandBlocks, AreTheSameForEveryNumberOfThreads) {
  const DepthImage depth_m = step_and_wall();
  const TsdfConfig tsdf;
  const Workers one(1), many(8);
  BandBlocks first, second;
  first.find(depth_m, kBandCamera, kTWorldCamera, 0.08, tsdf, DepthConfig{}, 1, one);
  second.find(depth_m, kBandCamera, kTWorldCamera, 0.08, tsdf, DepthConfig{}, 1, many);
  EXPECT_EQ(first.blocks(), second.blocks());
}

TEST(BandBlocks, AreNotListedMuchBeyondWhatTheModelTakes) {
  // A band of a metre of blocks of 8 mm: 200 of them along each ray.
  TsdfConfig tsdf{.voxel_m = 0.001, .truncation_m = 0.8};
  const DepthImage depth_m = step_and_wall();
  const double block_m = 8 * tsdf.voxel_m;
  const auto found = [&](int most) {
    tsdf.max_blocks = most;
    return found_blocks(depth_m, block_m, tsdf, DepthConfig{}).size();
  };
  const std::size_t all = found(4'000'000);
  EXPECT_GT(all, 100'000U);
  EXPECT_EQ(found(static_cast<int>(all)), all);
  EXPECT_GT(found(1), 1U) << "too many, so that the model refuses the frame";
  EXPECT_LT(found(1), all / 5) << "the rest of a row, and of the first rows";
}

}  // namespace
}  // namespace fusebench
