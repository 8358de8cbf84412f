// Measurements of an inspection, on a recording whose values are known, and on real ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "datasets/open_recording.hpp"
#include "tests/datasets/inspection/clean_recording.hpp"
#include "tests/datasets/recording/formats/tum/tum_folder.hpp"

namespace fusebench::testing {

using namespace recording;
using namespace datasets;
using namespace inspection;

namespace {

TEST(Inspection, MeasuresWhatIsKnown) {
  const Recording recording = clean_recording();
  const Inspection result = inspected(recording);
  EXPECT_EQ(result.frames, 90U);
  EXPECT_NEAR(result.color_stamps.rate_hz, 30, 0.01);
  EXPECT_NEAR(result.imu->stamps.rate_hz, 200, 0.01);
  EXPECT_EQ(result.color_stamps.gaps, 0U);
  EXPECT_DOUBLE_EQ(result.truth->coverage, 1);
  EXPECT_EQ(result.images.size(), 90U);
  EXPECT_DOUBLE_EQ(result.depth.coverage_median, 1);
  EXPECT_GT(result.depth.median_m, 1.0);
  EXPECT_LT(result.depth.max_m, 4.5);
  ASSERT_EQ(result.motion.speeds.size(), 90U);
  // Against the derivative of the motion itself.
  const double t = 1e-9 * static_cast<double>(recording.frames[45].capture_ns);
  const SE3 before = SwayingMotion::T_world_camera(t - 1e-3), after = SwayingMotion::T_world_camera(t + 1e-3);
  EXPECT_NEAR(result.motion.speeds[45].angular_radps,
              rotation_angle_rad(before.rotation, after.rotation) / 2e-3, 0.02);
  EXPECT_NEAR(*result.motion.speeds[45].linear_mps, (after.translation - before.translation).norm() / 2e-3,
              0.01);
  ASSERT_TRUE(result.imu->gravity_mps2);
  EXPECT_NEAR(*result.imu->gravity_mps2, kGravity_mps2, 0.15);
}

TEST(Inspection, ASlowMotionIsSlowAndAFastOneIsFast) {
  Recording recording = clean_recording({.imu = false});
  EXPECT_FALSE(inspected(recording).motion.fast);
  recording.rig.camera.fx_px *= 12;  // the same motion at a longer focal length
  EXPECT_TRUE(inspected(recording).motion.fast);
}

TEST(Inspection, TheThreadsDoNotShow) {
  const Recording recording = clean_recording({.frames = 40});
  const Inspection one = inspected(recording, 1), three = inspected(recording, 3);
  ASSERT_EQ(one.findings.size(), three.findings.size());
  for (std::size_t i = 0; i < one.findings.size(); ++i)
    EXPECT_EQ(one.findings[i].message, three.findings[i].message);
  EXPECT_EQ(one.imu_alignment->time_offset_s, three.imu_alignment->time_offset_s);
  EXPECT_EQ(one.reprojection->depth_residual_m, three.reprojection->depth_residual_m);
}

TEST(Inspection, FiveRightFramesDoNotSayThatDepthIsMisregistered) {
  const auto recording = open_recording(golden_tum_folder());
  ASSERT_TRUE(recording) << recording.error().message;
  const Inspection result = inspected(*recording);
  ASSERT_TRUE(result.registration);
  EXPECT_EQ(result.registration->frames, 5U);
  EXPECT_FALSE(result.has("depth-misregistered"));
}

TEST(Inspection, ACameraThatStandsStillTestsNoCalibration) {
  Recording recording = clean_recording({.frames = 10, .imu = false});
  recording.load_frame = [still = *recording.load_frame(0), frames = recording.frames](std::size_t k) {
    RgbdFrame frame = still;
    frame.timestamp_ns = frames[k].timestamp_ns;
    return Result<RgbdFrame>(std::move(frame));
  };
  for (auto& pose : recording.ground_truth) pose.T_world_camera = {};
  const Inspection result = inspected(recording);
  ASSERT_TRUE(result.reprojection);
  EXPECT_TRUE(result.reprojection->hypotheses.empty());
  ASSERT_NE(find(result, "reprojection-untested"), nullptr);
  EXPECT_THAT(find(result, "reprojection-untested")->hint, ::testing::HasSubstr("--frames"));
}

TEST(Inspection, AFrameThatCannotBeLoadedIsAFinding) {
  Recording recording = clean_recording({.frames = 20});
  recording.load_frame = [whole = recording.load_frame](std::size_t k) -> Result<RgbdFrame> {
    if (k == 7) return fail(ErrorCode::data_corrupt, "frame 7: truncated");
    return whole(k);
  };
  const Inspection result = inspected(recording);
  ASSERT_NE(find(result, "frame-unreadable"), nullptr);
  EXPECT_THAT(find(result, "frame-unreadable")->message, ::testing::HasSubstr("frame 7: truncated"));
}

TEST(Inspection, ARecordingOfOneFrameIsInspected) {
  const Inspection result = inspected(clean_recording({.frames = 1}));
  EXPECT_EQ(result.frames, 1U);
  EXPECT_EQ(result.count(Severity::error), 0U);
}

TEST(Inspection, CodesAreListedOnce) {
  const auto codes = finding_codes();
  for (std::size_t i = 0; i < codes.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(codes[i].code, codes[j].code);
  }
  Inspection inspection;
  EXPECT_THROW(inspection.add("no-such-code", Severity::note, ""), InternalError);
}

/// A folder below FUSEBENCH_DATA, or an empty path.
std::filesystem::path real_recording(const char* name) {
  const char* data = std::getenv("FUSEBENCH_DATA");
  if (data == nullptr) return {};
  const std::filesystem::path folder = std::filesystem::path(data) / name;
  return std::filesystem::exists(folder) ? folder : std::filesystem::path();
}

TEST(RealRecordings, IclLivingRoomHasNoError) {
  const auto folder = real_recording("icl_nuim_lr_kt2_frames1-3");
  if (folder.empty()) GTEST_SKIP() << "FUSEBENCH_DATA has no icl_nuim_lr_kt2_frames1-3";
  OpenOptions options;
  options.format = "icl";
  const auto recording = open_recording(folder, options);
  ASSERT_TRUE(recording) << recording.error().message;
  const Inspection result = inspected(*recording);
  EXPECT_EQ(result.count(Severity::error), 0U) << result.findings.front().message;
  ASSERT_TRUE(result.reprojection);
  EXPECT_LT(result.reprojection->depth_residual_m, 0.001);
  EXPECT_LT(result.reprojection->intensity_residual_grey, 1);
}

TEST(RealRecordings, Freiburg1RpyHasNoError) {
  const auto folder = real_recording("rgbd_dataset_freiburg1_rpy_first240");
  if (folder.empty()) GTEST_SKIP() << "FUSEBENCH_DATA has no rgbd_dataset_freiburg1_rpy_first240";
  const auto recording = open_recording(folder);
  ASSERT_TRUE(recording) << recording.error().message;
  const Inspection result = inspected(*recording);
  for (const Finding& finding : result.findings) {
    EXPECT_NE(finding.severity, Severity::error) << finding.code << ": " << finding.message;
  }
  EXPECT_NEAR(result.color_stamps.rate_hz, 30, 1.5);
  EXPECT_NEAR(result.motion.angular_mean_radps, radians(57), radians(6));
}

}  // namespace
}  // namespace fusebench::testing
