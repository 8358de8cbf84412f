// Each planted fault is found and named, and nothing else is said to be wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "datasets/inspection/checks.hpp"
#include "tests/datasets/inspection/clean_recording.hpp"

namespace fusebench::testing {

using namespace recording;
using namespace inspection;

namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr std::int64_t kMillisecond_ns = 1'000'000;

TEST(PlantedFaults, ACleanRecordingHasNone) {
  const Inspection result = inspected(clean_recording());
  EXPECT_THAT(faults(result), IsEmpty()) << result.findings.front().message;
  ASSERT_TRUE(result.imu_alignment);
  EXPECT_LT(std::abs(result.imu_alignment->time_offset_s), 0.001);
  EXPECT_LT(result.imu_alignment->rotation_error_rad, radians(0.5));
  EXPECT_NEAR(result.imu_alignment->scale, 1, 0.01);
  ASSERT_TRUE(result.reprojection);
  EXPECT_LT(result.reprojection->depth_residual_share, 0.005);
}

TEST(PlantedFaults, ACleanRecordingWithoutTruthHasNone) {
  CleanOptions options;
  options.truth = false;
  options.camera = small_camera();
  const Inspection result = inspected(clean_recording(options));
  EXPECT_THAT(faults(result), IsEmpty()) << result.findings.front().message;
  ASSERT_TRUE(result.imu_alignment);
  EXPECT_EQ(result.imu_alignment->source, "images");
  EXPECT_LT(std::abs(result.imu_alignment->time_offset_s), 0.002);
  EXPECT_LT(result.imu_alignment->rotation_error_rad, radians(1));
}

TEST(PlantedFaults, FramesWithoutTruthAreToldOnce) {
  Recording recording = clean_recording();
  recording.ground_truth.resize(recording.ground_truth.size() / 2);
  recording.warnings = {"groundtruth.txt: 40 of 90 frames have no ground truth around them within 0.1 s",
                        "rgb.txt: another thing"};
  const Inspection result = inspected(recording);
  EXPECT_THAT(faults(result), AllOf(Contains("truth-coverage"), Contains("reader-warning")));
  EXPECT_THAT(std::ranges::count(result.findings, "reader-warning", &Finding::code), 1);
}

TEST(PlantedFaults, SwappedAxesAreNamed) {
  Recording recording = clean_recording();
  for (ImuSample& sample : recording.imu) {
    for (Vector3d* v : {&sample.angular_velocity_radps, &sample.specific_force_mps2})
      *v = Vector3d(v->y(), -v->x(), v->z());
  }
  const Inspection result = inspected(recording);
  EXPECT_THAT(faults(result), ElementsAre("imu-axes-swapped"));
  EXPECT_THAT(find(result, "imu-axes-swapped")->message, HasSubstr("(y, -x, z)"));
}

TEST(PlantedFaults, MirroredAxesAreNamed) {
  Recording recording = clean_recording();
  for (ImuSample& sample : recording.imu) {
    for (Vector3d* v : {&sample.angular_velocity_radps, &sample.specific_force_mps2})
      std::swap(v->x(), v->y());
  }
  const Inspection result = inspected(recording);
  ASSERT_THAT(faults(result), Contains("imu-axes-swapped"));
  EXPECT_THAT(find(result, "imu-axes-swapped")->message, HasSubstr("mirrored"));
  EXPECT_THAT(find(result, "imu-axes-swapped")->message, HasSubstr("(y, x, z)"));
}

TEST(PlantedFaults, AMirrorImageThatIsNoExchangeOfAxesHasNoRotation) {
  Recording recording = clean_recording();
  const Vector3d normal = Vector3d(1, 0.4, 0.2).normalized();
  for (ImuSample& sample : recording.imu) {
    for (Vector3d* v : {&sample.angular_velocity_radps, &sample.specific_force_mps2})
      *v -= 2 * normal.dot(*v) * normal;
  }
  const Inspection result = inspected(recording);
  ASSERT_THAT(faults(result), Contains("imu-axes-swapped"));
  EXPECT_THAT(faults(result), Not(Contains("extrinsic-rotated")));
  const Finding& finding = *find(result, "imu-axes-swapped");
  EXPECT_THAT(finding.message, AllOf(HasSubstr("mirrored"), Not(HasSubstr("deg"))));
  EXPECT_THAT(finding.hint, Not(HasSubstr("[")));
  EXPECT_FALSE(result.imu_alignment->rotation_error_rad);
}

TEST(PlantedFaults, RotatedExtrinsicIsMeasured) {
  Recording recording = clean_recording();
  recording.rig.T_imu_camera.rotation = recording.rig.T_imu_camera.rotation * so3_exp({0, radians(12), 0});
  const Inspection result = inspected(recording);
  EXPECT_THAT(faults(result), ElementsAre("extrinsic-rotated"));
  EXPECT_NEAR(result.imu_alignment->rotation_error_rad.value(), radians(12), radians(0.5));
}

class ImuOffset : public ::testing::TestWithParam<std::tuple<int, bool>> {};

TEST_P(ImuOffset, IsFoundWithItsSign) {
  const auto [offset_ms, truth] = GetParam();
  CleanOptions options;
  options.truth = truth;
  if (!truth) options.camera = small_camera();
  Recording recording = clean_recording(options);
  for (ImuSample& sample : recording.imu) sample.timestamp_ns += offset_ms * kMillisecond_ns;
  const Inspection result = inspected(recording);
  ASSERT_THAT(faults(result), ElementsAre("imu-time-offset"));
  EXPECT_NEAR(result.imu_alignment->time_offset_s, 1e-3 * offset_ms, truth ? 0.001 : 0.002);
  const Finding& finding = *find(result, "imu-time-offset");
  EXPECT_EQ(finding.severity, Severity::error);
  EXPECT_THAT(finding.message, HasSubstr(offset_ms > 0 ? "later" : "earlier"));
  EXPECT_THAT(finding.hint, HasSubstr("time_offset_s in [imu]"));
  EXPECT_THAT(finding.hint, HasSubstr(offset_ms > 0 ? "+0.0" : "-0.0"));
}
INSTANTIATE_TEST_SUITE_P(BothSigns, ImuOffset,
                         ::testing::Combine(::testing::Values(20, -20), ::testing::Values(true, false)));

TEST(PlantedFaults, AnOffsetBeyondTheSearchIsNotMeasured) {
  Recording recording = clean_recording();
  for (ImuSample& sample : recording.imu) sample.timestamp_ns += 520 * kMillisecond_ns;
  const Inspection result = inspected(recording);
  EXPECT_THAT(faults(result), Contains("imu-unrelated"));
  EXPECT_THAT(faults(result), Not(Contains("imu-time-offset")));
  EXPECT_FALSE(result.imu_alignment);
}

TEST(PlantedFaults, DepthScaleOneThousandForFiveThousandByTruth) {
  const Inspection result = inspected(clean_recording({.depth_factor = 5}));
  EXPECT_THAT(faults(result), Contains("depth-scale"));
  for (const HypothesisResult& hypothesis : result.reprojection->hypotheses) {
    if (hypothesis.code != "depth-scale") continue;
    EXPECT_NEAR(hypothesis.value, 0.2, 0.01);
  }
  EXPECT_THAT(find(result, "depth-scale")->hint, HasSubstr("5000 for 1000"));
}

TEST(PlantedFaults, DepthScaleOneThousandForFiveThousandWithoutTruth) {
  const Inspection result = inspected(clean_recording({.truth = false, .imu = false, .depth_factor = 5}));
  EXPECT_THAT(faults(result), ElementsAre("depth-range"));
}

TEST(PlantedFaults, DepthScaleFiveThousandForOneThousand) {
  const Inspection result = inspected(clean_recording({.truth = false, .imu = false, .depth_factor = 0.2}));
  EXPECT_THAT(faults(result), ElementsAre("depth-range"));
  EXPECT_THAT(faults(inspected(clean_recording({.depth_factor = 0.2}))), Contains("depth-scale"));
}

/// A tenth of the room and of the motion: the same images, with depth of about 0.2 m.
TEST(PlantedFaults, ACloseUpWhoseScaleFitsTheTruthIsNoFault) {
  Recording recording = clean_recording({.imu = false, .depth_factor = 0.1});
  for (StampedPose& pose : recording.ground_truth) pose.T_world_camera.translation *= 0.1;
  const Inspection result = inspected(recording);
  EXPECT_LT(result.depth.median_m, 0.3);
  EXPECT_THAT(faults(result), Not(Contains("depth-range")));
  EXPECT_THAT(faults(result), Not(Contains("depth-scale")));
}

TEST(PlantedFaults, ACloseUpWithoutTruthIsNoError) {
  const Inspection result = inspected(clean_recording({.truth = false, .imu = false, .depth_factor = 0.1}));
  ASSERT_NE(find(result, "depth-range"), nullptr);
  EXPECT_EQ(find(result, "depth-range")->severity, Severity::warning);
  EXPECT_THAT(find(result, "depth-range")->message,
              HasSubstr("a close-up, or the value of a metre is smaller"));
}

TEST(PlantedFaults, PosesThatAreNotReflected) {
  Recording recording = clean_recording({.camera = small_camera()});  // the IMU is then compared with images
  const Eigen::DiagonalMatrix<double, 3> flip(1, -1, 1);
  for (StampedPose& pose : recording.ground_truth) {
    const Matrix3d rotation = flip * pose.T_world_camera.rotation_matrix() * flip;
    pose.T_world_camera = {Quaterniond(rotation), flip * pose.T_world_camera.translation};
  }
  EXPECT_THAT(faults(inspected(recording)), ElementsAre("truth-not-reflected"));
}

TEST(PlantedFaults, NegativeFocalLength) {
  Recording recording = clean_recording({.imu = false});
  recording.rig.camera.fy_px *= -1;
  EXPECT_THAT(faults(inspected(recording)),
              ::testing::UnorderedElementsAre("focal-length", "truth-not-reflected"));
}

TEST(PlantedFaults, InvertedPoses) {
  Recording recording = clean_recording({.imu = false});
  for (StampedPose& pose : recording.ground_truth) pose.T_world_camera = pose.T_world_camera.inverse();
  EXPECT_THAT(faults(inspected(recording)), ElementsAre("truth-inverted"));
}

TEST(PlantedFaults, QuaternionOrder) {
  Recording recording = clean_recording({.imu = false});
  for (StampedPose& pose : recording.ground_truth) {
    Quaterniond& q = pose.T_world_camera.rotation;
    q = Quaterniond(q.z(), q.w(), q.x(), q.y());  // columns w x y z read as x y z w
  }
  EXPECT_THAT(faults(inspected(recording)), ElementsAre("truth-quaternion-order"));
}

TEST(PlantedFaults, TruthShiftedByOneRow) {
  Recording recording = clean_recording({.truth = false, .imu = false});
  for (std::size_t k = 0; k + 1 < recording.frames.size(); ++k) {
    const double t = 1e-9 * static_cast<double>(recording.frames[k].capture_ns);
    recording.ground_truth.push_back({recording.frames[k + 1].capture_ns, SwayingMotion::T_world_camera(t)});
  }
  const Inspection result = inspected(recording);
  EXPECT_THAT(faults(result), ElementsAre("truth-time-offset"));
  EXPECT_THAT(find(result, "truth-time-offset")->hint, HasSubstr("index"));
}

TEST(PlantedFaults, FocalLength) {
  Recording recording = clean_recording({.imu = false});
  recording.rig.camera.fx_px *= 1.1;
  recording.rig.camera.fy_px *= 1.1;
  EXPECT_THAT(faults(inspected(recording)), ElementsAre("focal-length"));
}

TEST(PlantedFaults, TruthOfAnotherRecording) {
  Recording recording = clean_recording({.imu = false});
  for (StampedPose& pose : recording.ground_truth) {
    pose.T_world_camera =
        SwayingMotion::T_world_camera(100 - 1.3e-9 * static_cast<double>(pose.timestamp_ns));
  }
  EXPECT_THAT(faults(inspected(recording)), ElementsAre("truth-inconsistent"));
}

/// A truth that nobody measured: 7 degrees and 2 cm, at other frequencies than those of the motion.
void invent_truth(Recording& recording) {
  for (StampedPose& pose : recording.ground_truth) {
    const double t = 1e-9 * static_cast<double>(pose.timestamp_ns);
    pose.T_world_camera = {
        so3_exp(radians(7) * Vector3d(std::sin(4.7 * t), std::sin(5.3 * t + 1), std::sin(1.3 * t + 2))),
        0.02 * Vector3d(std::sin(4.4 * t), std::cos(1.1 * t), std::sin(3.3 * t))};
  }
}

TEST(PlantedFaults, AnInventedTruth) {
  Recording recording = clean_recording({.imu = false});
  invent_truth(recording);
  const Inspection result = inspected(recording);
  EXPECT_THAT(faults(result), ElementsAre("truth-inconsistent")) << result.reprojection->static_factor;
}

TEST(PlantedFaults, AFaultOfTheImuDoesNotHideThatOfTheTruth) {
  Recording recording = clean_recording({.camera = small_camera()});
  invent_truth(recording);
  for (ImuSample& sample : recording.imu) sample.specific_force_mps2 /= 9.80665;
  const Inspection result = inspected(recording);
  EXPECT_THAT(faults(result), ::testing::UnorderedElementsAre("accelerometer-unit", "truth-inconsistent"));
  EXPECT_EQ(result.imu_alignment->source, "images");
}

TEST(PlantedFaults, ATruthThatHardlyMovesIsNotBlamed) {
  Recording recording = clean_recording({.imu = false});
  for (StampedPose& pose : recording.ground_truth) {
    const double t = 1e-9 * static_cast<double>(pose.timestamp_ns);
    pose.T_world_camera = {so3_exp({radians(1) * std::sin(3.1 * t), 0, 0}),
                           {0.005 * std::sin(2.3 * t), 0, 0}};
  }
  recording.load_frame = [whole = recording.load_frame, frames = recording.frames](std::size_t k) {
    auto frame = whole(0);
    frame->timestamp_ns = frames[k].timestamp_ns;
    return frame;
  };
  const Inspection result = inspected(recording);
  ASSERT_TRUE(result.reprojection);
  EXPECT_LT(result.reprojection->static_factor, 1);
  EXPECT_THAT(faults(result), Not(Contains("truth-inconsistent")));
}

TEST(PlantedFaults, TheImuIsNotBlamedForTheTruth) {
  Recording recording = clean_recording({.camera = small_camera()});
  invent_truth(recording);
  const Workers workers(2);
  Inspection out;  // without the check that warps frames, which would have found it
  check_frame_stamps(recording, out);
  check_truth_stamps(recording, out);
  check_imu_stamps(recording, out);
  check_imu_alignment(recording, workers, {}, out);
  EXPECT_THAT(faults(out), ElementsAre("truth-inconsistent"));
  ASSERT_TRUE(out.imu_alignment);
  EXPECT_EQ(out.imu_alignment->source, "images");
}

TEST(PlantedFaults, ATurnThatJumpsIsPlaced) {
  Recording recording = clean_recording({.imu = false});
  for (StampedPose& pose : recording.ground_truth) {
    if (pose.timestamp_ns != recording.frames[60].capture_ns) continue;
    pose.T_world_camera.rotation = pose.T_world_camera.rotation * so3_exp({0, 2, 0});
  }
  const Inspection result = inspected(recording);
  ASSERT_NE(find(result, "truth-jump"), nullptr);
  EXPECT_THAT(find(result, "truth-jump")->message,
              AnyOf(HasSubstr("deg/s (frame 59)"), HasSubstr("deg/s (frame 61)")));
}

TEST(PlantedFaults, MillisecondsForMicroseconds) {
  Recording recording = clean_recording();
  for (FrameEntry& frame : recording.frames) {
    for (std::int64_t* stamp :
         {&frame.timestamp_ns, &frame.depth_timestamp_ns, &frame.capture_ns, &frame.depth_capture_ns})
      *stamp *= 1000;
  }
  recording.load_frame = clean_recording().load_frame;
  for (ImuSample& sample : recording.imu) sample.timestamp_ns *= 1000;
  for (StampedPose& pose : recording.ground_truth) pose.timestamp_ns *= 1000;
  const Inspection result = inspected(recording);
  EXPECT_THAT(faults(result), ::testing::IsSupersetOf({"frames-time-unit", "imu-time-unit"}));
  EXPECT_THAT(find(result, "frames-time-unit")->message, HasSubstr("milliseconds"));
}

TEST(PlantedFaults, AnImuInAnotherUnit) {
  Recording recording = clean_recording();
  for (ImuSample& sample : recording.imu) sample.timestamp_ns /= 1000;
  EXPECT_THAT(faults(inspected(recording)), ElementsAre("imu-time-unit"));
}

TEST(PlantedFaults, AGapIsPlaced) {
  Recording recording = clean_recording();
  const auto whole = recording.load_frame;
  recording.frames.erase(recording.frames.begin() + 40, recording.frames.begin() + 50);
  recording.load_frame = [whole](std::size_t k) { return whole(k < 40 ? k : k + 10); };
  const Inspection result = inspected(recording);
  EXPECT_THAT(faults(result), ElementsAre("frames-gap"));
  EXPECT_THAT(find(result, "frames-gap")->message, HasSubstr("10 frames missing"));
  EXPECT_THAT(find(result, "frames-gap")->message, HasSubstr("after frame 39 at 1.30 s"));
}

TEST(PlantedFaults, AGapOfTheImu) {
  Recording recording = clean_recording();
  recording.imu.erase(recording.imu.begin() + 200, recording.imu.begin() + 230);
  EXPECT_THAT(faults(inspected(recording)), ElementsAre("imu-gap"));
}

TEST(PlantedFaults, ADuplicate) {
  Recording recording = clean_recording();
  const auto whole = recording.load_frame;
  recording.frames.insert(recording.frames.begin() + 30, recording.frames[30]);
  recording.load_frame = [whole](std::size_t k) { return whole(k <= 30 ? k : k - 1); };
  const Inspection result = inspected(recording);
  EXPECT_THAT(faults(result), Contains("frames-duplicate-stamp"));
  EXPECT_THAT(find(result, "frames-duplicate-stamp")->message, HasSubstr("frame 31"));
}

TEST(PlantedFaults, ADuplicateOfTheImu) {
  Recording recording = clean_recording();
  recording.imu.insert(recording.imu.begin() + 30, recording.imu[30]);
  EXPECT_THAT(faults(inspected(recording)), ElementsAre("imu-duplicate-stamp"));
}

TEST(PlantedFaults, GyroscopeInDegrees) {
  Recording recording = clean_recording();
  for (ImuSample& sample : recording.imu) sample.angular_velocity_radps *= 180 / M_PI;
  EXPECT_THAT(faults(inspected(recording)), ElementsAre("gyroscope-unit"));
}

TEST(PlantedFaults, AccelerometerInUnitsOfGravity) {
  Recording recording = clean_recording();
  for (ImuSample& sample : recording.imu) sample.specific_force_mps2 /= 9.80665;
  EXPECT_THAT(faults(inspected(recording)), ElementsAre("accelerometer-unit"));
}

TEST(PlantedFaults, AccelerometerWithTheWrongSign) {
  Recording recording = clean_recording();
  for (ImuSample& sample : recording.imu) sample.specific_force_mps2 *= -1;
  EXPECT_THAT(faults(inspected(recording)), ElementsAre("accelerometer-sign"));
}

TEST(PlantedFaults, GyroscopeAtTheEndOfItsRange) {
  Recording recording = clean_recording();
  for (ImuSample& sample : recording.imu) {
    sample.angular_velocity_radps *= 10;
    sample.angular_velocity_radps.x() = std::clamp(sample.angular_velocity_radps.x(), -2.2, 2.2);
  }
  EXPECT_THAT(faults(inspected(recording)), Contains("gyroscope-saturated"));
}

TEST(PlantedFaults, AnotherRecordingsImu) {
  Recording recording = clean_recording();
  for (std::size_t i = 0; i < recording.imu.size(); ++i) {
    const double t = 0.005 * static_cast<double>(i);
    recording.imu[i].angular_velocity_radps = {std::sin(5.3 * t), 0.7 * std::sin(4.1 * t + 1),
                                               0.5 * std::cos(6.1 * t)};
  }
  EXPECT_THAT(faults(inspected(recording)), Contains("imu-unrelated"));
}

TEST(PlantedFaults, AnImageThatComesAgain) {
  Recording recording = clean_recording();
  recording.load_frame = [whole = recording.load_frame](std::size_t k) {
    auto frame = whole(k == 50 ? 49 : k);
    frame->timestamp_ns = whole(k)->timestamp_ns;
    return frame;
  };
  const Inspection result = inspected(recording);
  EXPECT_THAT(faults(result), ElementsAre("frames-duplicate-image", "depth-frozen"));
  EXPECT_THAT(find(result, "frames-duplicate-image")->message, HasSubstr("frame 50"));
}

void shift_depth(Recording& recording, int shift_px) {
  recording.load_frame = [whole = recording.load_frame, shift_px](std::size_t k) {
    auto frame = whole(k);
    DepthImage shifted(frame->depth_m.width, frame->depth_m.height);
    for (int y = 0; y < shifted.height; ++y) {
      for (int x = shift_px; x < shifted.width; ++x) shifted(x, y) = frame->depth_m(x - shift_px, y);
    }
    frame->depth_m = shifted;
    return frame;
  };
}

TEST(PlantedFaults, DepthThatIsNotRegistered) {
  Recording recording = clean_recording({.camera = small_camera(), .truth = false, .imu = false});
  EXPECT_THAT(faults(inspected(recording)), IsEmpty());
  const double cx_px = recording.rig.camera.cx_px;
  shift_depth(recording, 16);
  const Inspection result = inspected(recording);
  EXPECT_THAT(faults(result), ElementsAre("depth-misregistered"));
  ASSERT_TRUE(result.registration);
  EXPECT_NEAR(result.registration->moved_px, 16, 2);
  EXPECT_NEAR(result.registration->fitted.pinhole.cx_px, cx_px + 16, 4);
}

TEST(PlantedFaults, APartOfARecording) {
  const Workers workers(1);
  InspectOptions options;
  options.expected_frames = 100;
  EXPECT_THAT(faults(inspect(clean_recording({.imu = false}), workers, options)),
              ElementsAre("frames-incomplete"));
}

TEST(PlantedFaults, SeveralAtOnceAreAllFound) {
  Recording recording = clean_recording({.depth_factor = 5});
  for (StampedPose& pose : recording.ground_truth) pose.T_world_camera = pose.T_world_camera.inverse();
  for (ImuSample& sample : recording.imu) sample.timestamp_ns += 20 * kMillisecond_ns;
  EXPECT_THAT(faults(inspected(recording)), ::testing::IsSupersetOf({"truth-inverted", "depth-scale"}));
}

}  // namespace
}  // namespace fusebench::testing
