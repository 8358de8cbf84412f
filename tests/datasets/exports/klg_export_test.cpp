#include "datasets/exports/export_formats.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include "datasets/exports/export_recording.hpp"
#include "datasets/image_logs/klg_log.hpp"
#include "tests/datasets/exports/made_recording.hpp"
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

TEST_F(KlgExport, FramesComeBackAsTheyAreAndTheLastOneTwice) {
  ASSERT_TRUE(export_recording(made_recording(640, 480, 3), ExportFormat::klg, folder_ / "room.klg"));
  auto reader = KlgReader::open(folder_ / "room.klg");
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(reader->frame_count(), 4);
  for (const int k : {0, 1, 2, 2}) {
    const auto frame = reader->next();
    ASSERT_TRUE(frame) << frame.error().message;
    ASSERT_TRUE(*frame);
    const RgbdFrame made = made_frame(640, 480, k);
    EXPECT_EQ((*frame)->timestamp_us, made.timestamp_ns / 1000);
    EXPECT_EQ((*frame)->color.data, made.color.data);
    EXPECT_EQ((*frame)->depth_mm.data, testing::stored_depth(made, 1000, 65535).data);
    EXPECT_EQ((*frame)->jpeg, "");
  }
  const auto after = reader->next();
  ASSERT_TRUE(after);
  EXPECT_FALSE(*after);
}

TEST_F(KlgExport, BytesAreThoseOfTheLayout) {
  ASSERT_TRUE(export_recording(made_recording(640, 480, 1), ExportFormat::klg, folder_ / "room.klg"));
  const std::string bytes = testing::read_bytes(folder_ / "room.klg");
  // Two frames, since the last one is doubled; 10^9 us; 640 * 480 * 3 bytes of colour.
  EXPECT_EQ(bytes.substr(0, 4), "\x02\x00\x00\x00"s);
  EXPECT_EQ(bytes.substr(4, 8), "\x00\xCA\x9A\x3B\x00\x00\x00\x00"s);
  EXPECT_EQ(bytes.substr(16, 4), "\x00\x10\x0E\x00"s);
  const auto byte = [&](std::size_t at) {
    return static_cast<std::size_t>(static_cast<unsigned char>(bytes[at]));
  };
  const std::size_t depth_size = byte(12) | byte(13) << 8 | byte(14) << 16 | byte(15) << 24;
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

TEST_F(KlgExport, PlainDepthAndJpegAreRead) {
  // One frame of 2x1 pixels: plain depth of 258 and 3 mm, and five bytes of a JPEG.
  const std::string bytes =
      "\x01\x00\x00\x00"s
      "\x07\x00\x00\x00\x00\x00\x00\x00"s
      "\x04\x00\x00\x00\x05\x00\x00\x00"s
      "\x02\x01\x03\x00JPEG!"s;
  auto reader = KlgReader::open(write("small.klg", bytes), 2, 1);
  ASSERT_TRUE(reader);
  const auto frame = reader->next();
  ASSERT_TRUE(frame) << frame.error().message;
  ASSERT_TRUE(*frame);
  EXPECT_EQ((*frame)->timestamp_us, 7);
  EXPECT_EQ((*frame)->depth_mm.data, (std::vector<std::uint16_t>{258, 3}));
  EXPECT_TRUE((*frame)->color.empty());
  EXPECT_EQ((*frame)->jpeg, "JPEG!");
}

TEST_F(KlgExport, DamageIsAnError) {
  const auto refusal = [&](const std::string& bytes) {
    auto reader = KlgReader::open(write("damaged.klg", bytes), 2, 1);
    if (!reader) return reader.error();
    const auto frame = reader->next();
    return frame ? Error{} : frame.error();
  };
  const std::string head = "\x01\x00\x00\x00"s + std::string(8, '\0');
  for (const std::string& bytes :
       {"\x01\x00"s, "\xFF\xFF\xFF\xFF"s, head, head + "\x04\x00\x00\x00\x00\x00\x00\x00\x01"s,
        head + "\xFF\xFF\xFF\xFF\x00\x00\x00\x00"s, head + "\xFF\xFF\xFF\x7F\x00\x00\x00\x00"s,
        head + "\x03\x00\x00\x00\x00\x00\x00\x00\x01\x02\x03"s}) {
    const Error error = refusal(bytes);
    EXPECT_EQ(error.code, ErrorCode::data_corrupt) << error.message;
    expect_contains(error.message, "damaged.klg: byte ");
  }
  EXPECT_EQ(KlgReader::open(folder_ / "missing.klg").error().code, ErrorCode::data_missing);
}

}  // namespace
}  // namespace fusebench
