#include "core/base/simd/half_lanes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace fusebench {

using namespace simd;

namespace {

TEST(HalfLanes, RoundToTheNearestOfElevenBits) {
  const Float8 values = {0.0F, 1.0F, -0.04F, 1.0F + 0x1p-11F, 1.0F + 0x3p-11F, 0x1p-14F, 65504.0F, -3.3e-5F};
  std::array<Half, kLanes> stored;
  store(values, stored.data());
  const Float8 read = load(stored.data());
  EXPECT_EQ(read[0], 0.0F);
  EXPECT_EQ(read[1], 1.0F);
  EXPECT_NEAR(read[2], -0.04F, 0x1p-16);
  EXPECT_EQ(read[3], 1.0F);            // a tie goes to the even one
  EXPECT_EQ(read[4], 1.0F + 0x1p-9F);  // upwards as well
  EXPECT_EQ(read[5], 0x1p-14F);
  EXPECT_EQ(read[6], 65504.0F);
  EXPECT_NEAR(read[7], -3.3e-5F, 0x1p-25);
}

TEST(HalfLanes, KeepNan) {
  std::array<Half, kLanes> stored;
  store(Float8{} + std::numeric_limits<float>::quiet_NaN(), stored.data());
  const Float8 read = load(stored.data());
  for (std::size_t lane = 0; lane < kLanes; ++lane) EXPECT_TRUE(std::isnan(read[lane]));
  EXPECT_TRUE(std::isnan(static_cast<float>(stored[3])));
}

TEST(HalfLanes, GatherNeighboursByLane) {
  std::vector<Half> values;
  for (int i = 0; i < 100; ++i) values.emplace_back(0.25F * static_cast<float>(i) - 7.0F);
  values[40] = std::numeric_limits<Half>::quiet_NaN();
  const Int8 at = {0, 98, 39, 40, 17, 64, 3, 3};
  const Pairs pairs = gather_pairs(values.data(), at);
  const Float8 single = gather(values.data(), at);
  const auto expect = [&](float got, int place) {
    const auto value = static_cast<float>(values[static_cast<std::size_t>(place)]);
    EXPECT_TRUE(got == value || (std::isnan(got) && std::isnan(value))) << place;
  };
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    expect(pairs.first[lane], at[lane]);
    expect(pairs.second[lane], at[lane] + 1);
    expect(single[lane], at[lane]);
  }
}

}  // namespace
}  // namespace fusebench
