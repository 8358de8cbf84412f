#include <fmt/format.h>
#include <gtest/gtest.h>

#include "datasets/calibration/infinitam_calibration.hpp"
#include "datasets/recording/exports/export_recording.hpp"
#include "tests/datasets/recording/exports/made_recording.hpp"

namespace fusebench {

using namespace exports;
using namespace std::string_literals;
using testing::made_frame;
using testing::made_recording;

namespace {

class InfinitamExport : public testing::InTemporaryFolder {
 protected:
  const std::filesystem::path out_ = folder_ / "room";
};

TEST_F(InfinitamExport, FramesAreStoredByTheirNumbers) {
  ASSERT_TRUE(export_recording(made_recording(8, 6, 3), ExportFormat::infinitam, out_));
  for (int k = 0; k < 3; ++k) {
    const RgbdFrame made = made_frame(8, 6, k);
    std::string color = "P6\n8 6\n255\n", depth = "P5\n8 6\n65535\n";
    for (const Rgb& pixel : made.color.data) color.append(pixel.begin(), pixel.end());
    for (const std::uint16_t value : testing::stored_depth(made, 1000, 32000).data)
      depth += {char(value / 256), char(value % 256)};
    EXPECT_EQ(testing::read_bytes(out_ / fmt::format("color/000{}.ppm", k)), color);
    EXPECT_EQ(testing::read_bytes(out_ / fmt::format("depth/000{}.pgm", k)), depth);
  }
  EXPECT_FALSE(std::filesystem::exists(out_ / "color/0003.ppm"));
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

}  // namespace
}  // namespace fusebench
