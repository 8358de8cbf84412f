// The whole estimator on simulated recordings in which something goes wrong for half a second, or all the
// time: it may lose its way, but it must say so, keep what it has, and find back.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <string>

#include "core/config/variants.hpp"
#include "core/recording_estimator.hpp"
#include "datasets/open_recording.hpp"
#include "datasets/simulator/simulation.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace simd;
using namespace config;
using namespace filter;
using namespace health;
using namespace core;
using namespace recording;
using namespace datasets;
using namespace simulator::motion;
using namespace simulator::faults;
using namespace simulator::layouts;
using namespace simulator;

namespace {

constexpr double kFaultBegin_s = 0.8;
constexpr double kFaultEnd_s = 1.29;

/// What came out of one frame, with what is true of it.
struct FrameResult {
  FrameReport report;
  double time_s = 0;  ///< from the first frame
  double error_m = 0;
  double error_rad = 0;
  double sigma_m = 0;  ///< of the longest axis
  [[nodiscard]] bool faulty() const { return time_s >= kFaultBegin_s && time_s < kFaultEnd_s; }
  [[nodiscard]] bool lost() const { return report.status == FrameStatus::lost; }
};
using RunResult = std::vector<FrameResult>;

double longest_sigma_m(const GaussianState& state) {
  const Matrix3d block = state.covariance.block<3, 3>(kPosition, kPosition);
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Matrix3d>(block).eigenvalues().maxCoeff());
}

/// The reference at a frame: the simulator writes a pose at every stamp.
SE3 truth_at(const Recording& recording, std::int64_t timestamp_ns) {
  const auto found =
      std::ranges::lower_bound(recording.ground_truth, timestamp_ns - 500, {}, &StampedPose::timestamp_ns);
  EXPECT_TRUE(found != recording.ground_truth.end() && found->timestamp_ns < timestamp_ns + 500);
  return found->T_world_camera;
}

/// What is shown to whom: frames of the recording in another order, at the times of the first ones.
struct Playback {
  std::string variant = "full";
  std::vector<std::size_t> order;  ///< empty: as they are
};

class Robustness : public testing::InTemporaryFolder {
 protected:
  /// Two seconds of careful scanning that begin in motion, in a quarter of a ZR300's pixels.
  static SimulationOptions scanning(std::initializer_list<const char*> faults = {}) {
    SimulationOptions options =
        simulation_defaults(RecordingLayout::zr300, MotionPreset::slow, {320, 240}).value();
    options.motion.from_rest = false;
    options.duration_s = 2;
    options.blur_samples = 4;
    for (const char* fault : faults) options.faults.push_back(parse_fault(fault).value());
    return options;
  }

  Result<Recording> made(const SimulationOptions& options) {
    const std::filesystem::path folder = folder_ / std::to_string(count_++);
    const auto simulated = simulate(options, folder, Workers(1));
    EXPECT_TRUE(simulated) << (simulated ? "" : simulated.error().message);
    return open_recording(folder);
  }

  RunResult run(const SimulationOptions& options, const Playback& playback = {}) {
    return run(made(options), playback);
  }

  static RunResult run(const Result<Recording>& recording, const Playback& playback) {
    EXPECT_TRUE(recording) << (recording ? "" : recording.error().message);
    const Workers workers(1);
    RecordingEstimator pipeline(variant_config(find_variant(playback.variant).value()).values(),
                                recording->rig, recording->imu, workers);
    const std::int64_t first_ns = recording->frames.front().timestamp_ns;
    const SE3 T_first_truth = truth_at(*recording, first_ns).inverse();
    RunResult results;
    const std::int64_t period_ns = recording->frames[1].timestamp_ns - first_ns;
    const std::size_t count = playback.order.empty() ? recording->frames.size() : playback.order.size();
    for (std::size_t k = 0; k < count; ++k) {
      RgbdFrame frame = recording->load_frame(playback.order.empty() ? k : playback.order[k]).value();
      const SE3 truth = T_first_truth * truth_at(*recording, frame.timestamp_ns);
      if (!playback.order.empty()) frame.timestamp_ns = first_ns + static_cast<std::int64_t>(k) * period_ns;
      auto report = pipeline.process(frame);
      EXPECT_TRUE(report) << (report ? "" : report.error().message);
      if (!report) break;
      FrameResult result;
      result.time_s = seconds_between(first_ns, report->timestamp_ns);
      result.error_m = (report->T_world_camera.translation - truth.translation).norm();
      result.error_rad = rotation_angle_rad(report->T_world_camera.rotation, truth.rotation);
      result.sigma_m = longest_sigma_m(report->estimate);
      result.report = std::move(*report);
      results.push_back(std::move(result));
    }
    return results;
  }

 private:
  int count_ = 0;
};

/// The last frame before the fault begins, and the first one after it ends.
const FrameResult& before_fault(const RunResult& results) {
  return *std::prev(std::ranges::find_if(results, &FrameResult::faulty));
}
RunResult within_fault(const RunResult& results) {
  RunResult faulty;
  std::ranges::copy_if(results, std::back_inserter(faulty), &FrameResult::faulty);
  return faulty;
}
RunResult after_fault(const RunResult& results) {
  RunResult after;
  std::ranges::copy_if(results, std::back_inserter(after),
                       [](const FrameResult& r) { return r.time_s >= kFaultEnd_s; });
  return after;
}

std::set<FrameHealth> healths_of(const RunResult& results) {
  std::set<FrameHealth> healths;
  for (const FrameResult& result : results) healths.insert(result.report.health);
  return healths;
}

/// A pose that is given as tracked is a good one. Without any fault, errors here are up to 7 mm and 0.11
/// degrees.
void expect_no_confident_error(const RunResult& results, double most_m = 0.015, double most_deg = 0.3) {
  for (const FrameResult& result : results) {
    if (result.lost()) continue;
    EXPECT_LT(result.error_m, most_m) << "at " << result.time_s << " s";
    EXPECT_LT(result.error_rad, radians(most_deg)) << "at " << result.time_s << " s";
  }
}

void expect_tracked(const RunResult& results) {
  EXPECT_FALSE(results.empty());
  for (const FrameResult& result : results) EXPECT_FALSE(result.lost()) << "at " << result.time_s << " s";
}

/// Nothing can be seen: the IMU carries on, says that it knows less and less, and neither the model nor the
/// patches are touched, so the first frame that can be seen is compared with the last good one.
void expect_bridged(const RunResult& results, FrameHealth health) {
  expect_no_confident_error(results);
  const FrameResult& before = before_fault(results);
  const RunResult faulty = within_fault(results);
  ASSERT_EQ(faulty.size(), 15U);
  double sigma_m = before.sigma_m;
  for (const FrameResult& result : faulty) {
    SCOPED_TRACE(result.time_s);
    EXPECT_TRUE(result.lost());
    EXPECT_EQ(to_string(result.report.health), to_string(health));
    // Patches that hardly have texture themselves may fit an image that has none.
    EXPECT_LE(result.report.patches_accepted, 12);
    EXPECT_EQ(result.report.model_blocks, before.report.model_blocks);
    EXPECT_GT(result.sigma_m, sigma_m);
    EXPECT_LT(result.error_m, before.error_m + 3 * result.sigma_m);
    sigma_m = result.sigma_m;
  }
  // Half a second of this IMU, with the velocity that images told before, is a centimetre.
  EXPECT_GT(std::sqrt(sigma_m * sigma_m - before.sigma_m * before.sigma_m), 0.01);
  const RunResult after = after_fault(results);
  expect_tracked(after);
  EXPECT_LT(after.front().sigma_m - before.sigma_m, 0.15 * (sigma_m - before.sigma_m));
  EXPECT_GT(after.front().report.model_blocks, before.report.model_blocks);
}

TEST_F(Robustness, BlackImagesAreBridgedByTheImu) {
  expect_bridged(run(scanning({"black=0.8:1.29"})), FrameHealth::dark);
}

TEST_F(Robustness, APlaceIsFoundAgainAfterAJump) {
  // The camera is carried back to where it was 1.4 seconds ago, half a metre and some forty degrees away.
  Playback playback{"no-imu", {}};
  for (std::size_t k = 0; k < 45; ++k) playback.order.push_back(k);
  for (std::size_t k = 3; k < 30; ++k) playback.order.push_back(k);
  const RunResult results = run(scanning(), playback);
  ASSERT_EQ(results.size(), 72U);
  const auto found = std::ranges::find_if(
      results, [](const FrameResult& r) { return r.report.status == FrameStatus::relocalised; });
  ASSERT_NE(found, results.end());
  EXPECT_TRUE(results[45].lost());  // nothing moves like that: it has to be lost for a while to be believed
  EXPECT_LT(found - results.begin(), 65);
  EXPECT_GT(found->report.patches_accepted, 20);
  expect_tracked({found, results.end()});
  expect_no_confident_error(results, 0.02, 0.5);
}

TEST_F(Robustness, ARecordingMayBeginInTheMiddleOfAMotion) {
  // Two metres a second close to clutter, and nobody says so: patches alone settle on other corners.
  for (const std::uint64_t seed : {1U, 3U}) {
    SimulationOptions options =
        simulation_defaults(RecordingLayout::zr300, MotionPreset::sweep, {640, 480}).value();
    options.motion.from_rest = false;
    options.seed = seed;
    options.duration_s = 0.2;
    options.blur_samples = 4;
    const Result<Recording> recording = made(options);
    for (const char* variant : {"full", "no-imu"}) {
      SCOPED_TRACE(fmt::format("{}, seed {}", variant, seed));
      const RunResult results = run(recording, {variant, {}});
      expect_tracked(results);
      expect_no_confident_error(results, 0.01, 0.3);
    }
  }
}

TEST_F(Robustness, SurfacesWithoutTextureAreBridgedByTheImu) {
  expect_bridged(run(scanning({"no-texture=0.8:1.29"})), FrameHealth::short_of_texture);
}

TEST_F(Robustness, ColourAloneTracksWithoutDepth) {
  const RunResult results = run(scanning({"no-depth=0.8:1.29"}));
  // 0.298 degrees at the end, 0.301 in a build whose rounding differs: half a second without depth turned it.
  expect_no_confident_error(results, 0.015, 0.35);
  expect_tracked(results);
  const RunResult faulty = within_fault(results);
  EXPECT_EQ(healths_of(faulty), std::set{FrameHealth::short_of_depth});
  for (const FrameResult& result : faulty) {
    EXPECT_EQ(result.report.model_blocks, before_fault(results).report.model_blocks);
    EXPECT_EQ(result.report.pixels_geometric, 0);
    EXPECT_GT(result.report.pixels_photometric, 1000);
  }
}

TEST_F(Robustness, MissingFramesAreBridgedByTheImu) {
  const RunResult results = run(scanning({"drop=0.8:1.29"}));
  EXPECT_EQ(results.size(), 45U);
  expect_no_confident_error(results);
  expect_tracked(results);
  EXPECT_EQ(after_fault(results).front().report.health, FrameHealth::good);
}

TEST_F(Robustness, BrightnessMayJump) {
  const RunResult results = run(scanning({"brightness=0.8:1:0.5", "brightness=1.1:1.29:1.8"}));
  expect_no_confident_error(results);
  expect_tracked(results);
  EXPECT_EQ(healths_of(within_fault(results)), std::set{FrameHealth::good});
}

TEST_F(Robustness, LongExposuresAreTracked) {
  const RunResult results = run(scanning({"blur=0.8:1.29:0.03"}));
  expect_no_confident_error(results);
  expect_tracked(results);
}

TEST_F(Robustness, AHandIsNoticed) {
  for (const char* hand : {"hand=0.3:0.39:0.4", "hand=0.3:0.39:0.8"}) {
    SCOPED_TRACE(hand);
    SimulationOptions options = scanning({hand});
    options.duration_s = 0.4;
    const RunResult results = run(options);
    ASSERT_EQ(results.size(), 12U);
    EXPECT_EQ(results[8].report.health, FrameHealth::good);
    EXPECT_EQ(results[9].report.health, FrameHealth::occluded);  // patches are still those of the room
  }
}

// Patches on a hand agree with each other and with its depth, and there may be more of them than of the room.
// These two hold once occluded frames are neither fused nor cut for patches.
TEST_F(Robustness, AHandThatCoversMostIsNotTheWorld) {
  const RunResult results = run(scanning({"hand=0.8:1.29:0.8"}));
  expect_no_confident_error(results);
  EXPECT_EQ(healths_of(within_fault(results)), std::set{FrameHealth::occluded});
  EXPECT_FALSE(results.back().lost());
}

TEST_F(Robustness, AHandThatCoversLessThanHalfIsNotTheWorld) {
  const RunResult results = run(scanning({"hand=0.8:1.29:0.4"}));
  expect_no_confident_error(results);
  EXPECT_FALSE(results.back().lost());
}

TEST_F(Robustness, AWrongExtrinsicCalibrationLimitsTheAccuracyAndNoMore) {
  SimulationOptions options = scanning();
  options.calibration_error = {1, 1};
  const RunResult results = run(options);
  expect_tracked(results);
  expect_no_confident_error(results, 0.02, 0.5);
}

// Quick turns tell the offset: 10 ms of 3 rad/s are 1.7 degrees. Careful scanning does not.
TEST_F(Robustness, AnUntoldClockOffsetIsFoundInQuickMotion) {
  for (const double offset_s : {0.01, -0.01}) {
    SCOPED_TRACE(offset_s);
    SimulationOptions options =
        simulation_defaults(RecordingLayout::zr300, MotionPreset::fast, {320, 240}).value();
    options.motion.from_rest = false;
    options.duration_s = 1.5;
    options.blur_samples = 4;
    options.untold_time_offset_s = offset_s;
    const RunResult results = run(options);
    expect_tracked(results);
    expect_no_confident_error(results, 0.05, 1.2);  // without the offset: up to 18 mm and 0.33 degrees
    EXPECT_NEAR(results.back().report.estimate.mean.imu_time_offset_s, offset_s, 0.002);
  }
}

}  // namespace
}  // namespace fusebench
