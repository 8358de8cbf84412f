#include "datasets/recording/exports/export_formats.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "datasets/images/image_files.hpp"
#include "datasets/recording/exports/export_recording.hpp"
#include "datasets/recording/image_logs/sens_log.hpp"
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

using SensExport = testing::InTemporaryFolder;

/// A file of three frames of 2x1 pixels, the second one without pose.
std::string with_poses(std::uint64_t period_us = 1000) {
  SensHeader header{"made", {2, 1, 500, 500, 0.5, 0}, {2, 1, 500, 500, 0.5, 0}};
  header.frames = 3;
  std::string bytes = sens_bytes(header);
  for (std::uint64_t k = 0; k < 3; ++k) {
    SensFrame frame;
    if (k != 1)
      frame.T_world_camera =
          SE3{Quaterniond(Eigen::AngleAxisd(0.5 * static_cast<double>(k), Vector3d::UnitY())),
              {0.25 * static_cast<double>(k), 1, -2}};
    frame.color_timestamp_us = frame.depth_timestamp_us = 5000 + k * period_us;
    frame.color = "a JPEG";
    frame.depth = Image<std::uint16_t>(2, 1, 1234);
    bytes += sens_bytes(frame);
  }
  return bytes + std::string(8, '\0');
}

TEST_F(SensExport, FramesComeBackWithDepthAsItIsAndColourNearly) {
  ASSERT_TRUE(export_recording(made_recording(48, 32, 3), ExportFormat::sens, folder_ / "room.sens"));
  auto reader = SensReader::open(folder_ / "room.sens");
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(reader->header().frames, 3);
  EXPECT_EQ(reader->header().color.fy_px, 524.5);
  EXPECT_EQ(reader->header().depth.cy_px, 2.25);
  for (int k = 0; k < 3; ++k) {
    const auto frame = reader->next();
    ASSERT_TRUE(frame) << frame.error().message;
    ASSERT_TRUE(*frame);
    const RgbdFrame made = made_frame(48, 32, k);
    EXPECT_EQ((*frame)->color_timestamp_us, static_cast<std::uint64_t>(made.timestamp_ns / 1000));
    EXPECT_EQ((*frame)->depth_timestamp_us, (*frame)->color_timestamp_us + 2000);
    EXPECT_FALSE((*frame)->T_world_camera);
    EXPECT_EQ((*frame)->depth.data, testing::stored_depth(made, 1000, 65535).data);
    const auto color = images::read_color(write("frame.jpg", (*frame)->color));
    ASSERT_TRUE(color) << color.error().message;
    ASSERT_EQ(color->data.size(), made.color.data.size());
    double difference = 0;
    for (std::size_t i = 0; i < color->data.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) difference += std::abs(color->data[i][c] - made.color.data[i][c]);
    }
    EXPECT_LT(difference / (3.0 * static_cast<double>(color->data.size())), 6);
  }
  const auto after = reader->next();
  ASSERT_TRUE(after);
  EXPECT_FALSE(*after);
}

TEST_F(SensExport, BytesAreThoseOfTheLayout) {
  ASSERT_TRUE(export_recording(made_recording(48, 32, 2), ExportFormat::sens, folder_ / "room.sens"));
  const std::string bytes = testing::read_bytes(folder_ / "room.sens");
  EXPECT_EQ(bytes.substr(0, 21),
            "\x04\x00\x00\x00\x09\x00\x00\x00\x00\x00\x00\x00"
            "fusebench"s);
  EXPECT_EQ(bytes.substr(21, 12), "\x00\x40\x03\x44\x00\x00\x00\x00\x00\x00\x60\x40"s);  // 525, 0, 3.5
  const std::string one = "\x00\x00\x80\x3F"s;
  EXPECT_EQ(bytes.substr(85, 4), one);                   // the pose of colour
  EXPECT_EQ(bytes.substr(85 + 60, 4), one);              // its last element
  EXPECT_EQ(bytes.substr(149, 4), "\x00\x40\x03\x44"s);  // K of depth
  // Codecs 2 (JPEG) and 1 (zlib); 48x32 twice; 1000.0; two frames.
  EXPECT_EQ(bytes.substr(277, 8), "\x02\x00\x00\x00\x01\x00\x00\x00"s);
  EXPECT_EQ(bytes.substr(285, 16), "\x30\x00\x00\x00\x20\x00\x00\x00\x30\x00\x00\x00\x20\x00\x00\x00"s);
  EXPECT_EQ(bytes.substr(301, 12), "\x00\x00\x7A\x44\x02\x00\x00\x00\x00\x00\x00\x00"s);
  for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(bytes.substr(313 + 4 * i, 4), "\x00\x00\x80\xFF"s);  // -inf
  // 10^9 us, and 2000 us more; a JPEG begins with FF D8.
  EXPECT_EQ(bytes.substr(377, 8), "\x00\xCA\x9A\x3B\x00\x00\x00\x00"s);
  EXPECT_EQ(bytes.substr(385, 8), "\xD0\xD1\x9A\x3B\x00\x00\x00\x00"s);
  EXPECT_EQ(bytes.substr(409, 2), "\xFF\xD8"s);
  EXPECT_EQ(bytes.substr(bytes.size() - 8), std::string(8, '\0'));  // no IMU frames
}

TEST_F(SensExport, PosesAreReadBackWithTheirStamps) {
  const auto trajectory = read_sens_trajectory(write("poses.sens", with_poses()));
  ASSERT_TRUE(trajectory) << trajectory.error().message;
  ASSERT_EQ(trajectory->size(), 2);
  EXPECT_EQ((*trajectory)[0].timestamp_ns, 5'000'000);
  EXPECT_EQ((*trajectory)[1].timestamp_ns, 7'000'000);
  const SE3& last = (*trajectory)[1].T_world_camera;
  EXPECT_NEAR((last.translation - Vector3d(0.5, 1, -2)).norm(), 0, 1e-6);
  EXPECT_NEAR(rotation_angle_rad(last.rotation, Quaterniond(Eigen::AngleAxisd(1.0, Vector3d::UnitY()))), 0,
              1e-6);
}

TEST_F(SensExport, PosesAreRowByRow) {
  // A quarter turn about z: the second number of the first row is -1.
  SensFrame frame;
  frame.T_world_camera = SE3{so3_exp({0, 0, radians(90)}), {8, 0, 0}};
  frame.depth = Image<std::uint16_t>(1, 1);
  const std::string bytes = sens_bytes(frame);
  EXPECT_EQ(bytes.substr(4, 4), "\x00\x00\x80\xBF"s);
  EXPECT_EQ(bytes.substr(12, 4), "\x00\x00\x00\x41"s);  // 8.0
}

TEST_F(SensExport, RefusesWhatIsNoTrajectory) {
  EXPECT_EQ(read_sens_trajectory(write("equal.sens", with_poses(0))).error().code, ErrorCode::data_corrupt);
  ASSERT_TRUE(export_recording(made_recording(8, 6, 2), ExportFormat::sens, folder_ / "room.sens"));
  const auto none = read_sens_trajectory(folder_ / "room.sens");
  ASSERT_FALSE(none);
  expect_contains(none.error().message, "none of its 2 frames has a pose");
}

TEST_F(SensExport, DamageIsAnError) {
  const std::string whole = with_poses();
  const auto refusal = [&](const std::string& bytes) {
    auto reader = SensReader::open(write("damaged.sens", bytes));
    if (!reader) return reader.error();
    const auto frame = reader->next();
    return frame ? Error{} : frame.error();
  };
  const auto changed = [&](std::size_t at, const std::string& bytes) {
    return std::string(whole).replace(at, bytes.size(), bytes);
  };
  constexpr std::size_t kAfterName = 16;  // the name is "made"
  const std::vector<std::pair<std::string, std::string>> cases = {
      {whole.substr(0, 3), "ends before the version"},
      {changed(0, "\x03"), "version 3"},
      {changed(4, std::string(8, '\xFF')), "ends before the sensor's name"},
      {changed(kAfterName + 256, "\x05"), "codec of colour = 5"},
      {changed(kAfterName + 264, std::string(4, '\0')), "size of colour = 0x1"},
      {changed(kAfterName + 260, "\x02"), "occipital"},
      {changed(kAfterName + 292, "\x00\x00\x00\x40"s), "no rigid transform"},
      {whole.substr(0, kAfterName + 400), "ends before depth"},
      {changed(kAfterName + 272, "\x03"), "not of 3x1 pixels"},
  };
  for (const auto& [bytes, message] : cases) {
    const Error error = refusal(bytes);
    EXPECT_EQ(error.code, ErrorCode::data_corrupt);
    expect_contains(error.message, message);
  }
  EXPECT_EQ(SensReader::open(folder_ / "missing.sens").error().code, ErrorCode::data_missing);
}

TEST_F(SensExport, RefusesMoreFramesThanBundleFusionTakes) {
  const auto done = export_recording(made_recording(8, 6, 12001), ExportFormat::sens, folder_ / "room.sens");
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::usage);
  expect_contains(done.error().message,
                  "12001 frames (allowed in sens: 1 .. 12000, which BundleFusion takes)");
  expect_contains(done.error().hint, "--frames");
}

}  // namespace
}  // namespace fusebench
