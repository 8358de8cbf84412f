// Axes, signs and units of gyroscope and accelerometer, each sensor on its own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "datasets/inspection/checks.hpp"
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
using ::testing::UnorderedElementsAre;

Matrix3d cycled() {  // (x, y, z) hold (z, x, y)
  Matrix3d axes;
  axes << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  return axes;
}

Matrix3d half_turn() { return Vector3d(-1, -1, 1).asDiagonal(); }

void change_gyroscope(Recording& recording, const Matrix3d& axes) {
  for (ImuSample& sample : recording.imu)
    sample.angular_velocity_radps = axes * sample.angular_velocity_radps;
}
void change_accelerometer(Recording& recording, const Matrix3d& axes) {
  for (ImuSample& sample : recording.imu) sample.specific_force_mps2 = axes * sample.specific_force_mps2;
}

/// With ground truth; without it, the images take its place.
class ImuAxes : public ::testing::TestWithParam<bool> {
 protected:
  [[nodiscard]] static Recording recording() {
    CleanOptions options;
    options.truth = GetParam();
    if (!options.truth) options.camera = small_camera();
    return clean_recording(options);
  }
};
INSTANTIATE_TEST_SUITE_P(WithAndWithoutTruth, ImuAxes, ::testing::Values(true, false));

TEST_P(ImuAxes, OfBothAreNamedOnce) {
  Recording recording = ImuAxes::recording();
  change_gyroscope(recording, cycled());
  change_accelerometer(recording, cycled());
  const Inspection result = inspected(recording);
  ASSERT_THAT(faults(result), ElementsAre("imu-axes-swapped"));
  EXPECT_THAT(find(result, "imu-axes-swapped")->message, HasSubstr("(z, x, y)"));
  EXPECT_THAT(find(result, "imu-axes-swapped")->hint, HasSubstr("(y, z, x)"));
}

TEST_P(ImuAxes, OfTheGyroscopeAlone) {
  Recording recording = ImuAxes::recording();
  change_gyroscope(recording, cycled());
  const Inspection result = inspected(recording);
  ASSERT_THAT(faults(result), ElementsAre("gyroscope-axes"));
  EXPECT_THAT(find(result, "gyroscope-axes")->message, HasSubstr("(z, x, y)"));
}

TEST_P(ImuAxes, OfTheAccelerometerAlone) {
  Recording recording = ImuAxes::recording();
  change_accelerometer(recording, cycled());
  const Inspection result = inspected(recording);
  ASSERT_THAT(faults(result), ElementsAre("accelerometer-axes"));
  EXPECT_THAT(find(result, "accelerometer-axes")->message, HasSubstr("(z, x, y)"));
}

TEST_P(ImuAxes, OfTheAccelerometerAloneTurnedByHalfARevolution) {
  Recording recording = ImuAxes::recording();
  change_accelerometer(recording, half_turn());
  EXPECT_THAT(faults(inspected(recording)), ElementsAre("accelerometer-axes"));
}

TEST_P(ImuAxes, ThatAreRightHaveNoFinding) { EXPECT_THAT(faults(inspected(recording())), IsEmpty()); }

TEST(ImuAxesByTruth, MirroredGyroscopeAlone) {
  Recording recording = clean_recording();
  change_gyroscope(recording, Vector3d(1, 1, -1).asDiagonal());
  const Inspection result = inspected(recording);
  ASSERT_THAT(faults(result), ElementsAre("gyroscope-axes"));
  EXPECT_THAT(find(result, "gyroscope-axes")->message, HasSubstr("(x, y, -z)"));
}

TEST(ImuAxesByTruth, MirroredAccelerometerAlone) {
  Recording recording = clean_recording();
  change_accelerometer(recording, Vector3d(1, 1, -1).asDiagonal());
  const Inspection result = inspected(recording);
  ASSERT_THAT(faults(result), ElementsAre("accelerometer-axes"));
  EXPECT_THAT(find(result, "accelerometer-axes")->message, HasSubstr("(x, y, -z)"));
}

TEST(ImuAxesByTruth, OfANoisyGyroscopeAreFoundAlthoughTheRotationIsUncertain) {
  Recording recording = clean_recording();
  std::mt19937 random(3);
  std::normal_distribution<double> noise_radps(0, 0.5);
  for (ImuSample& sample : recording.imu) {
    for (double& rate_radps : sample.angular_velocity_radps) rate_radps += noise_radps(random);
    sample.angular_velocity_radps = cycled() * sample.angular_velocity_radps;
    sample.specific_force_mps2 = cycled() * sample.specific_force_mps2;
  }
  EXPECT_THAT(faults(inspected(recording)), Contains("imu-axes-swapped"));
}

TEST(ImuAxesByTruth, ARotationThatIsNoExchangeIsRefusedWhenItIsFar) {
  Recording recording = clean_recording();
  recording.rig.T_imu_camera.rotation =
      recording.rig.T_imu_camera.rotation * so3_exp(radians(45) * Vector3d(0.6, 0.8, 0));
  EXPECT_THAT(faults(inspected(recording)), ElementsAre("imu-axes-swapped"));
}

struct UnitFault {
  double factor;
  const char* text;
};
class GyroscopeUnits : public ::testing::TestWithParam<UnitFault> {};

TEST_P(GyroscopeUnits, AreNamed) {
  Recording recording = clean_recording();
  for (ImuSample& sample : recording.imu) sample.angular_velocity_radps *= GetParam().factor;
  const Inspection result = inspected(recording);
  ASSERT_THAT(faults(result), Contains("gyroscope-unit"));
  EXPECT_THAT(faults(result), Not(Contains("imu-unrelated")));
  EXPECT_THAT(find(result, "gyroscope-unit")->message, HasSubstr(GetParam().text));
}
INSTANTIATE_TEST_SUITE_P(Each, GyroscopeUnits,
                         ::testing::Values(UnitFault{180 / M_PI, "degrees per second"},
                                           UnitFault{M_PI / 180, "from degrees twice"},
                                           UnitFault{1000, "milliradians"}, UnitFault{3.3, "not in rad/s"}));

TEST(GyroscopeUnit, OfTurnsThatWouldExceedARevolution) {
  // Read as rad/s, 150 deg/s between poses 50 ms apart turn by more than half a revolution.
  Recording recording = clean_recording();
  for (std::size_t i = 0; i < recording.ground_truth.size(); ++i) {
    StampedPose& pose = recording.ground_truth[i];
    const double t = 1e-9 * static_cast<double>(pose.timestamp_ns);
    pose.T_world_camera.rotation =
        so3_exp({0, 1.3 * std::sin(2 * t), 0}) * so3_exp({std::sin(2.6 * t), 0, 0});
  }
  recording.imu.clear();
  for (std::size_t i = 0; i + 1 < recording.ground_truth.size(); ++i) {
    const StampedPose& now = recording.ground_truth[i];
    const StampedPose& next = recording.ground_truth[i + 1];
    const double dt_s = seconds_between(now.timestamp_ns, next.timestamp_ns);
    const Quaterniond turn = now.T_world_camera.rotation.conjugate() * next.T_world_camera.rotation;
    const Vector3d rate_radps = so3_log(turn.normalized()) / dt_s;
    recording.imu.push_back({now.timestamp_ns + std::llround(0.5e9 * dt_s),
                             recording.rig.T_imu_camera.rotation * (180 / M_PI * rate_radps),
                             {0, -kGravity_mps2, 0}});
  }
  const Workers workers(2);
  Inspection out;  // without the images, which are those of the other motion
  check_frame_stamps(recording, out);
  check_truth_stamps(recording, out);
  check_imu_stamps(recording, out);
  check_imu_alignment(recording, workers, {}, out);
  EXPECT_THAT(faults(out), ElementsAre("gyroscope-unit"));
}

TEST(AccelerometerUnit, InUnitsOfGravityWithTheWrongSignHasBothFaults) {
  Recording recording = clean_recording();
  for (ImuSample& sample : recording.imu) sample.specific_force_mps2 /= -9.80665;
  EXPECT_THAT(faults(inspected(recording)), UnorderedElementsAre("accelerometer-unit", "accelerometer-sign"));
}

TEST(AccelerometerUnit, InThousandthsOfGravity) {
  Recording recording = clean_recording();
  for (ImuSample& sample : recording.imu) sample.specific_force_mps2 *= 1000 / 9.80665;
  const Inspection result = inspected(recording);
  ASSERT_THAT(faults(result), Contains("accelerometer-unit"));
  EXPECT_THAT(find(result, "accelerometer-unit")->message, HasSubstr("thousandths"));
}

}  // namespace
}  // namespace fusebench::testing
