#include "core/estimator/model/tsdf/tsdf_volume.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/tsdf_config.hpp"
#include "tests/support/fused_scene.hpp"
#include "tests/support/plain_field.hpp"

namespace fusebench {

using namespace simd;
using namespace config;
using namespace tsdf;

namespace {

const PinholeCamera kCamera = test_camera(160, 120, 60.0);
const SE3 kOrigin;
// The model keeps eleven binary digits: of numbers from 1/2 to 1, half of the last one is this.
constexpr double kHalfOfDigit = 1.0 / 4096.0;

// A wall across the optical axis: its projective distance is depth - z, whatever the pixel.
AnalyticScene wall(double depth_m) { return {{AnalyticPlane{{0, 0, -1}, -depth_m, {10, 120, 250}}}}; }

RgbdFrame wall_frame(double depth_m) { return wall(depth_m).render(kCamera, kOrigin); }

bool same_voxels(const TsdfVolume& a, const TsdfVolume& b) {
  if (a.block_indices() != b.block_indices()) return false;
  for (std::size_t slot = 0; slot < a.block_count(); ++slot) {
    for (std::size_t i = 0; i < kBlockVoxels; ++i) {
      const Voxel of_a = a.voxel(slot, i);
      const Voxel of_b = b.voxel(slot, i);
      if (std::memcmp(&of_a, &of_b, sizeof(Voxel)) != 0) return false;
    }
  }
  return true;
}

template <class Visit>
void for_each_voxel(const TsdfVolume& volume, const Visit& visit) {
  for (std::size_t slot = 0; slot < volume.block_count(); ++slot) {
    for (int i = 0; i < kBlockVoxels; ++i) {
      const VoxelIndex local(i & 7, (i >> 3) & 7, i >> 6);
      visit(volume.block_indices()[slot] * kBlockSide + local,
            volume.voxel(slot, static_cast<std::size_t>(i)));
    }
  }
}

TEST(TsdfVolume, IsEmptyAtFirst) {
  const TsdfVolume volume{TsdfConfig{}};
  EXPECT_EQ(volume.block_count(), 0U);
  EXPECT_EQ(volume.find_block({0, 0, 0}), -1);
  EXPECT_FALSE(testing::find_voxel(volume, {1, 2, 3}));
}

TEST(TsdfVolume, TheVoxelNearestToAPointIsFoundWhereItIsStored) {
  const TsdfVolume volume = fuse(ball_scene(), kCamera, {look_at({0.31, -0.42, -0.93}, {0.05, 0.02, 0.0})});
  int seen = 0;
  for_each_voxel(volume, [&](const VoxelIndex& index, const Voxel& voxel) {
    for (const double aside : {-0.49, 0.0, 0.49}) {
      const Vector3d point = (index.cast<double>() + Vector3d(aside, -aside, aside)) * volume.voxel_m();
      const auto place = volume.nearest_voxel(point);
      ASSERT_TRUE(place);
      EXPECT_EQ(volume.block_indices()[place->slot], block_of(index));
      EXPECT_EQ(place->offset, offset_in_block(index));
      EXPECT_EQ(volume.voxel(place->slot, place->offset).weight, voxel.weight);
    }
    seen += voxel.weight > 0.0F ? 1 : 0;
  });
  EXPECT_GT(seen, 1000);
  EXPECT_FALSE(volume.nearest_voxel({0.0, 0.0, 5.0}));
  EXPECT_FALSE(TsdfVolume{TsdfConfig{}}.nearest_voxel({0.0, 0.0, 0.0}));
}

TEST(TsdfVolume, HoldsTheClampedProjectiveDistanceOfAWall) {
  const double depth_m = 1.003;
  const TsdfVolume volume = fuse(wall(depth_m), kCamera, {kOrigin});
  const double band_m = volume.truncation_m(depth_m, DepthConfig{});
  ASSERT_DOUBLE_EQ(band_m, 0.04);
  int inside = 0, front = 0;
  for_each_voxel(volume, [&](const VoxelIndex& index, const Voxel& voxel) {
    const double distance_m = depth_m - index.z() * volume.voxel_m();
    if (distance_m <= -band_m) {
      EXPECT_EQ(voxel.weight, 0.0F);
    } else if (voxel.weight > 0.0F) {
      EXPECT_NEAR(static_cast<double>(voxel.distance_m), std::min(distance_m, band_m), 0.07 * kHalfOfDigit);
      ++(distance_m < band_m ? inside : front);
    }
  });
  EXPECT_GT(inside, 10000);
  EXPECT_GT(front, 1000);
}

TEST(TsdfVolume, AllocatesEveryBlockThatABandPasses) {
  const SE3 T_world_camera = look_at({0.31, -0.42, -0.93}, {0.05, 0.02, 0.0});
  const AnalyticScene scene = ball_scene();
  const RgbdFrame frame = scene.render(kCamera, T_world_camera);
  const TsdfVolume volume = fuse(scene, kCamera, {T_world_camera});
  const double block_m = kBlockSide * volume.voxel_m();
  int missing = 0, points = 0;
  for (int y = 0; y < kCamera.height_px; ++y) {
    for (int x = 0; x < kCamera.width_px; ++x) {
      const double depth_m = frame.depth_m(x, y);
      if (depth_m == 0.0) continue;
      for (double offset_m = -0.0399; offset_m < 0.04; offset_m += 0.0021) {
        const Vector3d point = T_world_camera * kCamera.back_project(x, y, depth_m + offset_m) / block_m;
        missing += volume.find_block(point.array().floor().matrix().cast<int>()) < 0 ? 1 : 0;
        ++points;
      }
    }
  }
  EXPECT_GT(points, 50000);
  EXPECT_EQ(missing, 0);
  EXPECT_LT(volume.block_count(), 600U);  // and not all blocks around: the ball's front has about 0.3 m2
}

TEST(TsdfVolume, WeighsByTheDepthNoise) {
  const DepthConfig depth;
  const auto weight_at = [&](double depth_m) {
    const TsdfVolume volume = fuse(wall(depth_m), kCamera, {kOrigin});
    return static_cast<double>(testing::find_voxel(volume, {0, 0, static_cast<int>(depth_m * 100)})->weight);
  };
  for (const double depth_m : {0.5, 1.0, 2.0, 4.0}) {
    const double sigma_m = 0.0012 + 0.0019 * (depth_m - 0.4) * (depth_m - 0.4);
    const double expected = 1e-4 / (1e-4 + sigma_m * sigma_m);
    EXPECT_NEAR(weight_at(depth_m), expected, kHalfOfDigit);
    EXPECT_NEAR(TsdfVolume{TsdfConfig{}}.measurement_weight(depth_m, depth), expected, 1e-12);
  }
  EXPECT_GT(weight_at(0.5), 5 * weight_at(4.0));
}

TEST(TsdfVolume, WeightDecreasesOverTheBackHalfOfTheBand) {
  const TsdfVolume volume = fuse(wall(1.0), kCamera, {kOrigin});
  const auto weight = [&](int z) {
    return static_cast<double>(testing::find_voxel(volume, {0, 0, z})->weight);
  };
  for (const int z : {97, 99, 101}) EXPECT_DOUBLE_EQ(weight(z), weight(100));
  EXPECT_NEAR(weight(102), weight(100), 1e-3);
  EXPECT_NEAR(weight(103), 0.5 * weight(100), 1e-3);
  EXPECT_NEAR(weight(104), 0.0, 1e-4);
}

TEST(TsdfVolume, KeepsTheRunningMeanAndSaturates) {
  TsdfConfig tsdf;
  tsdf.max_weight = 4.0;
  const Workers workers(1);
  TsdfVolume volume(tsdf);
  const VoxelIndex index(1, -2, 100);
  double mean_m = 0, weight = 0;
  for (const double depth_m : {1.000, 1.012, 1.004, 0.996, 1.008, 1.001, 1.015, 1.015}) {
    ASSERT_TRUE(volume.integrate(wall_frame(depth_m), kCamera, kOrigin, DepthConfig{}, workers));
    const double sigma_m = 0.0012 + 0.0019 * (depth_m - 0.4) * (depth_m - 0.4);
    const double share = 1e-4 / (1e-4 + sigma_m * sigma_m);
    mean_m = (mean_m * weight + (depth_m - 1.0) * share) / (weight + share);
    weight = std::min(4.0, weight + share);
    EXPECT_NEAR(static_cast<double>(testing::find_voxel(volume, index)->distance_m), mean_m,
                0.05 * kHalfOfDigit);
    EXPECT_NEAR(static_cast<double>(testing::find_voxel(volume, index)->weight), weight, 12 * kHalfOfDigit);
  }
  EXPECT_FLOAT_EQ(testing::find_voxel(volume, index)->weight, 4.0F);
}

TEST(TsdfVolume, AveragesBandsOfDifferentWidthConsistently) {
  TsdfConfig tsdf;
  tsdf.truncation_sigmas = 12.0;  // 4 cm near by, 9 cm from 3 m
  const SE3 far_away{Quaterniond::Identity(), Vector3d(0, 0, -1.2)};
  const TsdfVolume volume = fuse(wall(1.0), kCamera, {kOrigin, far_away}, tsdf);
  ASSERT_GT(volume.truncation_m(2.2, DepthConfig{}), 1.5 * volume.truncation_m(1.0, DepthConfig{}));
  for (int z = 97; z <= 103; ++z) {
    EXPECT_NEAR(static_cast<double>(testing::find_voxel(volume, {3, 4, z})->distance_m), 1.0 - 0.01 * z,
                0.07 * kHalfOfDigit);
  }
}

TEST(TsdfVolume, TruncationIsTheWidestOfThreeBands) {
  const DepthConfig depth;
  TsdfConfig tsdf;
  EXPECT_DOUBLE_EQ(TsdfVolume(tsdf).truncation_m(1.0, depth), 0.04);
  tsdf.voxel_m = 0.03;
  EXPECT_DOUBLE_EQ(TsdfVolume(tsdf).truncation_m(1.0, depth), 0.06);
  EXPECT_NEAR(TsdfVolume(tsdf).truncation_m(4.4, depth), 3.0 * (0.0012 + 0.0019 * 16.0), 1e-12);
}

TEST(TsdfVolume, IgnoresDepthThatIsNoMeasurement) {
  const Workers workers(1);
  TsdfVolume volume{TsdfConfig{}};
  RgbdFrame frame = wall_frame(1.0);
  for (const float value : {0.0F, -1.0F, 0.29F, 5.01F, std::numeric_limits<float>::quiet_NaN(),
                            std::numeric_limits<float>::infinity()}) {
    std::fill(frame.depth_m.data.begin(), frame.depth_m.data.end(), value);
    ASSERT_TRUE(volume.integrate(frame, kCamera, kOrigin, DepthConfig{}, workers));
    EXPECT_EQ(volume.block_count(), 0U) << value;
  }
  frame = wall_frame(1.0);
  for (std::size_t i = 0; i < frame.depth_m.data.size(); i += 3) {
    frame.depth_m.data[i] = std::numeric_limits<float>::quiet_NaN();
  }
  ASSERT_TRUE(volume.integrate(frame, kCamera, kOrigin, DepthConfig{}, workers));
  EXPECT_GT(volume.block_count(), 0U);
  for_each_voxel(volume, [](const VoxelIndex&, const Voxel& voxel) {
    EXPECT_TRUE(std::isfinite(voxel.weight));
    EXPECT_EQ(std::isfinite(voxel.distance_m), voxel.weight > 0.0F);
  });
}

TEST(TsdfVolume, PutsColourNearTheSurfaceOnly) {
  const TsdfVolume volume = fuse(wall(1.0), kCamera, {kOrigin, kOrigin, kOrigin});
  EXPECT_EQ(testing::find_voxel(volume, {0, 0, 99})->color, (Rgb{10, 120, 250}));
  EXPECT_EQ(testing::find_voxel(volume, {0, 0, 101})->color, (Rgb{10, 120, 250}));
  EXPECT_EQ(testing::find_voxel(volume, {0, 0, 99})->color_count, 3);
  EXPECT_EQ(testing::find_voxel(volume, {0, 0, 97})->color_count, 0);
  EXPECT_GT(testing::find_voxel(volume, {0, 0, 97})->weight, 0.0F);
}

TEST(TsdfVolume, AveragesColour) {
  const Workers workers(1);
  TsdfVolume volume{TsdfConfig{}};
  RgbdFrame frame = wall_frame(1.0);
  double sum = 0;
  for (const int red : {255, 0, 17, 90, 200, 3}) {
    std::fill(frame.color.data.begin(), frame.color.data.end(), Rgb{static_cast<std::uint8_t>(red), 0, 255});
    ASSERT_TRUE(volume.integrate(frame, kCamera, kOrigin, DepthConfig{}, workers));
    sum += red;
  }
  const Rgb rgb = testing::find_voxel(volume, {0, 0, 100})->color;
  EXPECT_NEAR(rgb[0], sum / 6.0, 1.0);
  EXPECT_EQ(rgb[2], 255);
}

TEST(TsdfVolume, FollowsColourInStepsOfLessThanALevel) {
  const Workers workers(1);
  TsdfVolume volume{TsdfConfig{}};
  RgbdFrame frame = wall_frame(1.0);
  // With 64 or more observations, a frame moves the mean by a sixteenth of a level.
  const auto fuse_grey = [&](std::uint8_t level, int frames) {
    std::fill(frame.color.data.begin(), frame.color.data.end(), Rgb{level, level, level});
    for (int i = 0; i < frames; ++i)
      ASSERT_TRUE(volume.integrate(frame, kCamera, kOrigin, DepthConfig{}, workers));
  };
  fuse_grey(100, 64);
  EXPECT_EQ(testing::find_voxel(volume, {0, 0, 100})->color[0], 100);
  fuse_grey(104, 300);
  EXPECT_GE(testing::find_voxel(volume, {0, 0, 100})->color[0], 103);
}

TEST(TsdfVolume, IsTheSameForEveryNumberOfThreads) {
  const auto fused = [](int threads) {
    return fuse(ball_scene(), kCamera, poses_around_ball(), TsdfConfig{}, DepthConfig{}, threads);
  };
  const TsdfVolume one = fused(1);
  EXPECT_GT(one.block_count(), 300U);
  EXPECT_TRUE(same_voxels(one, fused(2)));
  EXPECT_TRUE(same_voxels(one, fused(8)));
}

TEST(TsdfVolume, IsUnchangedByAFrameThatDoesNotFit) {
  const Workers workers(2);
  TsdfConfig tsdf;
  const std::size_t needed = fuse(wall(1.0), kCamera, {kOrigin}).block_count();
  tsdf.max_blocks = static_cast<int>(needed);
  TsdfVolume volume(tsdf);
  ASSERT_TRUE(volume.integrate(wall_frame(1.0), kCamera, kOrigin, DepthConfig{}, workers)) << "fits exactly";
  const TsdfVolume before = volume;
  const auto full = volume.integrate(wall_frame(1.2), kCamera, kOrigin, DepthConfig{}, workers);
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().code, ErrorCode::run_failed);
  EXPECT_NE(full.error().message.find("tsdf.max_blocks = " + std::to_string(needed)), std::string::npos)
      << full.error().message;
  EXPECT_FALSE(full.error().hint.empty());
  EXPECT_TRUE(same_voxels(volume, before));
  for_each_voxel(volume, [&](const VoxelIndex& index, const Voxel&) {
    ASSERT_TRUE(testing::find_voxel(volume, index));
  });
  EXPECT_TRUE(volume.integrate(wall_frame(1.0), kCamera, kOrigin, DepthConfig{}, workers))
      << "and stays usable";
  EXPECT_FALSE(same_voxels(volume, before));
}

TEST(TsdfVolume, RefusesAPoseOutsideTheLattice) {
  const Workers workers(1);
  TsdfVolume volume{TsdfConfig{}};
  for (const double x :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e9}) {
    const auto result = volume.integrate(
        wall_frame(1.0), kCamera, {Quaterniond::Identity(), Vector3d(x, 0, 0)}, DepthConfig{}, workers);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::run_failed);
    EXPECT_EQ(volume.block_count(), 0U);
  }
}

}  // namespace
}  // namespace fusebench
