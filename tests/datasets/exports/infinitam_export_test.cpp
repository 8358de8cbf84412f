#include "datasets/exports/infinitam_export.hpp"

#include <gtest/gtest.h>

#include "datasets/calibration/infinitam_calibration.hpp"
#include "datasets/exports/export_recording.hpp"
#include "datasets/exports/pnm_file.hpp"
#include "tests/datasets/exports/made_recording.hpp"
#include "tests/support/expect_text.hpp"

namespace fusebench {

using namespace exports;
using namespace std::string_literals;
using testing::expect_contains;
using testing::made_frame;
using testing::made_recording;

namespace {

class InfinitamExport : public testing::InTemporaryFolder {
 protected:
  const std::filesystem::path out_ = folder_ / "room";
  [[nodiscard]] std::string mask(std::string_view relative) const { return (out_ / relative).string(); }
};

TEST_F(InfinitamExport, FramesComeBackByTheirMasks) {
  ASSERT_TRUE(export_recording(made_recording(8, 6, 3), ExportFormat::infinitam, out_));
  for (int k = 0; k < 3; ++k) {
    const auto frame = read_infinitam_frame(mask(kInfinitamColorMask), mask(kInfinitamDepthMask),
                                            static_cast<std::size_t>(k));
    ASSERT_TRUE(frame) << frame.error().message;
    ASSERT_TRUE(*frame);
    const RgbdFrame made = made_frame(8, 6, k);
    EXPECT_EQ((*frame)->color.data, made.color.data);
    EXPECT_EQ((*frame)->depth_mm.data, testing::stored_depth(made, 1000, 32000).data);
  }
  const auto after = read_infinitam_frame(mask(kInfinitamColorMask), mask(kInfinitamDepthMask), 3);
  ASSERT_TRUE(after);
  EXPECT_FALSE(*after);
}

TEST_F(InfinitamExport, ImagesAreNetpbmWithBigEndianDepth) {
  ASSERT_TRUE(export_recording(made_recording(8, 6, 1), ExportFormat::infinitam, out_));
  const std::string color = testing::read_bytes(out_ / "color" / "0000.ppm");
  EXPECT_EQ(color.substr(0, 17), "P6\n8 6\n255\n\x00\x00\x00\x02\x00\x01"s);
  EXPECT_EQ(color.size(), 11 + 8 * 6 * 3);
  const std::string depth = testing::read_bytes(out_ / "depth" / "0000.pgm");
  // Pixels 0 to 4: none, 40 m (beyond 32 m), 70 m, too near, 624 mm.
  EXPECT_EQ(depth.substr(0, 23), "P5\n8 6\n65535\n\x00\x00\x00\x00\x00\x00\x00\x00\x02\x70"s);
  EXPECT_EQ(depth.size(), 13 + 8 * 6 * 2);
}

TEST_F(InfinitamExport, CalibrationIsReadByOurReader) {
  ASSERT_TRUE(export_recording(made_recording(8, 6, 1), ExportFormat::infinitam, out_));
  const auto rig = calibration::read_infinitam_calibration(out_ / "calib.txt");
  ASSERT_TRUE(rig) << rig.error().message;
  EXPECT_EQ(rig->color.pinhole.width_px, 8);
  EXPECT_EQ(rig->color.pinhole.fy_px, 524.5);
  ASSERT_TRUE(rig->depth);
  EXPECT_EQ(rig->depth->pinhole.cx_px, 3.5);
  EXPECT_TRUE(rig->depth->T_color_depth.translation.isZero(0));
  EXPECT_DOUBLE_EQ(*rig->depth_units_per_metre, 1000);
  EXPECT_FALSE(rig->imu);
}

TEST_F(InfinitamExport, NeverWritesInertialFiles) {
  recording::Recording recording = made_recording(8, 6, 2);
  testing::add_made_imu(recording);
  const auto done = export_recording(recording, ExportFormat::infinitam, out_);
  ASSERT_TRUE(done);
  EXPECT_TRUE(testing::any_contains(done->notes, "inertial samples are not written"));
  std::vector<std::string> names;
  for (const auto& [name, bytes] : testing::files_below(out_)) names.push_back(name);
  EXPECT_EQ(names, (std::vector<std::string>{"calib.txt", "color/0000.ppm", "color/0001.ppm",
                                             "depth/0000.pgm", "depth/0001.pgm", "frame_times.txt"}));
  EXPECT_EQ(testing::read_bytes(out_ / "frame_times.txt"),
            "# frame timestamp [s]\n0 1000.000000000\n1 1000.040000000\n");
}

TEST(MaskedName, IsThatOfPrintf) {
  EXPECT_EQ(masked_name("a/%04i.ppm", 7).value(), "a/0007.ppm");
  EXPECT_EQ(masked_name("a/%04i.ppm", 12345).value(), "a/12345.ppm");
  EXPECT_EQ(masked_name("%d", 7).value(), "7");
  for (const char* mask : {"a.ppm", "%", "%04i%04i", "%4x", "%-4i", "%99999i", "%4i"}) {
    const auto name = masked_name(mask, 7);
    ASSERT_FALSE(name) << mask;
    EXPECT_EQ(name.error().code, ErrorCode::usage);
  }
}

class PnmFile : public testing::InTemporaryFolder {};

TEST_F(PnmFile, HeadersMayHaveCommentsAndAnyWhiteSpace) {
  const auto image = read_pgm(write("a.pgm", "P5 # depth\n# of 2 pixels\n2\t1\r\n65535\n\x01\x02\x03\x04"));
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->width, 2);
  EXPECT_EQ(image->data, (std::vector<std::uint16_t>{0x0102, 0x0304}));
}

TEST_F(PnmFile, DamageIsAnError) {
  for (const std::string& bytes :
       {""s, "P6\n2 1\n65535\n1234"s, "P5\n2 1\n255\n12"s, "P5\n2 1\n65535\n123"s, "P5\n0 1\n65535\n"s,
        "P5\n99999 99999\n65535\n"s, "P5\n2"s, "P5\n2 1\n65535"s, "P5 # unfinished"s}) {
    const auto image = read_pgm(write("damaged.pgm", bytes));
    ASSERT_FALSE(image) << bytes;
    EXPECT_EQ(image.error().code, ErrorCode::data_corrupt);
    expect_contains(image.error().message, "damaged.pgm: ");
  }
  EXPECT_EQ(read_ppm(folder_ / "missing.ppm").error().code, ErrorCode::data_missing);
}

}  // namespace
}  // namespace fusebench
