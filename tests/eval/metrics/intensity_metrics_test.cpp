#include "eval/metrics/intensity_metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "eval/metrics/intensity_file.hpp"

namespace fusebench {

using namespace metrics;

namespace {

using Pixels = std::vector<IntensityResidual>;

TEST(IntensityError, IsTheMeanOverFramesOfTheMeanOverPixels) {
  IntensityAccumulator sums;
  sums.add_frame(Pixels{{0, 1.0F, true}, {1, 2.0F, true}, {2, 6.0F, false}});  // mean 3; accepted 1.5
  sums.add_frame({});                                                          // nothing tracked
  sums.add_frame(Pixels{{9, 5.0F, false}});                                    // mean 5; nothing accepted
  const IntensityResult result = sums.result();
  EXPECT_DOUBLE_EQ(result.all.aie_grey, 4.0);  // not (1 + 2 + 6 + 5) / 4: each frame counts the same
  EXPECT_EQ(result.all.pixels, 4U);
  EXPECT_EQ(result.all.frames, 2U);
  EXPECT_EQ(result.all.frames_excluded, 1U);
  EXPECT_DOUBLE_EQ(result.all.rms_grey, std::sqrt((41.0 / 3.0 + 25.0) / 2));
  EXPECT_DOUBLE_EQ(result.accepted.aie_grey, 1.5);
  EXPECT_EQ(result.accepted.frames, 1U);
  EXPECT_EQ(result.accepted.frames_excluded, 2U);
}

TEST(IntensityError, OfNothingIsNotANumber) {
  EXPECT_TRUE(std::isnan(IntensityAccumulator{}.result().all.aie_grey));
  EXPECT_TRUE(std::isnan(frame_intensity_error({})));
}

TEST(CommonIntensityError, ComparesOnlySharedPixels) {
  CommonIntensityAccumulator sums(2);
  // Run 1 drops the hard pixel 7 and would look better than run 0.
  const std::vector<Pixels> first = {{{5, 2.0F, true}, {7, 50.0F, true}, {6, 4.0F, true}},
                                     {{6, 5.0F, true}, {5, 3.0F, true}, {8, 0.0F, true}}};
  sums.add_frame(first);
  const std::vector<Pixels> disjoint = {{{1, 1.0F, true}}, {{2, 1.0F, true}}};
  sums.add_frame(disjoint);
  const auto result = sums.result();
  ASSERT_EQ(result.size(), 2U);
  EXPECT_DOUBLE_EQ(result[0].aie_grey, 3.0);
  EXPECT_DOUBLE_EQ(result[1].aie_grey, 4.0);
  for (const auto& run : result) {
    EXPECT_EQ(run.pixels, 2U);
    EXPECT_EQ(run.frames, 1U);
    EXPECT_EQ(run.frames_excluded, 1U);
  }
}

TEST(CommonIntensityError, TheFirstOccurrenceOfAPixelCounts) {
  CommonIntensityAccumulator sums(2);
  const std::vector<Pixels> frame = {{{5, 2.0F, true}, {5, 9.0F, true}}, {{5, 4.0F, true}}};
  sums.add_frame(frame);
  EXPECT_DOUBLE_EQ(sums.result()[0].aie_grey, 2.0);
}

TEST(CommonIntensityError, OfOneRunWithoutOverlapsIsItsOwn) {
  const Pixels pixels = {{3, 1.5F, true}, {1, 2.5F, false}};
  CommonIntensityAccumulator common(1);
  IntensityAccumulator alone;
  common.add_frame(std::vector<Pixels>{pixels});
  alone.add_frame(pixels);
  EXPECT_EQ(common.result()[0].aie_grey, alone.result().all.aie_grey);
}

class IntensityFile : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    file_ = std::filesystem::temp_directory_path() /
            (std::string("fusebench_intensity_") + test->name() + ".bin");
    auto writer = IntensityWriter::create(file_, 640, 480);
    ASSERT_TRUE(writer.has_value());
    ASSERT_TRUE(writer->write_frame(100, Pixels{}).has_value());
    ASSERT_TRUE(writer->write_frame(200, Pixels{{640 * 480 - 1, 1.25F, true}, {0, 0.0F, false}}).has_value());
    ASSERT_TRUE(writer->finish().has_value());
  }
  void TearDown() override { std::filesystem::remove(file_); }

  /// Reads to the end; the error if there is one.
  [[nodiscard]] Result<int> count_frames() const {
    auto reader = IntensityReader::open(file_);
    if (!reader) return tl::unexpected(reader.error());
    for (int frames = 0;; ++frames) {
      auto frame = reader->next();
      if (!frame) return tl::unexpected(frame.error());
      if (!*frame) return frames;
    }
  }
  std::filesystem::path file_;
};

TEST_F(IntensityFile, ReadsWhatWasWritten) {
  auto reader = IntensityReader::open(file_);
  ASSERT_TRUE(reader.has_value());
  EXPECT_EQ(reader->width_px(), 640U);
  EXPECT_EQ(reader->height_px(), 480U);
  auto first = reader->next();
  ASSERT_TRUE(first && *first);
  EXPECT_EQ((*first)->timestamp_ns, 100);
  EXPECT_TRUE((*first)->pixels.empty());
  auto second = reader->next();
  ASSERT_TRUE(second && *second);
  ASSERT_EQ((*second)->pixels.size(), 2U);
  EXPECT_EQ((*second)->pixels[0].pixel, 640U * 480U - 1);
  EXPECT_EQ((*second)->pixels[0].difference_grey, 1.25F);
  EXPECT_TRUE((*second)->pixels[0].accepted);
  EXPECT_EQ((*second)->pixels[1].difference_grey, 0.0F);
  EXPECT_FALSE((*second)->pixels[1].accepted);
  auto end = reader->next();
  ASSERT_TRUE(end.has_value());
  EXPECT_FALSE(end->has_value());
}

TEST_F(IntensityFile, EveryTruncationIsFound) {
  const auto whole = std::filesystem::file_size(file_);
  ASSERT_EQ(*count_frames(), 2);
  for (auto size = whole; size-- > 0;) {
    std::filesystem::resize_file(file_, size);
    const auto frames = count_frames();
    ASSERT_FALSE(frames.has_value()) << "cut to " << size << " bytes";
    EXPECT_EQ(frames.error().code, ErrorCode::data_corrupt);
  }
}

TEST_F(IntensityFile, DamageIsFound) {
  const auto damage = [&](std::streamoff position, char byte) {
    std::fstream stream(file_, std::ios::binary | std::ios::in | std::ios::out);
    stream.seekp(position);
    stream.put(byte);
  };
  damage(32, '\x7f');  // the high byte of a count: must not allocate gigabytes
  damage(35, '\x7f');
  const auto frames = count_frames();
  ASSERT_FALSE(frames.has_value());
  EXPECT_EQ(frames.error().code, ErrorCode::data_corrupt);
  damage(0, 'X');
  EXPECT_EQ(IntensityReader::open(file_).error().code, ErrorCode::data_corrupt);
}

TEST_F(IntensityFile, MissingFileIsMissingData) {
  EXPECT_EQ(IntensityReader::open(file_.string() + ".absent").error().code, ErrorCode::data_missing);
}

}  // namespace
}  // namespace fusebench
