#include "eval/metrics/intensity_readings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace fusebench {

using namespace metrics;

namespace {

/// Two patches: one of three pixels that passed the gate, one of a single pixel that did not.
const std::vector<SquarePixel> kFrame = {
    {.patch = 0, .accepted = true, .visible = true, .difference_grey = 2, .whole_pixel_grey = 3},
    {.patch = 0, .accepted = true, .visible = true, .difference_grey = 4, .whole_pixel_grey = 5},
    {.patch = 0, .accepted = true, .visible = false, .difference_grey = 9, .whole_pixel_grey = 12},
    {.patch = 4, .accepted = false, .visible = true, .difference_grey = 12, .whole_pixel_grey = 10}};

TEST(IntensityReadings, EachChoiceIsWhatItSays) {
  IntensityReadingsAccumulator sums;
  sums.add_frame(kFrame);
  const IntensityReadings readings = sums.result();
  EXPECT_DOUBLE_EQ(readings.of({}), (2.0 + 4 + 12) / 3);
  EXPECT_DOUBLE_EQ(readings.of({.root_mean_square = true}), std::sqrt((4.0 + 16 + 144) / 3));
  EXPECT_DOUBLE_EQ(readings.of({.mean_over_patches = true}), (3.0 + 12) / 2);
  EXPECT_DOUBLE_EQ(readings.of({.accepted_patches = true}), 3.0);
  EXPECT_DOUBLE_EQ(readings.of({.whole_pixels = true}), (3.0 + 5 + 10) / 3);
  EXPECT_DOUBLE_EQ(readings.of({.whole_squares = true}), (2.0 + 4 + 9 + 12) / 4);
  EXPECT_DOUBLE_EQ(readings.of({.whole_squares = true, .whole_pixels = true, .accepted_patches = true}),
                   (3.0 + 5 + 12) / 3);
}

TEST(IntensityReadings, FramesCountTheSameAndEmptyOnesNotAtAll) {
  IntensityReadingsAccumulator sums;
  EXPECT_TRUE(sums.empty());
  sums.add_frame({});
  EXPECT_TRUE(sums.empty());
  sums.add_frame(kFrame);
  sums.add_frame(std::span(kFrame).first(1));
  EXPECT_FALSE(sums.empty());
  EXPECT_DOUBLE_EQ(sums.result().of({}), (6.0 + 2) / 2);
  IntensityReadingsAccumulator rejected;
  rejected.add_frame(std::span(kFrame).last(1));
  EXPECT_TRUE(std::isnan(rejected.result().of({.accepted_patches = true})));
}

TEST(IntensityReadings, NamesTellAllOfThemApart) {
  std::set<std::string> names;
  for (const IntensityReading& reading : all_intensity_readings()) names.insert(to_string(reading));
  EXPECT_EQ(names.size(), kIntensityReadings);
  EXPECT_EQ(all_intensity_readings().front(), IntensityReading{}) << "AIE's own is the first";
}

}  // namespace
}  // namespace fusebench
