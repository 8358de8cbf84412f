#include "datasets/recording/formats/tum/tum_rgbd.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <string>

#include "core/base/geometry.hpp"
#include "datasets/calibration/camera_presets.hpp"
#include "datasets/open_recording.hpp"
#include "tests/datasets/recording/formats/tum/tum_folder.hpp"
#include "tests/support/expect_text.hpp"

namespace fusebench {

using namespace images;
using namespace calibration;
using namespace recording;
using namespace formats::tum;
using namespace datasets;

namespace {

using testing::expect_contains;
using testing::golden_tum_folder;
using testing::TumFolder;

ReadOptions small_camera() {
  ReadOptions options;
  options.camera = CalibratedCamera{{0, 0, 10, 11, 3.5, 2.5}, {}, {}};
  return options;
}

/// Message and hint of the expected error.
std::string refusal(const TumFolder& folder, ErrorCode code, const ReadOptions& options = small_camera()) {
  const auto recording = open_tum_rgbd(folder.path(), options);
  if (!recording) {
    EXPECT_EQ(recording.error().code, code) << recording.error().message;
    return recording.error().message + " | " + recording.error().hint;
  }
  return "was not refused";
}

TEST(TumRgbd, OpensAFolder) {
  const TumFolder folder;
  const auto recording = open_recording(folder.path(), {"", small_camera()});
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->format, "tum");
  EXPECT_EQ(recording->name, folder.path().filename().string());
  ASSERT_EQ(recording->frames.size(), 3U);
  EXPECT_EQ(recording->frames[1].timestamp_ns, 10'100'000'000);
  EXPECT_EQ(recording->frames[1].depth_timestamp_ns, 10'110'000'000);
  EXPECT_EQ(recording->frames[2].depth_file.filename(), "2.png");
  EXPECT_EQ(recording->ground_truth.size(), 9U);
  EXPECT_EQ(recording->imu_source, ImuSource::none);
  EXPECT_TRUE(recording->imu.empty() && recording->accelerometer.empty() && recording->warnings.empty());
  EXPECT_EQ(recording->rig.camera.width_px, 8);
  EXPECT_EQ(recording->rig.camera.fy_px, 11);
  EXPECT_EQ(recording->fingerprint.size(), 32U);
  const auto frame = recording->load_frame(2);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->timestamp_ns, 10'200'000'000);
  EXPECT_EQ(frame->depth_m(3, 3), 1.0004F);
  EXPECT_EQ(frame->color(3, 3), (Rgb{10, 20, 30}));
  EXPECT_EQ(frame->grey(3, 3), 18);  // 0.299 * 10 + 0.587 * 20 + 0.114 * 30
}

TEST(TumRgbd, FolderNameWithTrailingSlash) {
  const auto recording = open_recording(golden_tum_folder() / "");
  ASSERT_TRUE(recording);
  EXPECT_EQ(recording->name, "tum_freiburg1_rpy_5frames");
}

TEST(TumRgbd, DepthFactor) {
  const TumFolder folder;
  ReadOptions options = small_camera();
  EXPECT_EQ(open_tum_rgbd(folder.path(), options)->calibration->depth_units_per_metre, 5000)
      << "the format's";
  options.depth_units_per_metre = 1000;
  EXPECT_EQ(open_tum_rgbd(folder.path(), options)->load_frame(0)->depth_m(0, 0), 5.0F);
  options.depth_units_per_metre = 0;
  expect_contains(refusal(folder, ErrorCode::configuration, options),
                  "depth_units_per_metre (--depth-units) = 0 ");
  options.depth_units_per_metre = 0.0002;
  expect_contains(refusal(folder, ErrorCode::configuration, options),
                  "0.0002 metres per unit are 5000 units per metre");
  options.depth_units_per_metre = 5000;
  options.max_difference_s = -1;
  expect_contains(refusal(folder, ErrorCode::configuration, options), "max_difference_s = -1");
}

TEST(TumRgbd, UnknownCameraListsTheChoices) {
  const std::string message = refusal(TumFolder(), ErrorCode::configuration, {});
  for (const char* part : {"--camera", "freiburg1", "freiburg2", "freiburg3", "default"})
    expect_contains(message, part);
}

/// Twelve frames at 30 Hz whose colour and depth stamps jitter by 3 ms, in another rhythm each; depth arrives
/// 10 ms after colour. The camera's depth is taken 18 ms before its stamps.
class JitteringStamps {
 public:
  static constexpr std::int64_t kPeriod_ns = 33'000'000;
  static constexpr std::int64_t kDepthLater_ns = 10'000'000;
  static constexpr std::int64_t kDepthDelay_ns = -18'000'000;
  static constexpr std::size_t kFrames = 12;

  JitteringStamps() {
    std::string color;
    std::string depth;
    for (std::size_t i = 0; i < kFrames; ++i) {
      const std::int64_t exposed_us = 10'000'000 + static_cast<std::int64_t>(i) * kPeriod_ns / 1000;
      color += row(exposed_us + (i % 2 == 0 ? 3000 : -3000), "rgb/0.png");
      depth += row(exposed_us + kDepthLater_ns / 1000 + (i % 4 < 2 ? 3000 : -3000), "depth/0.png");
    }
    folder_.write("rgb.txt", color);
    folder_.write("depth.txt", depth);
  }

  [[nodiscard]] Result<Recording> open(bool regular) const {
    ReadOptions options = small_camera();
    options.camera->timing = parse_camera("freiburg1").value().timing;
    options.regular_stamps = regular;
    return open_tum_rgbd(folder_.path(), options);
  }

 private:
  static std::string row(std::int64_t stamp_us, const std::string& image) {
    return fmt::format("{}.{:06} {}\n", stamp_us / 1'000'000, stamp_us % 1'000'000, image);
  }
  TumFolder folder_;
};

TEST(TumRgbd, CaptureTimesAreRegularAndDepthIsDelayed) {
  const JitteringStamps folder;
  const auto recording = folder.open(true);
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_EQ(recording->frames.size(), JitteringStamps::kFrames);
  for (std::size_t i = 0; i < recording->frames.size(); ++i) {
    const FrameEntry& entry = recording->frames[i];
    const std::int64_t exposed_ns =
        10'000'000'000 + static_cast<std::int64_t>(i) * JitteringStamps::kPeriod_ns;
    EXPECT_EQ(std::abs(entry.timestamp_ns - exposed_ns), 3'000'000) << "stamps stay what they were";
    // One line through all twelve stamps: alternating jitter cancels but for 3 / 12 at an end of it, jitter
    // in pairs but for twice that.
    EXPECT_NEAR(static_cast<double>(entry.capture_ns - exposed_ns), 0, 1e6);
    EXPECT_NEAR(static_cast<double>(entry.depth_capture_ns - exposed_ns),
                JitteringStamps::kDepthLater_ns + JitteringStamps::kDepthDelay_ns, 2e6);
    const auto frame = recording->load_frame(i);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->timestamp_ns, entry.timestamp_ns);
    EXPECT_EQ(frame->capture_offset_ns, entry.capture_ns - entry.timestamp_ns);
    EXPECT_EQ(frame->depth_offset_ns, entry.depth_capture_ns - entry.capture_ns);
    if (i == 0) continue;
    const FrameEntry& before = recording->frames[i - 1];
    EXPECT_NEAR(static_cast<double>(entry.capture_ns - before.capture_ns), JitteringStamps::kPeriod_ns, 2e5);
  }
  ASSERT_EQ(recording->notes.size(), 3U);
  expect_contains(recording->notes[0], "as given by the user");
  expect_contains(recording->notes[1], "rgb.txt: stamps jitter by ");
  expect_contains(recording->notes[2], "depth.txt: stamps jitter by ");
}

TEST(TumRgbd, RegularStampsCanBeSwitchedOff) {
  const JitteringStamps folder;
  const auto recording = folder.open(false);
  ASSERT_TRUE(recording) << recording.error().message;
  for (std::size_t i = 0; i < recording->frames.size(); ++i) {
    const FrameEntry& entry = recording->frames[i];
    EXPECT_EQ(entry.capture_ns, entry.timestamp_ns);
    EXPECT_EQ(entry.depth_capture_ns, entry.depth_timestamp_ns + JitteringStamps::kDepthDelay_ns);
    EXPECT_EQ(recording->load_frame(i)->capture_offset_ns, 0);
  }
  for (const std::string& note : recording->notes) EXPECT_EQ(note.find("jitter"), std::string::npos) << note;
  EXPECT_NE(recording->fingerprint, folder.open(true)->fingerprint);
}

/// The calibration of TumFolder's camera with an IMU whose clock is ahead of the images'.
std::string calibration_with_imu(double time_offset_s) {
  return fmt::format(
      "[color]\nfx_px = 10\nfy_px = 11\ncx_px = 3.5\ncy_px = 2.5\n[imu]\n"
      "T_imu_color = [1, 0, 0, 0.1, 0, 1, 0, 0, 0, 0, 1, 0]\ngyroscope_noise_radps_sqrthz = 1e-3\n"
      "accelerometer_noise_mps2_sqrthz = 1e-2\ngyroscope_bias_walk_radps2_sqrthz = 1e-5\n"
      "accelerometer_bias_walk_mps3_sqrthz = 1e-4\ntime_offset_s = {}\n",
      time_offset_s);
}

TEST(TumRgbd, AnImuBesideIsPutOnTheImagesClock) {
  const TumFolder folder;
  folder.write("calibration.toml", calibration_with_imu(0.02));
  folder.write("imu.csv", "#t,w,a\n9900000000,0.1,0.2,0.3,0,9.8,0\n10400000000,0.1,0.2,0.3,0,9.8,0\n");
  const auto recording = open_tum_rgbd(folder.path(), {});
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->imu_source, ImuSource::recorded);
  ASSERT_EQ(recording->imu.size(), 2U);
  EXPECT_EQ(recording->imu[0].timestamp_ns, 9'880'000'000);
  EXPECT_EQ(recording->rig.T_imu_camera.translation.x(), 0.1);
  EXPECT_TRUE(recording->warnings.empty());
}

TEST(TumRgbd, ImuAndImagesOverlapOnTheImagesClock) {
  const TumFolder folder;
  folder.write("imu.csv", "17900000000,0,0,0,0,9.8,0\n18400000000,0,0,0,0,9.8,0\n");
  folder.write("calibration.toml", calibration_with_imu(8));
  EXPECT_TRUE(open_tum_rgbd(folder.path(), {}));
  folder.write("calibration.toml", calibration_with_imu(0));
  expect_contains(refusal(folder, ErrorCode::data_corrupt, {}), "do not overlap the images");
}

TEST(TumRgbd, AnImuWithoutCalibrationSaysWhatToAdd) {
  const TumFolder folder;
  folder.write("imu.csv", "9900000000,0,0,0,0,9.8,0\n10400000000,0,0,0,0,9.8,0\n");
  const auto recording = open_tum_rgbd(folder.path(), small_camera());
  ASSERT_TRUE(recording);
  EXPECT_EQ(recording->imu_source, ImuSource::none);
  ASSERT_EQ(recording->warnings.size(), 1U);
  expect_contains(recording->warnings[0], "T_imu_color");
}

TEST(TumRgbd, ABrokenCalibrationIsBadData) {
  const TumFolder folder;
  folder.write("calibration.toml", "[color]\nfx_px = 10\n");
  expect_contains(refusal(folder, ErrorCode::data_corrupt, {}), "needs the key fy_px");
  // Given by the user, the camera replaces one that is not known, not a file that cannot be read.
  expect_contains(refusal(folder, ErrorCode::data_corrupt, small_camera()), "needs the key fy_px");
}

TEST(TumRgbd, UnmatchedImagesAreCounted) {
  const TumFolder folder;
  folder.write("depth.txt", "10.01 depth/0.png\n10.13 depth/1.png\n10.19 depth/2.png\n");
  const auto recording = open_tum_rgbd(folder.path(), small_camera());
  ASSERT_TRUE(recording);
  EXPECT_EQ(recording->frames.size(), 2U);
  ASSERT_EQ(recording->warnings.size(), 1U);
  expect_contains(recording->warnings[0], "1 of 3 colour and 1 of 3 depth images");
}

TEST(TumRgbd, DepthOfAnotherSizeThanColourIsRefusedOnce) {
  const TumFolder folder;
  folder.write_depth(0, Image<std::uint16_t>(4, 3, 5000));
  const std::string message = refusal(folder, ErrorCode::data_corrupt);
  expect_contains(message,
                  "depth of 4x3 pixels, but colour, to which depth without a camera of its own is "
                  "registered, has 8x6");
}

TEST(TumRgbd, MissingLists) {
  const TumFolder folder;
  std::filesystem::remove(folder.path() / "depth.txt");
  expect_contains(refusal(folder, ErrorCode::data_missing), "depth.txt: no such file");
  const auto unrecognised = open_recording(folder.path());
  ASSERT_FALSE(unrecognised);
  EXPECT_EQ(unrecognised.error().code, ErrorCode::data_missing);
  expect_contains(unrecognised.error().message, "tum (files rgb.txt, depth.txt or associations.txt)");
}

/// The folder without its two lists, and with one of pairs.
class ListOfPairs {
 public:
  ListOfPairs(const std::string& name, std::string_view content) {
    std::filesystem::remove(folder_.path() / "rgb.txt");
    std::filesystem::remove(folder_.path() / "depth.txt");
    folder_.write(name, content);
  }
  [[nodiscard]] Result<Recording> open(const std::string& format = {}) const {
    return open_recording(folder_.path(), {format, small_camera()});
  }
  TumFolder folder_;
};

TEST(TumRgbd, AListOfPairsAloneIsEnough) {
  for (const char* name :
       {"associations.txt", "associate.txt", "assoc.txt", "rgbd_assoc.txt", "fr1_desk.txt"}) {
    for (const char* content :
         {"# colour first\n10.0 rgb/0.png 10.01 depth/0.png\n10.1 rgb/1.png 10.11 depth/1.png\n",
          "10.01 depth/0.png 10.0 rgb/0.png\n10.11 depth/1.png 10.1 rgb/1.png\n"}) {
      SCOPED_TRACE(std::string(name) + ": " + content);
      const ListOfPairs list(name, content);
      EXPECT_EQ(recognise_format(list.folder_.path()), "tum");
      const auto recording = list.open();
      ASSERT_TRUE(recording) << recording.error().message;
      EXPECT_TRUE(list.open("tum"));
      ASSERT_EQ(recording->frames.size(), 2U);
      EXPECT_EQ(recording->frames[1].timestamp_ns, 10'100'000'000);
      EXPECT_EQ(recording->frames[1].depth_timestamp_ns, 10'110'000'000);
      EXPECT_EQ(recording->load_frame(1)->depth_m(0, 0), 5001 / 5000.0F);
      EXPECT_EQ(recording->load_frame(1)->color(0, 0), (Rgb{10, 20, 30}));
      EXPECT_FALSE(recording->ground_truth.empty());
    }
  }
}

TEST(TumRgbd, ImagesOfAPairAreToldApartByTheirNames) {
  const ListOfPairs list("associations.txt", "10.0 0_Depth.png 10.0 0_color.png\n");
  std::filesystem::copy(list.folder_.path() / "depth/0.png", list.folder_.path() / "0_Depth.png");
  std::filesystem::copy(list.folder_.path() / "rgb/0.png", list.folder_.path() / "0_color.png");
  const auto recording = list.open();
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->load_frame(0)->depth_m(0, 0), 1);
}

TEST(TumRgbd, MoreColumnsOfListsAreLeftOutWithOneWarning) {
  constexpr std::string_view kPosed =
      "10.0 rgb/0.png 10.01 depth/0.png 10.0 1 2 3 0 0 0 1\n10.1 rgb/1.png 10.11 depth/1.png 10.1 1 2 3 0 0 "
      "0 1\n";
  const ListOfPairs posed("associate_with_groundtruth.txt", kPosed);
  const auto pairs = posed.open();
  ASSERT_TRUE(pairs) << pairs.error().message;
  EXPECT_EQ(pairs->frames.size(), 2U);
  ASSERT_EQ(pairs->warnings.size(), 1U);
  expect_contains(pairs->warnings[0],
                  "associate_with_groundtruth.txt:1: 8 columns after the first 4 are not used");
  posed.folder_.write("associations.txt", "10.0 rgb/0.png 10.01 depth/0.png\n");
  const auto plain = posed.open();
  ASSERT_TRUE(plain) << "the plain list goes before the one that was made from it";
  EXPECT_EQ(plain->frames.size(), 1U);
  EXPECT_TRUE(plain->warnings.empty());
  expect_contains(ListOfPairs("associations.txt",
                              "10.0 rgb/0.png 10.01 depth/0.png 7\n10.1 rgb/1.png 10.11 "
                              "depth/1.png\n")
                      .open()
                      .error()
                      .message,
                  "associations.txt:2: expected 5 columns as in line 1");

  const TumFolder folder;
  folder.write("rgb.txt",
               "# timestamp filename exposure\n10.0 rgb/0.png 1\n10.1 rgb/1.png 1\n10.2 rgb/2.png 1\n");
  folder.write("accelerometer.txt", "10.0 0.1 -9.8 0.2 21.5\n10.1 0 -9.8 0 21.5\n");
  const auto lists = open_tum_rgbd(folder.path(), small_camera());
  ASSERT_TRUE(lists) << lists.error().message;
  EXPECT_EQ(lists->frames.size(), 3U);
  ASSERT_EQ(lists->warnings.size(), 2U);
  expect_contains(lists->warnings[0], "rgb.txt:2: 1 columns after the first 2 are not used");
  expect_contains(lists->warnings[1], "accelerometer.txt:1: 1 columns after the first 4 are not used");
}

TEST(TumRgbd, WhatIsWrongInAListOfPairsIsNamed) {
  expect_contains(ListOfPairs("associations.txt", "10.0 rgb/0.png\n").open("tum").error().message,
                  "associations.txt:1: expected 4 columns or more");
  expect_contains(
      ListOfPairs("associations.txt", "10.1 rgb/1.png 10.1 depth/1.png\n10.0 rgb/0.png 10.0 depth/0.png\n")
          .open()
          .error()
          .message,
      "associations.txt:2: time 10.0 does not come after 10.100000000");
  const ListOfPairs two("associations.txt", "10.0 rgb/0.png 10.01 depth/0.png\n");
  two.folder_.write("assoc.txt", "10.0 rgb/0.png 10.01 depth/0.png\n");
  expect_contains(two.open().error().message, "several lists of pairs (assoc.txt, associations.txt)");
  EXPECT_EQ(ListOfPairs("notes.txt", "10.0 rgb/0.png 10.01 depth/0.png\n").open().error().code,
            ErrorCode::data_missing);
}

TEST(TumRgbd, MissingFolderAndUnknownFormat) {
  EXPECT_EQ(open_recording("/nonexistent").error().code, ErrorCode::data_missing);
  const auto unknown = open_recording(golden_tum_folder(), {"tmu", {}});
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code, ErrorCode::configuration);
  expect_contains(unknown.error().message, "format = tmu (allowed eth3d, icl, bonn, tum, ");
}

TEST(TumRgbd, TruthAndAccelerometerAreOptional) {
  const TumFolder folder;
  std::filesystem::remove(folder.path() / "groundtruth.txt");
  folder.write("accelerometer.txt", "10.0 0.1 -9.8 0.2\n10.1 0 -9.8 0\n");
  const auto recording = open_tum_rgbd(folder.path(), small_camera());
  ASSERT_TRUE(recording);
  EXPECT_TRUE(recording->ground_truth.empty());
  ASSERT_EQ(recording->accelerometer.size(), 2U);
  EXPECT_EQ(recording->accelerometer[0].specific_force_mps2, Vector3d(0.1, -9.8, 0.2));
}

TEST(TumRgbd, RefusesBadRowsWithFileAndLine) {
  const auto after_writing = [](const std::string& name, std::string_view content) {
    const TumFolder folder;
    folder.write(name, content);
    return refusal(folder, ErrorCode::data_corrupt);
  };
  expect_contains(after_writing("rgb.txt", "# x\n10.0\n"),
                  "rgb.txt:2: expected 2 columns or more: timestamp filename, got 1");
  expect_contains(after_writing("rgb.txt", "# nothing\n"), "rgb.txt: has no rows");
  expect_contains(after_writing("rgb.txt", "10.1 rgb/0.png\n10.0 rgb/1.png\n"),
                  "rgb.txt:2: time runs backwards by 0.1 s (timestamp 10.0 after line 1)");
  expect_contains(after_writing("depth.txt", "10.0 depth/0.png\n# x\n10.00 depth/1.png\n"),
                  "depth.txt:3: timestamp 10.00 is the same as that of line 1");
  expect_contains(after_writing("depth.txt", "20.0 depth/0.png\n"), "no colour image");
  expect_contains(after_writing("groundtruth.txt", "10 0 0 0 0 0 1\n"),
                  "groundtruth.txt:1: expected 8 columns or more: timestamp tx ty tz qx qy qz qw, got 7");
  expect_contains(after_writing("groundtruth.txt", "10 0 0 inf 0 0 0 1\n"), "groundtruth.txt:1: tz: ");
  expect_contains(after_writing("groundtruth.txt", "10 0 0 0 0 0 0 1e-9\n"), "groundtruth.txt:1: quaternion");
  expect_contains(after_writing("groundtruth.txt", "10 0 0 0 0 0 0 0\n"),
                  "groundtruth.txt:1: all 1 rows are of lost frames");
  expect_contains(after_writing("groundtruth.txt", "10 0 0 0 0 0 0 1\n9 0 0 0 0 0 0 1\n"),
                  "groundtruth.txt:2: time runs backwards by 1 s");
  expect_contains(after_writing("accelerometer.txt", "10 1 2\n"), "accelerometer.txt:1: expected 4 columns");
}

TEST(TumRgbd, RefusesTruthOfAnotherTime) {
  const TumFolder folder;
  folder.write("groundtruth.txt", "20.5 0 0 0 0 0 0 1\n21.5 0 0 0 0 0 0 1\n");
  const std::string message = refusal(folder, ErrorCode::data_corrupt);
  expect_contains(message, "times 20.500000000 to 21.500000000");
  expect_contains(message, "times 10.000000000 to 10.200000000");
}

TEST(TumRgbd, PartlyCoveringTruthIsAWarning) {
  const TumFolder folder;
  folder.write("groundtruth.txt", "10.05 0 0 0 0 0 0 1\n10.12 0 0 0 0 0 0 1\n10.25 0 0 0 0 0 0 2\n");
  const auto recording = open_tum_rgbd(folder.path(), small_camera());
  ASSERT_TRUE(recording);
  ASSERT_EQ(recording->warnings.size(), 2U);
  expect_contains(recording->warnings[0], "groundtruth.txt:3: 1 of 3 quaternions");
  expect_contains(recording->warnings[1], "2 of 3 frames have no ground truth");
  EXPECT_NEAR(recording->ground_truth[2].T_world_camera.rotation.norm(), 1, 1e-15);
}

TEST(TumRgbd, RefusesMissingImage) {
  const TumFolder folder;
  std::filesystem::remove(folder.path() / "depth/1.png");
  const std::string message = refusal(folder, ErrorCode::data_missing);
  expect_contains(message, "depth.txt:3: image ");
  expect_contains(message, "depth/1.png does not exist");
}

TEST(TumRgbd, RefusesImagesThatDoNotFitTheCamera) {
  ReadOptions options;
  options.camera = parse_camera("freiburg1").value();
  expect_contains(refusal(TumFolder(), ErrorCode::data_corrupt, options),
                  "0.png: image of 8x6 pixels, but the camera's calibration is for 640x480");
}

TEST(TumRgbd, BadImagesAreErrorsOfTheirFrame) {
  const TumFolder folder;
  folder.write_depth(1, Image<std::uint16_t>(4, 4, 1));
  folder.write("rgb/2.png", testing::read_bytes(folder.path() / "rgb/0.png").substr(0, 50));
  const auto recording = open_tum_rgbd(folder.path(), small_camera());
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_TRUE(recording->load_frame(0));
  const auto wrong_size = recording->load_frame(1);
  ASSERT_FALSE(wrong_size);
  EXPECT_EQ(wrong_size.error().code, ErrorCode::data_corrupt);
  expect_contains(wrong_size.error().message, "depth/1.png: expected 8x6 pixels, got 4x4");
  const auto truncated = recording->load_frame(2);
  ASSERT_FALSE(truncated);
  EXPECT_EQ(truncated.error().code, ErrorCode::data_corrupt);
  expect_contains(truncated.error().message, "rgb/2.png: truncated PNG");
}

TEST(TumRgbd, FingerprintFollowsContentNotText) {
  const TumFolder folder;
  const auto fingerprint = [&] { return open_tum_rgbd(folder.path(), small_camera())->fingerprint; };
  const std::string original = fingerprint();
  EXPECT_EQ(fingerprint(), original);
  folder.write("rgb.txt", "10.00,rgb/0.png\r\n10.10,rgb/1.png\r\n10.20,rgb/2.png\r\n");
  EXPECT_EQ(fingerprint(), original) << "another spelling of the same list";
  folder.write("groundtruth.txt", "10 1 2 3 0 0 0 1\n");
  const std::string other_truth = fingerprint();
  EXPECT_NE(other_truth, original);
  folder.write_depth(1, Image<std::uint16_t>(8, 6, 77));
  EXPECT_NE(fingerprint(), other_truth);
}

TEST(SelectFrames, RenumbersAndChangesTheFingerprint) {
  const TumFolder folder;
  auto recording = open_tum_rgbd(folder.path(), small_camera());
  ASSERT_TRUE(recording);
  const std::string whole = recording->fingerprint;
  ASSERT_TRUE(select_frames(*recording, 0, 3));
  EXPECT_EQ(recording->fingerprint, whole);
  EXPECT_EQ(recording->whole_frames, 0U);
  ASSERT_TRUE(select_frames(*recording, 1, 3));
  EXPECT_EQ(recording->whole_frames, 3U);
  EXPECT_NE(recording->fingerprint, whole);
  ASSERT_EQ(recording->frames.size(), 2U);
  EXPECT_EQ(recording->load_frame(0)->timestamp_ns, recording->frames[0].timestamp_ns);
  EXPECT_EQ(recording->load_frame(1)->timestamp_ns, 10'200'000'000);
  ASSERT_TRUE(select_frames(*recording, 1, 2));
  EXPECT_EQ(recording->load_frame(0)->timestamp_ns, 10'200'000'000);
  const auto refused = select_frames(*recording, 0, 2);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::usage);
}

/// Expected values were read with another decoder, and undistorted in double precision by OpenCV's own map.
TEST(GoldenTum, FramesHoldIndependentlyReadValues) {
  const auto recording = open_recording(golden_tum_folder());
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_TRUE(recording->warnings.empty());
  ASSERT_EQ(recording->frames.size(), 5U);
  EXPECT_EQ(recording->frames[0].timestamp_ns, 1305031229528748000);
  EXPECT_EQ(recording->frames[4].depth_timestamp_ns, 1305031229664358000);
  EXPECT_EQ(recording->ground_truth.size(), 60U);
  EXPECT_EQ(recording->accelerometer.size(), 291U);

  const auto raw = read_color(recording->frames[0].color_file);
  ASSERT_TRUE(raw);
  EXPECT_EQ((*raw)(0, 0), (Rgb{12, 9, 8}));
  EXPECT_EQ((*raw)(639, 479), (Rgb{190, 178, 185}));
  const auto raw_depth = read_depth16(recording->frames[0].depth_file);
  ASSERT_TRUE(raw_depth);
  EXPECT_EQ(std::accumulate(raw_depth->data.begin(), raw_depth->data.end(), std::int64_t{0}), 1482757129);
  EXPECT_EQ(std::count(raw_depth->data.begin(), raw_depth->data.end(), 0), 89238);

  const auto frame = recording->load_frame(0);
  ASSERT_TRUE(frame);
  const auto expect_color = [&](int x, int y, const std::array<double, 3>& rgb) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(frame->color(x, y)[c], rgb[c], 1.5) << x << " " << y;
  };
  expect_color(320, 240, {24.0, 16.0, 23.0});
  expect_color(100, 400, {253.97, 254.0, 253.03});
  expect_color(500, 300, {216.17, 201.67, 200.47});
  expect_color(60, 60, {14.39, 6.36, 11.88});
  EXPECT_EQ(frame->depth_m(320, 240), 6192 / 5000.0F);
  EXPECT_EQ(frame->depth_m(100, 400), 4378 / 5000.0F);
  EXPECT_EQ(frame->depth_m(500, 300), 9118 / 5000.0F);
  EXPECT_EQ(frame->depth_m(60, 60), 0.0F);
  EXPECT_NEAR(static_cast<double>(std::count(frame->depth_m.data.begin(), frame->depth_m.data.end(), 0.0F)),
              99306, 50);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_TRUE(recording->load_frame(i)) << i;
}

}  // namespace
}  // namespace fusebench
