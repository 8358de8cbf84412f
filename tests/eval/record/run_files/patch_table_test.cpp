#include "eval/record/run_files/patch_table.hpp"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace simd;
using namespace health;
using namespace run_files;

namespace {

class PatchTable : public testing::InTemporaryFolder {};

FrameReport moved(double motion_px, std::uint32_t pixel) {
  FrameReport report;
  report.status = FrameStatus::tracked;
  report.timestamp_ns = 1'305'031'229'000'000'000 + static_cast<std::int64_t>(pixel);
  report.patch_motion_px = motion_px;
  report.pixels.intensity = {{pixel, 3.5F, true}};
  report.pixels.warped = {{7, pixel, {12.25F, 8.5F}, 100.5F, 104.0F}};
  return report;
}

TEST_F(PatchTable, KeepsTheFastestFramesInOrder) {
  FastestFrames fastest;
  const GreyImage grey(20, 10, 77);
  for (std::uint32_t frame = 0; frame < 6; ++frame)
    fastest.offer(frame, moved(std::array{3.0, 9.0, 1.0, 7.0, 2.0, 8.0}[frame], 20 * frame + 5), grey);
  FrameReport lost = moved(99, 5);
  lost.status = FrameStatus::lost;
  fastest.offer(6, lost, grey);
  ASSERT_EQ(fastest.frames().size(), 3U);
  EXPECT_EQ(fastest.frames()[0].frame, 1U);
  EXPECT_EQ(fastest.frames()[1].frame, 3U);
  EXPECT_EQ(fastest.frames()[2].frame, 5U);

  ASSERT_TRUE(write_patch_table(folder_, fastest.frames()).has_value());
  const auto read = read_patch_table(folder_);
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_EQ(read->size(), 3U);
  const PatchTableFrame& frame = (*read)[1];
  EXPECT_EQ(frame.frame, 3U);
  EXPECT_EQ(frame.timestamp_ns, 1'305'031'229'000'000'065);
  EXPECT_EQ(frame.motion_px, 7);
  EXPECT_EQ(frame.grey.data, grey.data);
  ASSERT_EQ(frame.pixels.size(), 1U);
  const PatchTablePixel& pixel = frame.pixels[0];
  EXPECT_EQ(pixel.patch, 7U);
  EXPECT_TRUE(pixel.accepted);
  EXPECT_EQ(pixel.reference_px, Eigen::Vector2i(5, 3));
  EXPECT_EQ(pixel.warped_px, Eigen::Vector2f(12.25F, 8.5F));
  EXPECT_EQ(pixel.reference_grey, 100.5F);
  EXPECT_EQ(pixel.observed_grey, 104.0F);
}

TEST_F(PatchTable, NothingIsNoError) {
  ASSERT_TRUE(write_patch_table(folder_, {}).has_value());
  EXPECT_TRUE(read_patch_table(folder_)->empty());
}

TEST_F(PatchTable, NamesTheBrokenLine) {
  write("patches.csv", "1,1.0,5,0,1,2,3,4.0,5.0,6.0,7.0\n1,1.0,5,0,1,2,x,4.0,5.0,6.0,7.0\n");
  const auto read = read_patch_table(folder_);
  ASSERT_FALSE(read.has_value());
  EXPECT_NE(read.error().message.find("patches.csv:2"), std::string::npos) << read.error().message;
}

}  // namespace
}  // namespace fusebench
