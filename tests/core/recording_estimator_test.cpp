#include "core/recording_estimator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/base/solvers.hpp"
#include "tests/support/simulated_run.hpp"

namespace fusebench {

using namespace config;
using namespace health;
using namespace core;

namespace {

using testing::config_of;
using testing::simulate;
using testing::SimulatedRun;
using testing::track;
using testing::worst_error_m;

/// The light of a frame, times a factor; the response of the camera has a gamma of 2.2.
void expose(RgbdFrame& frame, double factor) {
  const double scale = std::pow(factor, 1 / 2.2);
  for (std::uint8_t& grey : frame.grey.data)
    grey = static_cast<std::uint8_t>(std::min(255.0, std::round(scale * grey)));
}

TEST(RecordingEstimator, FollowsAnExposureThatChangesByAFactorOfFourInFiveFrames) {
  for (const double factor : {4.0, 0.25}) {
    SimulatedRun run = simulate(14);
    for (std::size_t k = 4; k < run.frames.size(); ++k)
      expose(run.frames[k], std::pow(factor, std::min(1.0, static_cast<double>(k - 3) / 5)));
    for (const char* const variant : {"full", "no-imu"}) {
      const std::vector<FrameReport> reports = track(run, config_of(variant));
      EXPECT_TRUE(std::ranges::all_of(reports, [](const FrameReport& r) { return is_in_map(r.status); }))
          << variant << ", " << factor;
      EXPECT_LT(worst_error_m(run, reports), 0.01) << variant << ", " << factor;
    }
  }
}

/// A view of the room, darkness, and another view.
class TwoViews : public ::testing::Test {
 protected:
  static constexpr std::size_t kSeen = 10, kDark = 18, kOther = 12;

  TwoViews() : run_(simulate(kSeen)), other_(simulate(kOther, {}, {-0.2, 0.4, 0.5})) {
    for (RgbdFrame& frame : other_.frames) turn_upside_down(frame);
    append(run_.frames);
    append_darkness();
    append(other_.frames);
  }

  void append(const std::vector<RgbdFrame>& frames) {
    for (const RgbdFrame& frame : frames) {
      frames_.push_back(frame);
      frames_.back().timestamp_ns =
          1'000'000'000 +
          static_cast<std::int64_t>(std::llround(1e9 * static_cast<double>(frames_.size()) / 30));
    }
  }
  void append_darkness() {
    std::vector<RgbdFrame> dark(kDark, run_.frames.front());
    for (RgbdFrame& frame : dark) {
      std::ranges::fill(frame.grey.data, std::uint8_t{0});
      std::ranges::fill(frame.depth_m.data, 0.0F);
    }
    append(dark);
  }

  std::vector<FrameReport> process(RecordingEstimator& estimator) const {
    std::vector<FrameReport> reports;
    for (const RgbdFrame& frame : frames_) {
      auto report = estimator.process(frame);
      EXPECT_TRUE(report.has_value());
      reports.push_back(std::move(*report));
    }
    return reports;
  }

  SimulatedRun run_, other_;
  std::vector<RgbdFrame> frames_;

 private:
  /// Features of a scene that is upside down match nothing.
  static void turn_upside_down(RgbdFrame& frame) {
    std::ranges::reverse(frame.grey.data);
    std::ranges::reverse(frame.depth_m.data);
    std::ranges::reverse(frame.color.data);
  }
};

TEST_F(TwoViews, AStoredPlaceJoinsTheSegmentOfALostCameraToTheMap) {
  append(run_.frames);
  const Workers workers(1);
  RecordingEstimator estimator(config_of("no-imu"), run_.rig, {}, workers, testing::replay_of(frames_));
  const std::vector<FrameReport> reports = process(estimator);
  ASSERT_EQ(reports.size(), frames_.size());
  const auto status = [&](std::size_t frame) { return reports[frame].status; };
  EXPECT_EQ(status(kSeen - 1), FrameStatus::tracked);
  EXPECT_EQ(status(kSeen + kDark - 1), FrameStatus::lost);
  const std::size_t begin = kSeen + kDark;
  for (std::size_t k = begin; k < begin + kOther; ++k) {
    EXPECT_EQ(status(k), FrameStatus::other_segment) << k;
    EXPECT_EQ(reports[k].segment, 1U) << k;
  }
  const std::size_t joined = begin + kOther;
  EXPECT_EQ(status(joined), FrameStatus::relocalised);
  EXPECT_EQ(reports[joined].joined_segment, 1U);
  EXPECT_EQ(status(frames_.size() - 1), FrameStatus::tracked);

  const auto revised = estimator.revise();
  ASSERT_TRUE(revised.has_value() && revised->has_value());
  EXPECT_EQ((*revised)->size(), frames_.size() - kDark) << "of the map and of the segment";
  // The segment moves rigidly, and its motion is that of the camera.
  const auto T_world_camera = [&](std::size_t k) { return (**revised)[kSeen + k].T_world_camera; };
  const SE3 moved = T_world_camera(0).inverse() * T_world_camera(kOther - 1);
  const SE3 before = reports[begin].T_world_camera.inverse() * reports[begin + kOther - 1].T_world_camera;
  EXPECT_LT(pose_minus(moved, before).norm(), 1e-9);
  EXPECT_GT(estimator.model().block_count(), reports[kSeen - 1].model_blocks);
}

TEST_F(TwoViews, ASegmentThatIsLostBeforeTheMapIsSeenAgainStaysApart) {
  append_darkness();
  append(run_.frames);
  const Workers workers(1);
  RecordingEstimator estimator(config_of("no-imu"), run_.rig, {}, workers, testing::replay_of(frames_));
  const std::vector<FrameReport> reports = process(estimator);
  const FrameReport& found = reports[kSeen + kDark + kOther + kDark];
  EXPECT_EQ(found.status, FrameStatus::relocalised);
  EXPECT_EQ(found.joined_segment, 0U) << "nothing tells how the camera moved in the dark";
  EXPECT_EQ(reports.back().status, FrameStatus::tracked);
  const auto revised = estimator.revise();
  ASSERT_TRUE(revised.has_value());
  EXPECT_FALSE(revised->has_value());
}

TEST_F(TwoViews, WithoutSegmentsTheOtherViewIsLost) {
  append(run_.frames);
  Config config = config_of("no-imu");
  config.segments.begin_after_s = 0;
  const Workers workers(1);
  RecordingEstimator estimator(config, run_.rig, {}, workers);
  const std::vector<FrameReport> reports = process(estimator);
  EXPECT_EQ(std::ranges::count(reports, FrameStatus::other_segment, &FrameReport::status), 0);
  EXPECT_EQ(reports[kSeen + kDark + kOther - 1].status, FrameStatus::lost);
  EXPECT_NE(reports[kSeen + kDark + kOther].status, FrameStatus::lost);
  const auto revised = estimator.revise();
  ASSERT_TRUE(revised.has_value());
  EXPECT_FALSE(revised->has_value()) << "nothing is revised";
}

}  // namespace
}  // namespace fusebench
