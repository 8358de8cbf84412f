#include "datasets/recording/reading/image_recording.hpp"

#include <gtest/gtest.h>

#include <cstdint>

#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace images;
using namespace reading;

namespace {

/// Every value that a depth image can hold.
Image<std::uint16_t> all_values() {
  Image<std::uint16_t> values(256, 256);
  for (std::size_t i = 0; i < values.data.size(); ++i) values.data[i] = static_cast<std::uint16_t>(i);
  return values;
}

// Also where a division in single precision is enough: all but the last three.
TEST(PngDepth, IsTheQuotientInDoublePrecisionRounded) {
  const testing::TemporaryFolder folder;
  const Image<std::uint16_t> values = all_values();
  ASSERT_TRUE(write_png(folder.path() / "depth.png", values));
  for (const double units_per_metre : {1.0, 256.0, 1000.0, 4999.0, 5000.0, 6553.5, 8e-4, 5000.1, 1e6 / 3}) {
    const auto depth_m = png_depth(units_per_metre)(folder.path() / "depth.png", {256, 256}, {});
    ASSERT_TRUE(depth_m);
    ASSERT_EQ(depth_m->width, 256);
    for (std::size_t i = 0; i + 1 < values.data.size(); ++i)
      ASSERT_EQ(depth_m->data[i], static_cast<float>(values.data[i] / units_per_metre)) << units_per_metre;
    EXPECT_EQ(depth_m->data.back(), 0.0F);  // 65535 is no measurement
  }
}

TEST(PngDepth, HasTheExpectedSize) {
  const testing::TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder.path() / "depth.png", all_values()));
  const auto depth_m = png_depth(5000)(folder.path() / "depth.png", {640, 480}, {});
  ASSERT_FALSE(depth_m);
  EXPECT_EQ(depth_m.error().code, ErrorCode::data_corrupt);
}

}  // namespace
}  // namespace fusebench
