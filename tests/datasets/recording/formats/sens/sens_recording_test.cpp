#include "datasets/recording/formats/sens/sens_recording.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

#include "datasets/images/image_files.hpp"
#include "datasets/open_recording.hpp"
#include "datasets/recording/exports/export_recording.hpp"
#include "datasets/recording/image_logs/sens_log.hpp"
#include "tests/datasets/recording/exports/made_recording.hpp"
#include "tests/support/expect_text.hpp"

namespace fusebench {

using namespace recording;
using namespace image_logs;
using namespace exports;
using namespace datasets;

namespace {

using testing::any_contains;
using testing::expect_contains;
using testing::made_frame;

struct Layout {
  std::uint64_t first_us = 5'000'000;
  std::uint64_t period_us = 33'000;
  std::vector<std::uint64_t> color_us;  ///< in place of the above
  std::vector<std::uint64_t> depth_us;
  bool with_poses = true;
  bool own_depth_camera = false;
  SensColorCodec codec = SensColorCodec::plain;
};

class SensRecording : public testing::InTemporaryFolder {
 protected:
  const std::filesystem::path file_ = folder_ / "scene0000_00.sens";

  /// Three frames of 8x6 pixels, or one for each given stamp.
  static std::string bytes_of(const Layout& layout) {
    SensHeader header{"made", {8, 6, 10, 11, 3.5, 2.5}, {8, 6, 10, 11, 3.5, 2.5}};
    header.color_codec = layout.codec;
    header.frames = layout.color_us.empty() ? 3 : layout.color_us.size();
    if (layout.own_depth_camera) {
      header.depth = {4, 3, 5, 5.5, 1.5, 1};
      header.T_rig_depth = SE3{Quaterniond::Identity(), {0.25, 0, 0}};
    }
    std::string bytes = sens_bytes(header);
    for (std::uint64_t k = 0; k < header.frames; ++k) {
      SensFrame frame;
      if (layout.with_poses && k != 1)
        frame.T_world_camera = SE3{Quaterniond::Identity(), {static_cast<double>(k), 1, -2}};
      frame.color_timestamp_us = frame.depth_timestamp_us = layout.first_us + k * layout.period_us;
      if (!layout.color_us.empty()) frame.color_timestamp_us = frame.depth_timestamp_us = layout.color_us[k];
      if (!layout.depth_us.empty()) frame.depth_timestamp_us = layout.depth_us[k];
      for (int i = 0; i < 8 * 6; ++i)
        frame.color += {static_cast<char>(i), static_cast<char>(10 * k), static_cast<char>(200)};
      frame.depth = Image<std::uint16_t>(header.depth.width_px, header.depth.height_px, 1500);
      frame.depth(1, 1) = 65535;
      bytes += sens_bytes(frame);
    }
    return bytes;
  }
  static std::string imu_bytes(double gravity, int count = 20, int repeated = -1) {
    std::string bytes;
    append_number<std::uint64_t>(bytes, static_cast<std::uint64_t>(count));
    for (int i = 0; i < count; ++i) {
      for (const double value :
           {0.5, 0.0, -0.25, 0.0, 0.125, 0.0, 1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 0.0, 0.0, -gravity})
        append_number(bytes, value);
      append_number<std::uint64_t>(
          bytes, static_cast<std::uint64_t>(4'990'000 + (i == repeated ? i - 1 : i) * 10'000));
    }
    return bytes;
  }
  Result<Recording> open(const std::string& bytes) const {
    write("scene0000_00.sens", bytes);
    return open_recording(file_);
  }
};

TEST_F(SensRecording, WhatIsExportedIsReadBack) {
  const Recording made = testing::made_recording(48, 32, 3);
  ASSERT_TRUE(export_recording(made, ExportFormat::sens, folder_ / "room.sens"));
  EXPECT_EQ(recognise_format(folder_), "sens") << "the folder of the one file";
  const auto read = open_recording(folder_ / "room.sens");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->name, "room");
  EXPECT_EQ(read->rig.camera.fy_px, 524.5);
  EXPECT_TRUE(read->ground_truth.empty());
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(read->frames[k].timestamp_ns, made.frames[k].timestamp_ns);
    EXPECT_EQ(read->frames[k].depth_timestamp_ns, made.frames[k].depth_timestamp_ns);
    const auto frame = read->load_frame(k);
    ASSERT_TRUE(frame) << frame.error().message;
    const RgbdFrame original = made_frame(48, 32, static_cast<int>(k));
    for (std::size_t i = 100; i < original.depth_m.data.size(); ++i)
      ASSERT_EQ(frame->depth_m.data[i], original.depth_m.data[i]) << i;
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_LT(std::abs(frame->color(20, 20)[c] - original.color(20, 20)[c]), 16) << "JPEG";
  }
}

TEST_F(SensRecording, PosesAreLabelledAsAnEstimate) {
  const auto read = open(bytes_of({}));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_TRUE(read->truth_label.starts_with("pseudo ground truth: BundleFusion"));
  ASSERT_EQ(read->ground_truth.size(), 2) << "the second frame has none";
  EXPECT_EQ(read->ground_truth[1].timestamp_ns, 5'066'000'000);
  const auto frame = read->load_frame(2);
  ASSERT_TRUE(frame) << frame.error().message;
  EXPECT_EQ(frame->color(3, 1), (Rgb{11, 20, 200}));
  EXPECT_EQ(frame->depth_m(1, 1), 0) << "65535 is no measurement";
  EXPECT_EQ(frame->depth_m(2, 1), 1.5F);
}

TEST_F(SensRecording, StampsThatDoNotRiseAreReplacedByNumbers) {
  Layout layout;
  layout.period_us = 0;
  const auto read = open(bytes_of(layout));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->frames[2].timestamp_ns, 66'666'667);
  EXPECT_TRUE(any_contains(read->notes, "since only 1 of 3 rise; frame k is taken to be at k / 30 s"));
  layout.period_us = 33;  // milliseconds
  EXPECT_EQ(open(bytes_of(layout))->frames[1].timestamp_ns, 5'000'033'000'000);
}

TEST_F(SensRecording, FramesWithOddStampsAreLeftOutAndNamed) {
  Layout layout;
  const std::vector<std::uint64_t> good = {5'000'000, 5'033'000, 5'066'000, 5'099'000, 5'132'000, 5'165'000};
  for (const auto& [frame, stamp] : {std::pair<std::size_t, std::uint64_t>{0, 0},
                                     {0, 9'000'000'000},
                                     {2, 0},
                                     {3, 5'066'000},
                                     {3, 9'000'000'000},
                                     {5, 7},
                                     {5, 9'000'000'000}}) {
    SCOPED_TRACE(fmt::format("frame {} with {}", frame, stamp));
    layout.color_us = good;
    layout.color_us[frame] = stamp;
    const auto read = open(bytes_of(layout));
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ(read->frames.size(), 5);
    for (std::size_t k = 0; k < 5; ++k) {
      const std::size_t in_file = k < frame ? k : k + 1;
      EXPECT_EQ(read->frames[k].timestamp_ns, static_cast<std::int64_t>(1000 * good[in_file]));
      EXPECT_EQ(read->load_frame(k)->color(3, 1)[1], 10 * in_file);
    }
    EXPECT_TRUE(
        any_contains(read->warnings, fmt::format("1 of 6 frames are not used, since their stamps do not "
                                                 "rise with the others' (the first is frame {} with {})",
                                                 frame, stamp)));
    EXPECT_FALSE(any_contains(read->notes, "has no stamps"));
  }
}

TEST_F(SensRecording, ReasonForNumbersIsTrue) {
  Layout layout;
  layout.color_us = {0, 0, 0};
  EXPECT_TRUE(any_contains(open(bytes_of(layout))->notes, "time: the .sens file has no stamps; frame k"));
  layout.color_us = {5'000'000, 4'000'000, 3'000'000, 3'033'000};
  EXPECT_TRUE(any_contains(open(bytes_of(layout))->notes, "are not used, since only 2 of 4 rise; frame k"));
  layout.color_us = {1, 2, 3, 4};
  EXPECT_TRUE(any_contains(open(bytes_of(layout))->notes, "a spacing of 1 is not that of images"));
}

TEST_F(SensRecording, DepthStampsFarFromColourAreNotUsed) {
  Layout layout;
  layout.color_us = {5'000'000, 5'033'000, 5'066'000};
  layout.depth_us = {5'001'000, 0, 9'000'000};
  const auto read = open(bytes_of(layout));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->frames[0].depth_timestamp_ns, 5'001'000'000);
  EXPECT_EQ(read->frames[1].depth_timestamp_ns, 5'033'000'000);
  EXPECT_EQ(read->frames[2].depth_timestamp_ns, 5'066'000'000);
  EXPECT_TRUE(any_contains(read->warnings, "1 depth stamps are more than 1 s from colour's"));
}

TEST_F(SensRecording, DepthOfAnotherCameraIsRegistered) {
  Layout layout;
  layout.own_depth_camera = true;
  const auto read = open(bytes_of(layout));
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_TRUE(read->calibration->depth);
  EXPECT_EQ(read->calibration->depth->T_color_depth.translation, Vector3d(0.25, 0, 0));
  EXPECT_EQ(read->ground_truth[0].T_world_camera.translation, Vector3d(-0.25, 1, -2)) << "poses are of depth";
  EXPECT_EQ(read->load_frame(0)->depth_m.width, 8);
}

TEST_F(SensRecording, InertialFramesAreCoreMotions) {
  write("calibration.toml",
        "[color]\nfx_px = 10\nfy_px = 11\ncx_px = 3.5\ncy_px = 2.5\n[imu]\nT_imu_color = [1, 0, 0, 0, 0, 1, "
        "0, 0, 0, "
        "0, 1, 0]\ngyroscope_noise_radps_sqrthz = 1e-3\naccelerometer_noise_mps2_sqrthz = 1e-2\n"
        "gyroscope_bias_walk_radps2_sqrthz = 1e-5\naccelerometer_bias_walk_mps3_sqrthz = 1e-4\n");
  const auto read = open(bytes_of({}) + imu_bytes(1));
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->imu.size(), 20);
  EXPECT_EQ(read->imu[1].timestamp_ns, 5'000'000'000);
  EXPECT_EQ(read->imu[0].angular_velocity_radps, Vector3d(0.5, 0, -0.25));
  EXPECT_LT((read->imu[0].specific_force_mps2 - Vector3d(0, -0.125 * 9.80665, 9.80665)).norm(), 1e-9);
  const auto repeated = open(bytes_of({}) + imu_bytes(1, 20, 7));
  ASSERT_TRUE(repeated);
  EXPECT_EQ(repeated->imu.size(), 19);
  EXPECT_TRUE(
      any_contains(repeated->warnings, "1 of 20 inertial frames are not used: their stamps do not rise"));
  const auto unknown = open(bytes_of({}) + imu_bytes(9.8));
  ASSERT_TRUE(unknown);
  EXPECT_TRUE(unknown->imu.empty());
  EXPECT_TRUE(any_contains(unknown->warnings, "20 inertial frames are not used: their gravity"));
}

TEST_F(SensRecording, DamageIsNamed) {
  const std::string whole = bytes_of({});
  const auto cut = open(whole.substr(0, whole.size() - 10));
  ASSERT_FALSE(cut);
  expect_contains(cut.error().message, "scene0000_00.sens: byte ");
  const auto imu = open(whole + imu_bytes(1).substr(0, 100));
  ASSERT_FALSE(imu);
  expect_contains(imu.error().message, "20 inertial frames in 92 bytes");
  Layout jpeg;
  jpeg.codec = SensColorCodec::jpeg;
  const auto no_jpeg = open(bytes_of(jpeg));
  ASSERT_FALSE(no_jpeg);
  expect_contains(no_jpeg.error().message, "scene0000_00.sens: colour of frame 0: unreadable image");
  write("calibration.toml",
        "[color]\nwidth_px = 9\nheight_px = 6\nfx_px = 1\nfy_px = 1\ncx_px = 1\ncy_px = 1\n");
  const auto size = open(whole);
  ASSERT_FALSE(size);
  expect_contains(size.error().message, "image of 8x6 pixels, but the camera's calibration is for 9x6");
}

TEST_F(SensRecording, ImagesThatChangedAreRefused) {
  const auto read = open(bytes_of({}));
  ASSERT_TRUE(read);
  std::string changed = bytes_of({});
  changed[changed.size() - 20] = static_cast<char>(changed[changed.size() - 20] + 1);
  write("scene0000_00.sens", changed);
  EXPECT_TRUE(read->load_frame(0));
  const auto frame = read->load_frame(2);
  ASSERT_FALSE(frame);
  expect_contains(frame.error().message, "of frame 2: has changed since the recording was opened");
}

}  // namespace
}  // namespace fusebench
