#include "datasets/recording/formats/icl/icl_nuim.hpp"

#include <gtest/gtest.h>

#include "core/base/trajectory/trajectory.hpp"
#include "datasets/recording/formats/icl/icl_conventions.hpp"
#include "datasets/recording/reading/numbered_frames.hpp"
#include "tests/datasets/recording/formats/icl/icl_folder.hpp"
#include "tests/datasets/recording/formats/tum/tum_folder.hpp"

namespace fusebench {

using namespace trajectory;
using namespace recording;
using namespace formats::icl;
using namespace datasets;

namespace {

using testing::expect_part;
using testing::icl_small_camera;
using testing::IclFolder;
using testing::refusal_message;

constexpr std::int64_t kPeriod_ns = 33'333'333;

TEST(IclConventions, ReflectionIsConjugationByF) {
  const SE3 T{Quaterniond(0.9, 0.1, -0.3, 0.2).normalized(), {1, 2, 3}};
  const Matrix3d F = Vector3d(1, -1, 1).asDiagonal();
  const SE3 reflected = icl_reflect(T);
  EXPECT_TRUE(reflected.rotation_matrix().isApprox(F * T.rotation_matrix() * F, 1e-14));
  EXPECT_EQ(reflected.translation, Vector3d(1, -2, 3));
  EXPECT_NEAR(reflected.rotation_matrix().determinant(), 1, 1e-14);
  EXPECT_TRUE(icl_reflect(reflected).rotation.isApprox(T.rotation, 1e-15));
}

/// The renderer's convention (y up, fy < 0) and this project's (y down, fy > 0) put a point of one frame onto
/// the same pixel of another; leaving out either half does not.
TEST(IclConventions, BothConventionsSeeTheSamePixels) {
  const SE3 T_a{Quaterniond(0.99, 0.02, -0.05, 0.08).normalized(), {0.1, 0.3, -2.2}};
  const SE3 T_b{Quaterniond(0.98, -0.04, 0.06, -0.03).normalized(), {-0.2, 0.1, -2.1}};
  const PinholeCamera camera = icl_calibration().color.pinhole;
  PinholeCamera published = camera;
  published.fy_px = -480;
  for (const auto& [u, v] : {std::pair(100.0, 50.0), std::pair(500.0, 400.0), std::pair(319.5, 10.0)}) {
    const Vector3d icl_a = published.back_project(u, v, 1.7);
    const Vector3d cv_a = camera.back_project(u, v, 1.7);
    const Vector2d expected = published.project(T_b.inverse() * T_a * icl_a);
    const SE3 T_ba = icl_reflect(T_b).inverse() * icl_reflect(T_a);
    EXPECT_LT((camera.project(T_ba * cv_a) - expected).norm(), 1e-9);
    EXPECT_GT((camera.project(T_b.inverse() * T_a * cv_a) - expected).norm(), 5.0) << "not reflected";
    EXPECT_GT((published.project(T_ba * icl_a) - expected).norm(), 5.0) << "reflected, but fy < 0";
  }
}

TEST(IclConventions, IndicesAndTimes) {
  EXPECT_EQ(reading::frame_number("0"), 0);
  EXPECT_EQ(reading::frame_number("0001508"), 1508);
  for (const char* bad : {"", "-1", "1.0", "+1", " 1", "1e3", "1234567890", "1305031229.5"})
    EXPECT_FALSE(reading::frame_number(bad)) << bad;
  EXPECT_EQ(reading::frame_time_ns(0, 30), 0);
  EXPECT_EQ(reading::frame_time_ns(1, 30), kPeriod_ns);
  EXPECT_EQ(reading::frame_time_ns(2, 30), 66'666'667);
  EXPECT_EQ(reading::frame_time_ns(1500, 25), 60'000'000'000);
}

TEST(IclNuim, OpensAndMatchesByIndex) {
  const IclFolder folder;
  const auto recording = folder.open();
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->format, "icl");
  ASSERT_EQ(recording->frames.size(), 4U);
  EXPECT_EQ(recording->frames[2].timestamp_ns, 66'666'667);
  EXPECT_EQ(recording->frames[2].depth_capture_ns, 66'666'667);
  ASSERT_EQ(recording->ground_truth.size(), 3U);
  // Row 0 of the truth is frame 1: by row number, every pose would belong to its neighbour.
  EXPECT_EQ(recording->ground_truth[0].timestamp_ns, recording->frames[1].timestamp_ns);
  EXPECT_EQ(recording->ground_truth[0].T_world_camera.translation, Vector3d(0, 0, -2.25));
  EXPECT_EQ(recording->ground_truth[1].T_world_camera.translation, Vector3d(0.1, -0.2, -2.15));
  EXPECT_TRUE(recording->ground_truth[1].T_world_camera.rotation.isApprox(
      Quaterniond(0.9273618495495703, -0.1, 0.2, -0.3), 1e-12));
  EXPECT_FALSE(interpolate_pose(recording->ground_truth, recording->frames[0].timestamp_ns, 1'000'000'000));
  EXPECT_TRUE(recording->warnings.empty());  // as published: no fault of this recording
  expect_part(recording->notes.back(), "1 of 4 frames have no ground truth");
  const auto frame = recording->load_frame(3);
  ASSERT_TRUE(frame) << frame.error().message;
  EXPECT_EQ(frame->depth_m(0, 0), 5003 / 5000.0F);
  EXPECT_EQ(frame->color(0, 0), (Rgb{10, 20, 3})) << "depth is listed first; colour must be colour";
}

TEST(IclNuim, PublishedCameraHasPositiveFy) {
  EXPECT_EQ(icl_calibration().color.pinhole.fy_px, 480);
  EXPECT_EQ(icl_calibration().color.pinhole.width_px, 640);
  expect_part(refusal_message(IclFolder().open({}), ErrorCode::data_corrupt),
              "image of 8x6 pixels, but the camera's calibration is for 640x480");
}

TEST(IclNuim, OrderOfColumnsDoesNotMatter) {
  const IclFolder folder;
  const std::string depth_first = folder.open().value().fingerprint;
  folder.write("associations.txt",
               "0 rgb/0.png 0 depth/0.png\r\n1 rgb/1.png 1 depth/1.png\r\n2 depth/2.png 2 rgb/2.png\r\n"
               "3 rgb/3.png 3 depth/3.png\r\n");
  const auto recording = folder.open();
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->fingerprint, depth_first);
}

TEST(IclNuim, MissingFramesKeepTheirTimes) {
  const IclFolder folder;
  folder.write("associations.txt", "0 depth/0.png 0 rgb/0.png\n3 depth/3.png 3 rgb/3.png\n");
  const auto recording = folder.open();
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_EQ(recording->frames.size(), 2U);
  EXPECT_EQ(recording->frames[1].timestamp_ns, 100'000'000);
  const auto pose = interpolate_pose(recording->ground_truth, recording->frames[1].timestamp_ns, 0);
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->translation, Vector3d(0.2, -0.4, -2)) << "the pose of frame 3, not of the second row";
  ASSERT_EQ(recording->warnings.size(), 1U);
  expect_part(recording->warnings[0], "2 of the 4 frames from 0 to 3 are not there");
}

TEST(IclNuim, FrameRateIsAnOption) {
  ReadOptions options = icl_small_camera();
  options.frame_rate_hz = 25;
  const auto recording = IclFolder().open(options);
  ASSERT_TRUE(recording);
  EXPECT_EQ(recording->frames[3].timestamp_ns, 120'000'000);
  EXPECT_EQ(recording->ground_truth[2].timestamp_ns, 120'000'000);
  const auto told = [&](const std::string& note) {
    return note.find("frame k is taken to be at k / 25 s") < 100;
  };
  EXPECT_TRUE(std::any_of(recording->notes.begin(), recording->notes.end(), told));
  options.frame_rate_hz = 0;
  expect_part(refusal_message(IclFolder().open(options), ErrorCode::configuration), "frame_rate_hz = 0");
}

TEST(IclNuim, RecognisedBesideTumLists) {
  const IclFolder folder;
  folder.write("rgb.txt", "0 rgb/0.png\n");
  folder.write("depth.txt", "0 depth/0.png\n");
  EXPECT_EQ(recognise_format(folder.path()), "icl");
  folder.remove("livingRoom1.gt.freiburg");
  EXPECT_EQ(recognise_format(folder.path()), "icl") << "by the numbers in the list";
}

TEST(IclNuim, TumRecordingWithAListOfPairsStaysTum) {
  const testing::TumFolder folder;
  folder.write("associations.txt", "10.0 rgb/0.png 10.01 depth/0.png\n");
  EXPECT_EQ(recognise_format(folder.path()), "tum");
  folder.write("associations.txt", "10 rgb/0.png 10 depth/0.png\n");
  EXPECT_EQ(recognise_format(folder.path()), "tum") << "whole seconds are no frame numbers";
  folder.write("associations.txt", "");
  EXPECT_EQ(recognise_format(folder.path()), "tum");
}

TEST(IclNuim, GroundTruthTxtCountsFramesToo) {
  const IclFolder folder;
  folder.remove("livingRoom1.gt.freiburg");
  EXPECT_TRUE(folder.open().value().ground_truth.empty());
  folder.write("groundtruth.txt", "# index\n1 0 1 0 0 0 0 1\n2 0 1 0 0 0 0 1\n");
  const auto recording = folder.open();
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_EQ(recording->ground_truth.size(), 2U);
  EXPECT_EQ(recording->ground_truth[0].timestamp_ns, kPeriod_ns);
  EXPECT_EQ(recording->ground_truth[0].T_world_camera.translation, Vector3d(0, -1, 0));
  folder.write("groundtruth.txt", "0.0333 0 1 0 0 0 0 1\n");
  expect_part(refusal_message(folder.open(), ErrorCode::data_corrupt), "has no whole frame number");
  folder.write("groundtruth.txt", "-1 0 1 0 0 0 0 1\n");
  expect_part(refusal_message(folder.open(), ErrorCode::data_corrupt),
              "pose -1.000000000 has no whole frame number");
}

TEST(IclNuim, PublishedTruthWinsAndMustBeOne) {
  const IclFolder folder;
  folder.write("groundtruth.txt", "1 9 9 9 0 0 0 1\n");
  const auto recording = folder.open();
  ASSERT_TRUE(recording);
  EXPECT_EQ(recording->ground_truth.size(), 3U);
  folder.write("livingRoom2.gt.freiburg", "1 0 0 0 0 0 0 1\n");
  expect_part(refusal_message(folder.open(), ErrorCode::data_corrupt),
              "2 ground truth files: livingRoom1.gt.freiburg, livingRoom2.gt.freiburg");
}

TEST(IclNuim, RefusesBadRows) {
  const auto after_writing = [](std::string_view rows) {
    const IclFolder folder;
    folder.write("associations.txt", rows);
    return refusal_message(folder.open_as_icl(), ErrorCode::data_corrupt);
  };
  expect_part(after_writing("-1 depth/0.png -1 rgb/0.png\n"),
              "associations.txt:1: expected the number of a frame");
  expect_part(after_writing("0.5 depth/0.png 0.5 rgb/0.png\n"), "got '0.5'");
  expect_part(after_writing("0 depth/0.png 1 rgb/1.png\n"), "colour image 1 is paired with depth image 0");
  expect_part(after_writing("1 depth/0.png 1 rgb/0.png\n"), "image 0.png is listed as number 1");
  expect_part(after_writing("0 depth/0.png 0 depth/1.png\n"), "cannot tell which image is depth");
  expect_part(after_writing("0 rgb/0.png 0 rgb/1.png\n"), "cannot tell which image is depth");
  expect_part(after_writing("1 depth/1.png 1 rgb/1.png\n1 depth/1.png 1 rgb/1.png\n"),
              "associations.txt:2: frame 1 comes after frame 1");
  expect_part(after_writing("0 depth/0.png 0\n"), "expected 4 columns");
  expect_part(after_writing("# nothing\n"), "has no rows");
}

TEST(IclNuim, RefusesMissingImage) {
  const IclFolder folder;
  folder.remove("rgb/2.png");
  expect_part(refusal_message(folder.open(), ErrorCode::data_missing), "associations.txt:3: image ");
}

TEST(IclNuim, ImuNeedsItsPlace) {
  const IclFolder folder;
  folder.write("imu.csv", "#t,w,a\n0,0,0,0,0,9.81,0\n100000000,0,0,0,0,9.81,0\n");
  EXPECT_EQ(folder.open().value().imu_source, ImuSource::none);
  folder.write("calibration.toml",
               "[color]\nfx_px = 10\nfy_px = 11\ncx_px = 3.5\ncy_px = 2.5\n[imu]\n"
               "T_imu_color = [1, 0, 0, 0.1, 0, 1, 0, 0, 0, 0, 1, 0]\ngyroscope_noise_radps_sqrthz = 1e-3\n"
               "accelerometer_noise_mps2_sqrthz = 1e-2\ngyroscope_bias_walk_radps2_sqrthz = 1e-5\n"
               "accelerometer_bias_walk_mps3_sqrthz = 1e-4\n");
  const auto recording = folder.open({});
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->imu_source, ImuSource::recorded);
  ASSERT_EQ(recording->imu.size(), 2U);
  EXPECT_EQ(recording->imu[1].timestamp_ns, recording->frames[3].timestamp_ns);
  EXPECT_EQ(recording->rig.T_imu_camera.translation, Vector3d(0.1, 0, 0));
}

}  // namespace
}  // namespace fusebench
