#include "core/steps/repeated_images.hpp"

#include <gtest/gtest.h>

#include "tests/support/textured_room.hpp"

namespace fusebench {

using core::Novelty;
using core::RepeatedImages;

namespace {

RgbdFrame room_from(double x_m) {
  return testing::TexturedRoom{}.render(testing::small_camera(), SE3(Quaterniond::Identity(), {x_m, 0, 0}),
                                        0);
}

TEST(RepeatedImages, EachImageIsComparedWithTheOneBefore) {
  RepeatedImages images;
  const RgbdFrame first = room_from(0);
  const RgbdFrame second = room_from(0.01);
  Novelty novelty = images.examine(first);
  EXPECT_TRUE(novelty.color && novelty.depth);
  novelty = images.examine(first);
  EXPECT_FALSE(novelty.color || novelty.depth);
  RgbdFrame late_color = second;
  late_color.grey = first.grey;
  novelty = images.examine(late_color);
  EXPECT_FALSE(novelty.color);
  EXPECT_TRUE(novelty.depth);
  novelty = images.examine(second);
  EXPECT_TRUE(novelty.color);
  EXPECT_FALSE(novelty.depth);
}

TEST(RepeatedImages, AnImageOfOneValueIsNoRepetition) {
  RepeatedImages images;
  RgbdFrame frame = room_from(0);
  frame.depth_m = DepthImage(frame.grey.width, frame.grey.height);  // a sensor without depth
  (void)images.examine(frame);
  const Novelty novelty = images.examine(frame);
  EXPECT_FALSE(novelty.color);
  EXPECT_TRUE(novelty.depth);
}

}  // namespace
}  // namespace fusebench
