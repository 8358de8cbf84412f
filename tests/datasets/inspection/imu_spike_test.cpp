// Single samples of an IMU that are no measurement: named, and without influence on what else is said.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/trajectory/trajectory_file.hpp"
#include "datasets/inspection/measures/imu_faults.hpp"
#include "tests/datasets/inspection/clean_recording.hpp"

namespace fusebench::testing {

using namespace trajectory;
using namespace recording;
using namespace inspection::measures;
using namespace inspection;

namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class ImuSpike : public ::testing::TestWithParam<bool> {
 protected:
  static Recording clean() {
    CleanOptions options;
    options.truth = GetParam();
    if (!options.truth) options.camera = small_camera();
    return clean_recording(options);
  }
};

TEST_P(ImuSpike, IsNamedAndLeavesTheRestAsItIs) {
  Recording recording = clean();
  const Inspection clean = inspected(recording);
  for (const double spike_radps : {100.0, -7.0}) {
    SCOPED_TRACE(spike_radps);
    Recording spiked = recording;
    spiked.imu[330].angular_velocity_radps.y() = spike_radps;
    const Inspection result = inspected(spiked);
    ASSERT_THAT(faults(result), ElementsAre("imu-spike"));
    EXPECT_THAT(find(result, "imu-spike")->message,
                AllOf(HasSubstr(fmt::format("the gyroscope's y reads {:.4g} rad/s at {} (sample 330)",
                                            spike_radps, stamp_text(spiked.imu[330].timestamp_ns))),
                      HasSubstr(fmt::format("1 of {} samples", spiked.imu.size()))));
    ASSERT_TRUE(result.imu_alignment);
    EXPECT_NEAR(result.imu_alignment->time_offset_s, clean.imu_alignment->time_offset_s, 0.0005);
    EXPECT_NEAR(result.imu_alignment->scale, clean.imu_alignment->scale, 0.005);
    EXPECT_LT(result.imu->gyroscope_max_radps, 5);
  }
}

TEST_P(ImuSpike, DoesNotHideATrueOffset) {
  Recording recording = clean();
  for (ImuSample& sample : recording.imu) sample.timestamp_ns += 20'000'000;
  recording.imu[200].angular_velocity_radps.x() = 100;
  recording.imu[201].angular_velocity_radps.x() = 90;
  recording.imu[400].specific_force_mps2.z() = -500;
  const Inspection result = inspected(recording);
  EXPECT_THAT(faults(result), ElementsAre("imu-time-offset", "imu-spike"));
  EXPECT_NEAR(result.imu_alignment->time_offset_s, 0.020, GetParam() ? 0.001 : 0.002);
  EXPECT_THAT(find(result, "imu-spike")->message,
              AllOf(HasSubstr("3 of "), HasSubstr("the accelerometer's z reads -500 m/s^2"),
                    HasSubstr("(sample 400)")));
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutTruth, ImuSpike, ::testing::Bool());

TEST(ImuFaults, ARunThatIsTooLongToBeASpikeDoesNotDecideTheOffset) {
  Recording recording = clean_recording();
  for (std::size_t i = 300; i < 308; ++i) recording.imu[i].angular_velocity_radps.x() += 40;
  const Inspection result = inspected(recording);
  ASSERT_TRUE(result.imu_alignment);
  EXPECT_NEAR(result.imu_alignment->time_offset_s, 0, 0.004);
  EXPECT_THAT(faults(result), Not(Contains("imu-time-offset")));
}

TEST(ImuFaults, AFastMotionHasNoSpikes) {
  const auto samples = ideal_samples({so3_exp({0.02, -0.03, 0.015}), {0.09, 0.003, 0.002}}, 10, 13, 50);
  std::vector<ImuSample> fast = samples;
  for (ImuSample& sample : fast) sample.angular_velocity_radps *= 40;  // up to 40 rad/s, 50 Hz
  double fastest_radps = 0;
  for (const ImuSample& sample : fast)
    fastest_radps = std::max(fastest_radps, sample.angular_velocity_radps.cwiseAbs().maxCoeff());
  ASSERT_GT(fastest_radps, 20);
  EXPECT_THAT(find_imu_faults(fast), IsEmpty());
  for (const double frequency_hz : {1.0, 3.0, 8.0, 14.0, 20.0}) {  // a shaken sensor, after rest
    for (std::size_t i = 0; i < fast.size(); ++i) {
      const double phase = i < 50 ? 0 : 2 * M_PI * frequency_hz * 0.02 * static_cast<double>(i - 50);
      fast[i].angular_velocity_radps = Vector3d(15 * std::sin(phase), 0, 0);
    }
    EXPECT_THAT(find_imu_faults(fast), IsEmpty()) << frequency_hz;
  }
}

}  // namespace
}  // namespace fusebench::testing
