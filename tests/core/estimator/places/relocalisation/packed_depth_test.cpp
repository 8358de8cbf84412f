#include "core/estimator/places/relocalisation/packed_depth.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fusebench {

using namespace relocalisation;

namespace {

TEST(PackedDepth, KeepsDepthToHalfAStepAndHolesAsTheyAre) {
  DepthImage depth_m(7, 5);
  for (std::size_t i = 0; i < depth_m.data.size(); ++i) {
    depth_m.data[i] = i % 4 == 0 ? 0.0F : 0.3F + 4.7F * std::sqrt(static_cast<float>(i) / 34.0F);
  }
  const DepthImage again_m = PackedDepth(depth_m).unpacked_m();
  ASSERT_EQ(again_m.width, 7);
  ASSERT_EQ(again_m.height, 5);
  const float half_step_m = 0.5F * 5.0F / 65535.0F;
  for (std::size_t i = 0; i < depth_m.data.size(); ++i) {
    if (depth_m.data[i] == 0.0F) {
      EXPECT_EQ(again_m.data[i], 0.0F);
    } else {
      EXPECT_NEAR(again_m.data[i], depth_m.data[i], 1.01F * half_step_m);
    }
  }
}

TEST(PackedDepth, KeepsTheLeastMeasurementNextToAFarOne) {
  DepthImage depth_m(2, 1);
  depth_m.data = {1e-6F, 5.0F};
  EXPECT_GT(PackedDepth(depth_m).unpacked_m().data[0], 0.0F);
}

TEST(PackedDepth, AnImageWithoutDepthOrPixelsIsOne) {
  const DepthImage none_m = PackedDepth(DepthImage(3, 2)).unpacked_m();
  EXPECT_EQ(none_m.data, std::vector<float>(6, 0.0F));
  EXPECT_TRUE(PackedDepth(DepthImage()).unpacked_m().empty());
}

}  // namespace
}  // namespace fusebench
