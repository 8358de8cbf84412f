#include "datasets/recording/exports/export_formats.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include "datasets/recording/exports/export_recording.hpp"
#include "datasets/recording/image_logs/zlib_bytes.hpp"
#include "tests/datasets/recording/exports/made_recording.hpp"
#include "tests/support/expect_text.hpp"

namespace fusebench {

using namespace exports;
using namespace image_logs;
using namespace std::string_literals;
using testing::expect_contains;
using testing::made_frame;
using testing::made_recording;

namespace {

using KlgExport = testing::InTemporaryFolder;

/// Little-endian, of four bytes.
std::size_t number_at(std::string_view bytes, std::size_t at) {
  std::size_t number = 0;
  for (std::size_t i = 4; i-- > 0;) number = number << 8 | static_cast<unsigned char>(bytes[at + i]);
  return number;
}

TEST_F(KlgExport, FramesAreStoredAsTheyAreAndTheLastOneTwice) {
  ASSERT_TRUE(export_recording(made_recording(640, 480, 3), ExportFormat::klg, folder_ / "room.klg"));
  const std::string bytes = testing::read_bytes(folder_ / "room.klg");
  EXPECT_EQ(number_at(bytes, 0), 4);
  std::size_t at = 4;
  for (const int k : {0, 1, 2, 2}) {
    ASSERT_LE(at + 16, bytes.size());
    const RgbdFrame made = made_frame(640, 480, k);
    EXPECT_EQ(number_at(bytes, at) | number_at(bytes, at + 4) << 32, made.timestamp_ns / 1000);
    const std::size_t depth_size = number_at(bytes, at + 8), color_size = number_at(bytes, at + 12);
    ASSERT_LE(at + 16 + depth_size + color_size, bytes.size());
    const auto stored = testing::stored_depth(made, 1000, 65535);
    const std::string_view packed = std::string_view(bytes).substr(at + 16, depth_size);
    const auto depth = unpacked_depth(packed, 640, 480);
    ASSERT_TRUE(depth);
    EXPECT_EQ(depth->data, stored.data);
    ASSERT_EQ(color_size, made.color.data.size() * sizeof(Rgb));
    EXPECT_EQ(bytes.compare(at + 16 + depth_size, color_size,
                            reinterpret_cast<const char*>(made.color.data.data()), color_size),
              0);
    at += 16 + depth_size + color_size;
  }
  EXPECT_EQ(at, bytes.size());
}

TEST_F(KlgExport, BytesAreThoseOfTheLayout) {
  ASSERT_TRUE(export_recording(made_recording(640, 480, 1), ExportFormat::klg, folder_ / "room.klg"));
  const std::string bytes = testing::read_bytes(folder_ / "room.klg");
  // Two frames, since the last one is doubled; 10^9 us; 640 * 480 * 3 bytes of colour.
  EXPECT_EQ(bytes.substr(0, 4), "\x02\x00\x00\x00"s);
  EXPECT_EQ(bytes.substr(4, 8), "\x00\xCA\x9A\x3B\x00\x00\x00\x00"s);
  EXPECT_EQ(bytes.substr(16, 4), "\x00\x10\x0E\x00"s);
  const std::size_t depth_size = number_at(bytes, 12);
  const std::size_t frame_size = 16 + depth_size + 921600;
  ASSERT_EQ(bytes.size(), 4 + 2 * frame_size);
  EXPECT_EQ(bytes.substr(4, frame_size), bytes.substr(4 + frame_size));
  std::string depth(640 * 480 * 2, '\0');
  uLongf unpacked = depth.size();
  ASSERT_EQ(uncompress(reinterpret_cast<Bytef*>(depth.data()), &unpacked,
                       reinterpret_cast<const Bytef*>(bytes.data() + 20), depth_size),
            Z_OK);
  ASSERT_EQ(unpacked, depth.size());
  // Pixels 0 to 4 of the first row: none, 40 m, beyond the range, too near, 500 + 31 * 4 mm.
  EXPECT_EQ(depth.substr(0, 10), "\x00\x00\x40\x9C\x00\x00\x00\x00\x70\x02"s);
  // Red, green and blue of pixels 0 and 1.
  EXPECT_EQ(bytes.substr(20 + depth_size, 6), "\x00\x00\x00\x02\x00\x01"s);
}

TEST_F(KlgExport, CalibrationIsOneLine) {
  ASSERT_TRUE(export_recording(made_recording(640, 480, 1), ExportFormat::klg, folder_ / "room.klg"));
  EXPECT_EQ(testing::read_bytes(folder_ / "room.calibration.txt"), "525 524.5 3.5 2.25\n");
}

TEST_F(KlgExport, DoesNotReplaceACalibration) {
  write("room.calibration.txt", "precious");
  const auto done = export_recording(made_recording(640, 480, 1), ExportFormat::klg, folder_ / "room.klg");
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::usage);
  EXPECT_EQ(testing::files_below(folder_).size(), 1);
}

TEST_F(KlgExport, RefusesAnotherSize) {
  const auto done = export_recording(made_recording(320, 240, 1), ExportFormat::klg, folder_ / "room.klg");
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::usage);
  EXPECT_EQ(done.error().message, "'made': images of 320x240 pixels (allowed in .klg: 640x480)");
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(KlgExport, RefusesMoreFramesThan16BitsCount) {
  const auto done =
      export_recording(made_recording(640, 480, 65536), ExportFormat::klg, folder_ / "room.klg");
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::usage);
  expect_contains(done.error().message, "65536 frames (allowed in klg: 1 .. 65535");
}

TEST_F(KlgExport, NeedsTheNameOfAFile) {
  const auto done = export_recording(made_recording(640, 480, 1), ExportFormat::klg, folder_ / "");
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::usage);
}

}  // namespace
}  // namespace fusebench
