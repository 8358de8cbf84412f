#include "core/recording_start.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/config/groups/prediction_config.hpp"

namespace fusebench {

using namespace filter;
using namespace health;
using namespace core;

namespace {

/// Says what it is asked for, and finds a velocity in the second frame.
class ScriptedEstimator final : public RestartableEstimator {
 public:
  Result<FrameReport> process_frame(const RgbdFrame& frame) override {
    calls.push_back(std::to_string(frame.timestamp_ns));
    FrameReport report = report_of(frame);
    const bool dark = frame.grey.empty();
    report.health = dark ? FrameHealth::dark : FrameHealth::good;
    if (!state_) {
      report.status = FrameStatus::initialised;
    } else {
      report.status = dark || !tracks ? FrameStatus::lost : FrameStatus::tracked;
    }
    report.stages.add({Stage::predict, {}});
    state_ = GaussianState{};
    state_->mean.velocity_world_mps.x() = static_cast<double>(frame.timestamp_ns);
    return report;
  }
  const std::optional<GaussianState>& estimate() const override { return state_; }
  void restart(const std::optional<FilterState>& motion) override {
    calls.push_back(motion ? "restart at " + std::to_string(std::lround(motion->velocity_world_mps.x()))
                           : "restart");
    tracks = tracks && tracks_after_restart;
    state_.reset();
  }

  std::vector<std::string> calls;
  bool tracks = true;  ///< frames after the first one
  bool tracks_after_restart = true;

 private:
  std::optional<GaussianState> state_;
};

RgbdFrame frame_at(std::int64_t timestamp_ns, bool dark = false) {
  RgbdFrame frame;
  frame.timestamp_ns = timestamp_ns;
  if (!dark) frame.grey = GreyImage(1, 1);
  return frame;
}

constexpr config::InitialisationConfig kDefaults{};

using Calls = std::vector<std::string>;

TEST(RecordingStart, TheFirstTwoFramesAreProcessedAgainWithTheVelocityOfTheSecond) {
  ScriptedEstimator estimator;
  RecordingStart start(kDefaults);
  EXPECT_EQ(start.process(frame_at(1), estimator)->status, FrameStatus::initialised);
  const auto second = start.process(frame_at(2), estimator);
  EXPECT_EQ(second->status, FrameStatus::tracked);
  EXPECT_EQ(second->timestamp_ns, 2);
  EXPECT_EQ(second->stages.spans().size(), 3U) << "its time is that of all of it";
  EXPECT_EQ(start.process(frame_at(3), estimator)->stages.spans().size(), 1U);
  EXPECT_EQ(estimator.calls, (Calls{"1", "2", "restart at 2", "1", "2", "3"}));
}

TEST(RecordingStart, ALostSecondFrameTellsNoVelocity) {
  ScriptedEstimator estimator;
  RecordingStart start(kDefaults);
  ASSERT_TRUE(start.process(frame_at(1), estimator));
  EXPECT_EQ(start.process(frame_at(2, true), estimator)->status, FrameStatus::lost);
  EXPECT_EQ(start.process(frame_at(3), estimator)->status, FrameStatus::tracked);
  EXPECT_EQ(estimator.calls, (Calls{"1", "2", "3"}));
}

TEST(RecordingStart, WaitsForAFrameThatCanBeTheFirst) {
  ScriptedEstimator estimator;
  RecordingStart start(kDefaults);
  for (const std::int64_t dark : {1, 2}) {
    const auto report = start.process(frame_at(dark, true), estimator);
    EXPECT_EQ(report->status, FrameStatus::lost);
    EXPECT_EQ(report->reason, "waiting for a usable first frame: dark");
  }
  EXPECT_EQ(start.process(frame_at(3), estimator)->status, FrameStatus::initialised);
  EXPECT_EQ(start.process(frame_at(4), estimator)->status, FrameStatus::tracked);
  EXPECT_EQ(estimator.calls, (Calls{"1", "restart", "2", "restart", "3", "4", "restart at 4", "3", "4"}));
}

TEST(RecordingStart, StartsAgainWhereNothingIsTrackedFromTheFirstFrame) {
  ScriptedEstimator estimator;
  estimator.tracks = false;
  RecordingStart start(kDefaults);
  for (const std::int64_t t : {1, 2, 3, 4, 5}) ASSERT_TRUE(start.process(frame_at(t), estimator));
  estimator.calls.clear();
  const auto again = start.process(frame_at(6), estimator);
  EXPECT_EQ(again->status, FrameStatus::initialised);
  EXPECT_NE(again->reason.find("started again"), std::string::npos);
  estimator.tracks = true;
  EXPECT_EQ(start.process(frame_at(7), estimator)->status, FrameStatus::tracked);
  EXPECT_EQ(estimator.calls, (Calls{"6", "restart", "6", "7", "restart at 7", "6", "7"}));
}

TEST(RecordingStart, HowManyLostFramesMakeAFalseStartIsAnOption) {
  for (const int frames : {1, 3, 8}) {
    ScriptedEstimator estimator;
    estimator.tracks = false;
    const config::InitialisationConfig config{.false_start_frames = frames};
    RecordingStart start(config);
    ASSERT_TRUE(start.process(frame_at(1), estimator));
    for (int lost = 1; lost < frames; ++lost)
      EXPECT_EQ(start.process(frame_at(1 + lost), estimator)->status, FrameStatus::lost) << lost;
    EXPECT_EQ(start.process(frame_at(1 + frames), estimator)->status, FrameStatus::initialised) << frames;
  }
}

TEST(RecordingStart, KeepsTheFirstFrameWhileNothingCanBeSeenAndOnceFramesWereTracked) {
  ScriptedEstimator estimator;
  RecordingStart start(kDefaults);
  ASSERT_TRUE(start.process(frame_at(1), estimator));
  for (std::int64_t t = 2; t < 20; ++t)
    EXPECT_EQ(start.process(frame_at(t, true), estimator)->status, FrameStatus::lost) << t;
  for (std::int64_t t = 20; t < 25; ++t)
    EXPECT_EQ(start.process(frame_at(t), estimator)->status, FrameStatus::tracked) << t;
  estimator.tracks = false;
  for (std::int64_t t = 25; t < 40; ++t)
    EXPECT_EQ(start.process(frame_at(t), estimator)->status, FrameStatus::lost) << t;
  EXPECT_EQ(std::ranges::count(estimator.calls, "restart"), 0);
}

TEST(RecordingStart, StartsAgainWhereHardlyAFrameIsTrackedFromTheFirstOne) {
  ScriptedEstimator estimator;
  RecordingStart start(kDefaults);
  for (std::int64_t t = 1; t <= 5; ++t) ASSERT_TRUE(start.process(frame_at(t), estimator));
  estimator.tracks = false;
  for (std::int64_t t = 6; t < 10; ++t)
    EXPECT_EQ(start.process(frame_at(t), estimator)->status, FrameStatus::lost) << t;
  EXPECT_EQ(start.process(frame_at(10), estimator)->status, FrameStatus::initialised);
}

/// With the velocity of the second frame, the second frame is lost: the first time it was tracked by chance.
TEST(RecordingStart, AStartThatIsLostWhenItIsProcessedAgainIsNone) {
  ScriptedEstimator estimator;
  RecordingStart start(kDefaults);
  ASSERT_TRUE(start.process(frame_at(1), estimator));
  estimator.tracks_after_restart = false;
  EXPECT_EQ(start.process(frame_at(2), estimator)->status, FrameStatus::lost);
  for (std::int64_t t = 3; t < 6; ++t)
    EXPECT_EQ(start.process(frame_at(t), estimator)->status, FrameStatus::lost) << t;
  EXPECT_EQ(start.process(frame_at(6), estimator)->status, FrameStatus::initialised);
}

}  // namespace
}  // namespace fusebench
