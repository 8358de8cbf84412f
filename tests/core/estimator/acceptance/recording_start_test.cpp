#include "core/estimator/acceptance/recording_start.hpp"

#include <gtest/gtest.h>

#include "core/config/groups/prediction_config.hpp"

namespace fusebench {

using namespace health;
using namespace acceptance;

namespace {

constexpr config::InitialisationConfig kDefaults{};

FrameReport report_with(FrameStatus status, FrameHealth health = FrameHealth::good) {
  FrameReport report;
  report.status = status;
  report.health = health;
  return report;
}
const FrameReport kFirst = report_with(FrameStatus::initialised);
const FrameReport kTracked = report_with(FrameStatus::tracked);
const FrameReport kLost = report_with(FrameStatus::lost);
const FrameReport kDark = report_with(FrameStatus::lost, FrameHealth::dark);

TEST(RecordingStart, TheFirstTwoFramesAreProcessedAgainOnce) {
  RecordingStart start(kDefaults);
  EXPECT_EQ(start.judge(kFirst), StartAction::go_on);
  EXPECT_EQ(start.judge(kTracked), StartAction::start_again);
  EXPECT_EQ(start.judge(kTracked), StartAction::go_on) << "the second frame, processed again";
  EXPECT_EQ(start.judge(kTracked), StartAction::go_on);
}

TEST(RecordingStart, ALostSecondFrameGivesNoVelocity) {
  RecordingStart start(kDefaults);
  ASSERT_EQ(start.judge(kFirst), StartAction::go_on);
  EXPECT_EQ(start.judge(kDark), StartAction::go_on);
  EXPECT_EQ(start.judge(kTracked), StartAction::go_on);
}

TEST(RecordingStart, WaitsForAFrameThatCanBeTheFirst) {
  RecordingStart start(kDefaults);
  const FrameReport dark = report_with(FrameStatus::initialised, FrameHealth::dark);
  EXPECT_EQ(start.judge(dark), StartAction::wait);
  EXPECT_EQ(start.judge(dark), StartAction::wait);
  EXPECT_EQ(start.judge(kFirst), StartAction::go_on);
  EXPECT_EQ(start.judge(kTracked), StartAction::start_again);
}

TEST(RecordingStart, StartsAgainAfterSoManyLostFrames) {
  for (const int frames : {1, 3, 8}) {
    const config::InitialisationConfig config{.false_start_frames = frames};
    RecordingStart start(config);
    ASSERT_EQ(start.judge(kFirst), StartAction::go_on);
    for (int lost = 1; lost < frames; ++lost) EXPECT_EQ(start.judge(kLost), StartAction::go_on) << lost;
    EXPECT_EQ(start.judge(kLost), StartAction::start_here) << frames;
    EXPECT_EQ(start.judge(kFirst), StartAction::go_on) << "the frame itself, as the first one";
    EXPECT_EQ(start.judge(kTracked), StartAction::start_again);
  }
}

TEST(RecordingStart, StartsAgainWhereHardlyAFrameIsTrackedFromTheFirstOne) {
  RecordingStart start(kDefaults);
  ASSERT_EQ(start.judge(kFirst), StartAction::go_on);
  ASSERT_EQ(start.judge(kTracked), StartAction::start_again);
  for (int tracked = 0; tracked < 4; ++tracked) ASSERT_EQ(start.judge(kTracked), StartAction::go_on);
  for (int lost = 1; lost < 5; ++lost) EXPECT_EQ(start.judge(kLost), StartAction::go_on) << lost;
  EXPECT_EQ(start.judge(kLost), StartAction::start_here);
}

TEST(RecordingStart, KeepsTheFirstFrameWhileNothingCanBeSeenAndOnceFramesWereTracked) {
  RecordingStart start(kDefaults);
  ASSERT_EQ(start.judge(kFirst), StartAction::go_on);
  for (int dark = 0; dark < 20; ++dark) EXPECT_EQ(start.judge(kDark), StartAction::go_on) << dark;
  for (int tracked = 0; tracked < 5; ++tracked) ASSERT_EQ(start.judge(kTracked), StartAction::go_on);
  for (int lost = 0; lost < 20; ++lost) EXPECT_EQ(start.judge(kLost), StartAction::go_on) << lost;
}

/// With the velocity of the second frame, the second frame is lost: the first time it was tracked by chance.
TEST(RecordingStart, RejectsAStartThatIsLostWhenItIsProcessedAgain) {
  RecordingStart start(kDefaults);
  ASSERT_EQ(start.judge(kFirst), StartAction::go_on);
  ASSERT_EQ(start.judge(kTracked), StartAction::start_again);
  for (int lost = 1; lost < 5; ++lost) EXPECT_EQ(start.judge(kLost), StartAction::go_on) << lost;
  EXPECT_EQ(start.judge(kLost), StartAction::start_here);
}

}  // namespace
}  // namespace fusebench
