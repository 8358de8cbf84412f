// Recordings that were read or written wrongly as a whole: each hypothesis is found by its evidence alone,
// and named with what corrects it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/datasets/inspection/clean_recording.hpp"

namespace fusebench::testing {

using namespace recording;
using namespace inspection;

namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

Recording with_truth() { return clean_recording({.imu = false}); }

void change_frames(Recording& recording, const std::function<void(RgbdFrame&)>& change) {
  recording.load_frame = [whole = recording.load_frame, change](std::size_t k) {
    auto frame = whole(k);
    if (frame) change(*frame);
    return frame;
  };
}

template <class Image>
Image mirrored(const Image& image, bool x_mirrored, bool y_mirrored) {
  Image result(image.width, image.height);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x)
      result(x, y) = image(x_mirrored ? image.width - 1 - x : x, y_mirrored ? image.height - 1 - y : y);
  }
  return result;
}

void change_poses(Recording& recording, const std::function<SE3(const SE3&)>& change) {
  for (StampedPose& pose : recording.ground_truth) pose.T_world_camera = change(pose.T_world_camera);
}

SE3 turned(const SE3& pose, const Matrix3d& axes) {
  return {Quaterniond(Matrix3d(pose.rotation_matrix() * axes)), pose.translation};
}

struct ColorFault {
  bool x;
  bool y;
  const char* name;
};
class MirroredColor : public ::testing::TestWithParam<ColorFault> {};

TEST_P(MirroredColor, IsNamed) {
  const ColorFault fault = GetParam();
  Recording recording = with_truth();
  change_frames(recording, [fault](RgbdFrame& frame) {
    frame.color = mirrored(frame.color, fault.x, fault.y);
    frame.grey = mirrored(frame.grey, fault.x, fault.y);
  });
  const Inspection result = inspected(recording);
  ASSERT_THAT(faults(result), Contains("color-mirrored"));
  EXPECT_THAT(faults(result), Not(Contains("truth-inconsistent")));
  EXPECT_THAT(find(result, "color-mirrored")->message, HasSubstr(fault.name));
}
INSTANTIATE_TEST_SUITE_P(Each, MirroredColor,
                         ::testing::Values(ColorFault{true, false, "colour is mirrored against"},
                                           ColorFault{true, true, "upside down"},
                                           ColorFault{false, true, "top to bottom"}));

TEST(Misreadings, ImagesOfBothCamerasThatAreUpsideDown) {
  Recording recording = with_truth();
  change_frames(recording, [](RgbdFrame& frame) {
    frame.color = mirrored(frame.color, true, true);
    frame.grey = mirrored(frame.grey, true, true);
    frame.depth_m = mirrored(frame.depth_m, true, true);
  });
  const Inspection result = inspected(recording);
  EXPECT_THAT(faults(result), ElementsAre("truth-camera-axes"));
  EXPECT_THAT(find(result, "truth-camera-axes")->hint, HasSubstr("rotate the images of colour and depth"));
}

TEST(Misreadings, DepthAlongTheRay) {
  Recording recording = with_truth();
  change_frames(recording, [camera = recording.rig.camera](RgbdFrame& frame) {
    for (int y = 0; y < frame.depth_m.height; ++y) {
      for (int x = 0; x < frame.depth_m.width; ++x)
        frame.depth_m(x, y) *= static_cast<float>(camera.back_project(x, y, 1.0).norm());
    }
  });
  const Inspection result = inspected(recording);
  EXPECT_THAT(faults(result), ElementsAre("depth-along-ray"));
  EXPECT_THAT(find(result, "depth-along-ray")->hint, HasSubstr("sqrt"));
}

class ImageSize : public ::testing::TestWithParam<double> {};

TEST_P(ImageSize, OfOtherIntrinsicsIsMeasured) {
  const double factor = GetParam();
  Recording recording = with_truth();
  PinholeCamera& camera = recording.rig.camera;
  camera.fx_px /= factor;
  camera.fy_px /= factor;
  camera.cx_px = (camera.cx_px + 0.5) / factor - 0.5;
  camera.cy_px = (camera.cy_px + 0.5) / factor - 0.5;
  const Inspection result = inspected(recording);
  ASSERT_THAT(faults(result), Contains("image-size"));
  EXPECT_THAT(faults(result), Not(Contains("truth-inconsistent")));
  for (const HypothesisResult& hypothesis : result.reprojection->hypotheses) {
    if (hypothesis.code == "image-size") {
      EXPECT_NEAR(hypothesis.value, factor, 0.02 * factor);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Factors, ImageSize, ::testing::Values(0.5, 0.75, 4.0 / 3, 2.0));

TEST(Misreadings, LateDepth) {
  Recording recording = with_truth();
  for (FrameEntry& frame : recording.frames) frame.depth_capture_ns += 500'000'000;
  change_frames(recording, [](RgbdFrame& frame) { frame.depth_offset_ns += 500'000'000; });
  const Inspection result = inspected(recording);
  ASSERT_THAT(faults(result), Contains("depth-time-offset"));
  EXPECT_THAT(find(result, "depth-time-offset")->message,
              ::testing::ContainsRegex("(499|500|501) ms earlier"));
  EXPECT_THAT(find(result, "depth-time-offset")->hint,
              ::testing::ContainsRegex("add -0.(499|500|501) to delay_s"));
}

TEST(Misreadings, GroundTruthHalfASecondLate) {
  Recording recording = with_truth();
  for (StampedPose& pose : recording.ground_truth) pose.timestamp_ns += 500'000'000;
  const Inspection result = inspected(recording);
  ASSERT_THAT(faults(result), Contains("truth-time-offset"));
  EXPECT_THAT(find(result, "truth-time-offset")->message,
              ::testing::ContainsRegex("(499|500).[0-9] ms later"));
}

TEST(Misreadings, PosesOfAnOpenGlCamera) {
  Recording recording = with_truth();
  const Matrix3d axes = Vector3d(1, -1, -1).asDiagonal();
  change_poses(recording, [&](const SE3& pose) { return turned(pose, axes); });
  const Inspection result = inspected(recording);
  EXPECT_THAT(faults(result), ElementsAre("truth-camera-axes"));
  EXPECT_THAT(find(result, "truth-camera-axes")->message, HasSubstr("(right, up, back)"));
}

TEST(Misreadings, PosesOfARobotsBody) {
  Recording recording = with_truth();
  Matrix3d axes;  // columns: left-handed would be a mistake here; x forward, y left, z up
  axes << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  change_poses(recording, [&](const SE3& pose) { return turned(pose, axes); });
  const Inspection result = inspected(recording);
  EXPECT_THAT(faults(result), ElementsAre("truth-camera-axes"));
  EXPECT_THAT(find(result, "truth-camera-axes")->message, HasSubstr("(forward, left, up)"));
}

class LeftHanded : public ::testing::TestWithParam<int> {};

TEST_P(LeftHanded, PositionsAreNamed) {
  Recording recording = with_truth();
  change_poses(recording, [](const SE3& pose) {
    SE3 changed = pose;
    changed.translation[GetParam()] *= -1;
    return changed;
  });
  const Inspection result = inspected(recording);
  ASSERT_THAT(faults(result), ElementsAre("truth-position-axes"));
  EXPECT_THAT(find(result, "truth-position-axes")->message, HasSubstr("left-handed"));
  constexpr std::array kTexts{"(-tx, ty, tz)", "(tx, -ty, tz)", "(tx, ty, -tz)"};
  EXPECT_THAT(find(result, "truth-position-axes")->hint,
              HasSubstr(kTexts.at(static_cast<std::size_t>(GetParam()))));
}
INSTANTIATE_TEST_SUITE_P(EachAxis, LeftHanded, ::testing::Values(0, 1, 2));

TEST(Misreadings, ExchangedPositions) {
  Recording recording = with_truth();
  change_poses(recording, [](const SE3& pose) {
    const Vector3d& t = pose.translation;
    return SE3{pose.rotation, {t.z(), t.x(), t.y()}};
  });
  const Inspection result = inspected(recording);
  ASSERT_THAT(faults(result), ElementsAre("truth-position-axes"));
  EXPECT_THAT(find(result, "truth-position-axes")->hint, HasSubstr("(ty, tz, tx)"));
}

TEST(Misreadings, AConstantTruth) {
  Recording recording = with_truth();
  const SE3 pose = recording.ground_truth.front().T_world_camera;
  change_poses(recording, [&](const SE3&) { return pose; });
  const Inspection result = inspected(recording);
  EXPECT_THAT(faults(result), ElementsAre("truth-constant"));
}

TEST(Misreadings, ATruthThatStopsWhileTheCameraGoesOn) {
  Recording recording = with_truth();
  const std::size_t stop = recording.ground_truth.size() * 2 / 3;
  for (std::size_t i = stop; i < recording.ground_truth.size(); ++i)
    recording.ground_truth[i].T_world_camera = recording.ground_truth[stop].T_world_camera;
  EXPECT_THAT(faults(inspected(recording)), Contains("truth-constant"));
}

TEST(Misreadings, ACameraThatRestsHasARightTruth) {
  Recording recording = with_truth();
  const std::size_t half = recording.frames.size() / 2;
  const std::int64_t rest_ns = recording.frames[half].capture_ns;
  const SE3 rest = SwayingMotion::T_world_camera(1e-9 * static_cast<double>(rest_ns));
  for (StampedPose& pose : recording.ground_truth) {
    if (pose.timestamp_ns >= rest_ns) pose.T_world_camera = rest;
  }
  recording.load_frame = [whole = recording.load_frame, frames = recording.frames, half](std::size_t k) {
    auto frame = whole(std::min(k, half));
    frame->timestamp_ns = frames[k].timestamp_ns;
    return frame;
  };
  EXPECT_THAT(faults(inspected(recording)), Not(Contains("truth-constant")));
}

TEST(Misreadings, OfARightRecordingAreAllRejected) {
  const Inspection result = inspected(with_truth());
  EXPECT_THAT(faults(result), IsEmpty());
  ASSERT_TRUE(result.reprojection);
  std::vector<std::string> codes;
  for (const HypothesisResult& hypothesis : result.reprojection->hypotheses) {
    codes.push_back(hypothesis.code);
    if (hypothesis.code.starts_with("truth-") && hypothesis.value == 0 &&
        hypothesis.code != "truth-time-offset") {
      EXPECT_GT(hypothesis.factor, 1) << hypothesis.name;
    }
  }
  EXPECT_THAT(codes, ::testing::UnorderedElementsAre("color-mirrored", "depth-along-ray", "truth-inverted",
                                                     "truth-rotation-inverted", "truth-quaternion-order",
                                                     "truth-not-reflected", "truth-camera-axes",
                                                     "truth-position-axes", "depth-scale", "focal-length",
                                                     "image-size", "truth-time-offset", "depth-time-offset"));
}

}  // namespace
}  // namespace fusebench::testing
