#include "core/baselines/elasticfusion/surfels/surfel_measure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/baselines/elasticfusion/surfels/smooth_depth.hpp"

namespace fusebench {

using namespace baselines::elasticfusion::surfels;

namespace {

const PinholeCamera kVgaCamera = {640, 480, 500, 500, 320, 240};

TEST(SurfelMeasure, RadiusCoversAPixelAndIsAtMostTwiceThat) {
  const float front = std::numbers::sqrt2_v<float> * 2.0F / 500.0F;
  EXPECT_FLOAT_EQ(radius_of(2, -1, kVgaCamera), front);
  EXPECT_FLOAT_EQ(radius_of(2, -0.8F, kVgaCamera), front / 0.8F);
  EXPECT_FLOAT_EQ(radius_of(2, -0.1F, kVgaCamera), 2 * front);
}

TEST(SurfelMeasure, ConfidenceFallsFromTheMiddleAndWithMotion) {
  EXPECT_FLOAT_EQ(confidence_of(320, 240, kVgaCamera, 1), 1);
  // 200 px from the middle are half of the 400 px to a corner.
  EXPECT_FLOAT_EQ(confidence_of(520, 240, kVgaCamera, 1), std::exp(-0.25F / 0.72F));
  EXPECT_FLOAT_EQ(confidence_of(520, 240, kVgaCamera, 0.5F), 0.5F * std::exp(-0.25F / 0.72F));
  EXPECT_FLOAT_EQ(weight_of_motion(SE3{}), 1);
  EXPECT_FLOAT_EQ(weight_of_motion({Quaterniond::Identity(), {0.002, 0, 0}}), 0.8F);
  EXPECT_FLOAT_EQ(weight_of_motion({so3_exp({0, 0.003, 0}), {0.002, 0, 0}}), 0.7F);
  EXPECT_FLOAT_EQ(weight_of_motion({Quaterniond::Identity(), {0.2, 0, 0}}), 0.5F);
}

TEST(SurfelMeasure, TwoSurfelsMergeByTheirConfidences) {
  const Surfel known{{0, 0, 1}, {0, 0, -1}, {100, 0, 200}, 0.01F, 3, 5, 6};
  const Surfel measured{{0, 0, 1.04F}, {0, 0, -1}, {200, 0, 100}, 0.012F, 1, 9, 9};
  const Surfel both = merged(known, measured);
  EXPECT_FLOAT_EQ(both.position.z(), 1.01F);
  EXPECT_FLOAT_EQ(both.radius_m, 0.0105F);
  EXPECT_FLOAT_EQ(both.confidence, 4);
  EXPECT_EQ(both.color, (Rgb{125, 0, 175}));
  EXPECT_EQ(both.created, 5);
  EXPECT_EQ(both.updated, 9);
}

TEST(SurfelMeasure, ACoarserMeasurementOnlyConfirms) {
  const Surfel known{{0, 0, 1}, {0, 0, -1}, {100, 0, 200}, 0.01F, 3, 5, 6};
  const Surfel coarse{{0, 0, 1.04F}, {0, 0, -1}, {200, 0, 100}, 0.016F, 1, 9, 9};
  const Surfel both = merged(known, coarse);
  EXPECT_EQ(both.position, known.position);
  EXPECT_EQ(both.color, known.color);
  EXPECT_FLOAT_EQ(both.confidence, 4);
  EXPECT_EQ(both.updated, 9);
}

TEST(SmoothDepth, IsThePlainBilateralMean) {
  DepthImage depth(23, 17);
  for (int y = 0; y < depth.height; ++y) {
    for (int x = 0; x < depth.width; ++x) {
      depth(x, y) = x < 12 ? 1.0F + 0.004F * static_cast<float>((x * 7 + y * 3) % 5) : 1.5F;
      if ((x + y) % 11 == 0) depth(x, y) = 0;
    }
  }
  const DepthImage smooth = smooth_depth(depth, Workers(2));
  for (int y = 0; y < depth.height; ++y) {
    for (int x = 0; x < depth.width; ++x) {
      if (!(depth(x, y) > 0)) {
        EXPECT_EQ(smooth(x, y), 0);
        continue;
      }
      double sum = 0, weights = 0;
      for (int v = y - 6; v <= y + 6; ++v) {
        for (int u = x - 6; u <= x + 6; ++u) {
          if (!depth.contains(u, v) || !(depth(u, v) > 0)) continue;
          const double off = static_cast<double>(depth(u, v) - depth(x, y)) / 0.03;
          const double weight =
              std::exp(-((u - x) * (u - x) + (v - y) * (v - y)) / (2 * 4.5 * 4.5) - 0.5 * off * off);
          sum += weight * static_cast<double>(depth(u, v));
          weights += weight;
        }
      }
      EXPECT_NEAR(static_cast<double>(smooth(x, y)), sum / weights, 1e-4) << x << " " << y;
    }
  }
}

}  // namespace
}  // namespace fusebench
