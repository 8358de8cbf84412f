#include "core/recording_estimator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "core/config/config.hpp"
#include "core/config/variants.hpp"
#include "tests/support/simulated_run.hpp"

namespace fusebench {

using namespace simd;
using namespace config;
using namespace health;
using namespace core;

namespace {

using testing::config_of;
using testing::simulate;
using testing::SimulatedRun;
using testing::track;
using testing::worst_error_m;

constexpr int kFrames = 12;

const SimulatedRun& shared_run() {
  static const SimulatedRun run = simulate(kFrames);
  return run;
}

int tracked(const std::vector<FrameReport>& reports) {
  return static_cast<int>(std::count_if(
      reports.begin(), reports.end(), [](const FrameReport& r) { return r.status == FrameStatus::tracked; }));
}

/// Equal to the last bit, all poses.
bool same_poses(const std::vector<FrameReport>& a, const std::vector<FrameReport>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (a[k].T_world_camera.translation != b[k].T_world_camera.translation) return false;
    if (a[k].T_world_camera.rotation.coeffs() != b[k].T_world_camera.rotation.coeffs()) return false;
  }
  return true;
}

class EveryVariant : public ::testing::TestWithParam<const char*> {};

TEST_P(EveryVariant, TracksAnEasyRecording) {
  const auto reports = track(shared_run(), config_of(GetParam()));
  EXPECT_EQ(tracked(reports), kFrames - 1);
  EXPECT_LT(worst_error_m(shared_run(), reports), 0.01);
  // The camera moved by much more than that.
  EXPECT_GT(shared_run().T_first_camera.back().translation.norm(), 0.05);
}

INSTANTIATE_TEST_SUITE_P(Variants, EveryVariant,
                         ::testing::Values("full", "dm", "no-imu", "dm-no-imu", "planar", "photometric-only",
                                           "geometric-only", "single-iteration", "literal"));

TEST(Pipeline, EachVariantDiffersFromFull) {
  const auto full = track(shared_run(), config_of("full"));
  for (const Variant& variant : all_variants()) {
    if (variant.name == "full" || config_of(variant.name).system.method != SystemMethod::filter) continue;
    EXPECT_FALSE(same_poses(full, track(shared_run(), config_of(variant.name)))) << variant.name;
  }
}

TEST(Pipeline, ATermThatIsOffEqualsTheTermAtWeightZero) {
  // With no weight on a term, nothing of its own settings can matter.
  Config geometric_only = config_of("geometric-only");
  const auto reference = track(shared_run(), geometric_only);
  geometric_only.photometric.noise_grey *= 3;
  geometric_only.photometric.pixels_per_measurement *= 5;
  geometric_only.photometric.gain_sigma = 0;
  EXPECT_TRUE(same_poses(reference, track(shared_run(), geometric_only)));

  Config photometric_only = config_of("photometric-only");
  const auto other = track(shared_run(), photometric_only);
  photometric_only.geometric.max_distance_m *= 3;
  photometric_only.geometric.model_noise_m *= 3;
  EXPECT_TRUE(same_poses(other, track(shared_run(), photometric_only)));
}

TEST(Pipeline, AVanishingWeightConvergesToTheTermBeingOff) {
  Config faint = config_of("full");
  faint.terms.photometric_weight = 1e-12;
  const auto off = track(shared_run(), config_of("geometric-only"));
  const auto nearly_off = track(shared_run(), faint);
  for (std::size_t k = 0; k < off.size(); ++k) {
    EXPECT_LT((off[k].T_world_camera.translation - nearly_off[k].T_world_camera.translation).norm(), 1e-4);
  }
}

TEST(Pipeline, WithoutImuIsUnmovedByNaNInTheImu) {
  SimulatedRun poisoned = shared_run();
  for (ImuSample& sample : poisoned.imu) {
    sample.angular_velocity_radps.setConstant(std::numeric_limits<double>::quiet_NaN());
    sample.specific_force_mps2.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  poisoned.rig.T_imu_camera.translation = {7, 8, 9};
  EXPECT_TRUE(same_poses(track(shared_run(), config_of("no-imu")), track(poisoned, config_of("no-imu"))));
}

TEST(Pipeline, StretchesOfStagesAreInOrderAndAddUp) {
  const auto reports = track(shared_run(), config_of("full"));
  std::chrono::steady_clock::time_point last{};
  for (const FrameReport& report : reports) {
    std::array<double, kStageNames.size()> sums_ms{};
    for (const StageSpan& span : report.stages.spans()) {
      EXPECT_LE(last, span.time.begin);
      EXPECT_LE(span.time.begin, span.time.end);
      last = span.time.end;
      sums_ms[static_cast<std::size_t>(span.stage)] += span.time.milliseconds();
    }
    for (std::size_t stage = 0; stage < sums_ms.size(); ++stage)
      EXPECT_DOUBLE_EQ(sums_ms[stage], report.stages.sums_ms()[stage]);
  }
  // The velocity was estimated from the second frame, and both frames were processed again.
  const auto predictions = [&](std::size_t frame) {
    const auto spans = reports[frame].stages.spans();
    return std::ranges::count(spans, Stage::predict, &StageSpan::stage);
  };
  EXPECT_EQ(predictions(0), 1);
  EXPECT_EQ(predictions(1), 3);
  EXPECT_EQ(predictions(2), 1);
}

TEST(Pipeline, AFrameIsPreparedAgainOnlyIfThereIsMotionToCompensate) {
  // Without an IMU the first velocity is a surprise.
  const auto more_often_than_predicted = [](int times) {
    return [=](const FrameReport& report) {
      const auto spans = report.stages.spans();
      return std::ranges::count(spans, Stage::preprocess, &StageSpan::stage) >
             times * std::ranges::count(spans, Stage::predict, &StageSpan::stage);
    };
  };
  EXPECT_TRUE(std::ranges::none_of(track(shared_run(), config_of("no-imu")), more_often_than_predicted(1)));
  // Grey and depth, then colour, count by themselves: beyond twice a frame was compensated again.
  const SimulatedRun rolling = simulate(3, {.color_readout_s = 0.02, .depth_readout_s = 0.02});
  EXPECT_TRUE(std::ranges::any_of(track(rolling, config_of("no-imu")), more_often_than_predicted(2)));
}

TEST(Pipeline, ThreadCountDoesNotShow) {
  const auto one = track(shared_run(), config_of("full"), 1);
  for (const int threads : {2, 8}) {
    const auto many = track(shared_run(), config_of("full"), threads);
    EXPECT_TRUE(same_poses(one, many)) << threads << " threads";
    EXPECT_EQ(one.back().pixels.intensity.size(), many.back().pixels.intensity.size());
    EXPECT_EQ(one.back().model_blocks, many.back().model_blocks);
  }
}

TEST(Pipeline, BrightnessChangesAreAbsorbed) {
  SimulatedRun darker = shared_run();
  for (std::size_t k = 1; k < darker.frames.size(); ++k) {
    const double gain = k % 2 == 1 ? 0.8 : 1.0;
    for (std::uint8_t& grey : darker.frames[k].grey.data) {
      grey = static_cast<std::uint8_t>(std::lround(gain * grey + (k % 2 == 1 ? 12 : 0)));
    }
  }
  const auto reports = track(darker, config_of("photometric-only"));
  EXPECT_EQ(tracked(reports), kFrames - 1);
  EXPECT_LT(worst_error_m(darker, reports), 0.01);
}

TEST(Pipeline, WithARepeatedColourTheVelocityPredictsOnePose) {
  // Two colour images repeat that of frame 4: depth of frame 5 is not used, that of frame 6 is. A velocity of
  // five frames is not exact, and depth of another instant would have a similar error.
  SimulatedRun stalled = shared_run();
  for (const std::size_t k : {5U, 6U}) {
    stalled.frames[k].grey = stalled.frames[4].grey;
    stalled.frames[k].color = stalled.frames[4].color;
  }
  const auto reports = track(stalled, config_of("no-imu"));
  EXPECT_EQ(reports[5].health, FrameHealth::repeated);
  EXPECT_EQ(reports[5].patches_tracked, 0);
  EXPECT_GT(reports[5].certainty.position_sigma_m, reports[4].certainty.position_sigma_m);
  EXPECT_FALSE(reports[5].reason.empty());
  EXPECT_GT(reports[6].patches_tracked, 0);
  for (std::size_t k = 5; k < reports.size(); ++k) EXPECT_EQ(reports[k].status, FrameStatus::tracked) << k;
  for (const std::size_t k : {5U, 6U})
    EXPECT_EQ(reports[k].model_blocks, reports[4].model_blocks) << "not fused";
  EXPECT_LT(worst_error_m(stalled, reports), 0.02);
  // Depth alone needs no colour, and an IMU measures the motion.
  Config by_depth = config_of("geometric-only");
  by_depth.terms.prior = config::Prior::constant_velocity;
  EXPECT_GT(track(stalled, by_depth)[5].patches_tracked, 0);
  EXPECT_GT(track(stalled, config_of("full"))[5].patches_tracked, 0);
}

TEST(Pipeline, ALostFrameKeepsThePredictionAndTrackingResumes) {
  SimulatedRun interrupted = shared_run();
  for (const std::size_t k : {5U, 6U}) {
    std::fill(interrupted.frames[k].grey.data.begin(), interrupted.frames[k].grey.data.end(), 0);
    std::fill(interrupted.frames[k].depth_m.data.begin(), interrupted.frames[k].depth_m.data.end(), 0.2F);
  }
  const auto reports = track(interrupted, config_of("full"));
  ASSERT_EQ(reports.size(), static_cast<std::size_t>(kFrames));
  for (const std::size_t k : {5U, 6U}) {
    EXPECT_EQ(reports[k].status, FrameStatus::lost);
    EXPECT_FALSE(reports[k].reason.empty());
    EXPECT_EQ(reports[k].model_blocks, reports[4].model_blocks) << "a lost frame is not fused";
  }
  for (std::size_t k = 7; k < reports.size(); ++k) EXPECT_EQ(reports[k].status, FrameStatus::tracked);
  EXPECT_LT(worst_error_m(interrupted, reports), 0.02);
}

/// The grey levels of a camera that sees this share of the light.
GreyImage darkened(GreyImage grey, double share) {
  for (std::uint8_t& level : grey.data) level = static_cast<std::uint8_t>(std::lround(share * level));
  return grey;
}

TEST(Pipeline, StartsAtTheFirstFrameThatCanBeUsed) {
  for (const char* const variant : {"full", "no-imu"}) {
    SCOPED_TRACE(variant);
    // Result of the recording without its first two frames.
    SimulatedRun later = shared_run();
    later.frames.erase(later.frames.begin(), later.frames.begin() + 2);
    const auto expected = track(later, config_of(variant));
    for (const double light : {0.0, 0.03}) {
      SimulatedRun dark_start = shared_run();
      for (const std::size_t k : {0U, 1U})
        dark_start.frames[k].grey = darkened(dark_start.frames[k].grey, light);
      auto reports = track(dark_start, config_of(variant));
      ASSERT_EQ(reports.size(), static_cast<std::size_t>(kFrames));
      for (const std::size_t k : {0U, 1U}) {
        EXPECT_EQ(reports[k].status, FrameStatus::lost);
        EXPECT_EQ(reports[k].reason, "waiting for a usable first frame: dark");
        EXPECT_EQ(reports[k].timestamp_ns, dark_start.frames[k].timestamp_ns);
      }
      EXPECT_EQ(reports[2].status, FrameStatus::initialised);
      EXPECT_EQ(tracked(reports), kFrames - 3);
      reports.erase(reports.begin(), reports.begin() + 2);
      EXPECT_TRUE(same_poses(reports, expected));
      EXPECT_EQ(reports.back().model_blocks, expected.back().model_blocks);
    }
  }
}

TEST(Pipeline, FramesAreTrackedFromADimFirstFrame) {
  SimulatedRun dim_start = shared_run();
  dim_start.frames[0].grey = darkened(dim_start.frames[0].grey, 0.5);
  const auto reports = track(dim_start, config_of("full"));
  EXPECT_GE(tracked(reports), kFrames - 2) << "the step of light may cost one frame";
}

TEST(Pipeline, AFirstFrameOfAnotherViewIsGivenUpForALaterStart) {
  SimulatedRun other_start = shared_run();
  RgbdFrame& first = other_start.frames[0];
  std::ranges::reverse(first.grey.data);
  std::ranges::reverse(first.depth_m.data);
  std::ranges::reverse(first.color.data);
  auto reports = track(other_start, config_of("full"));
  const auto start = std::ranges::find_if(reports.begin() + 1, reports.end(), [](const FrameReport& report) {
    return report.status == FrameStatus::initialised;
  });
  ASSERT_NE(start, reports.end());
  EXPECT_NE(start->reason.find("started again"), std::string::npos);
  EXPECT_LE(start - reports.begin(), 6);
  EXPECT_TRUE(std::all_of(start + 1, reports.end(),
                          [](const FrameReport& report) { return report.status == FrameStatus::tracked; }));
}

TEST(Pipeline, DoesNotStartAtAFrameWithoutDepthOrTexture) {
  SimulatedRun run = shared_run();
  std::fill(run.frames[0].depth_m.data.begin(), run.frames[0].depth_m.data.end(), 0.0F);
  std::fill(run.frames[1].grey.data.begin(), run.frames[1].grey.data.end(), std::uint8_t{128});
  const auto reports = track(run, config_of("full"));
  EXPECT_EQ(reports[0].reason, "waiting for a usable first frame: short-of-depth");
  EXPECT_EQ(reports[1].reason, "waiting for a usable first frame: short-of-texture");
  EXPECT_EQ(reports[2].status, FrameStatus::initialised);
  EXPECT_EQ(tracked(reports), kFrames - 3);
}

TEST(Pipeline, AnAbsurdInertialSampleLosesFramesButKeepsTheModel) {
  const SimulatedRun run = simulate(24);
  for (const double absurd : {4e9, 1e20, -3e38, 1e308}) {
    for (const auto member : {&ImuSample::angular_velocity_radps, &ImuSample::specific_force_mps2}) {
      SCOPED_TRACE(::testing::Message() << absurd);
      SimulatedRun disturbed = run;
      // After the window that gravity is taken from.
      const std::int64_t at_ns = disturbed.frames[9].timestamp_ns + 10'000'000;
      const auto sample = std::ranges::lower_bound(disturbed.imu, at_ns, {}, &ImuSample::timestamp_ns);
      ((*sample).*member).x() = absurd;
      const auto reports = track(disturbed, config_of("full"));
      ASSERT_EQ(reports.size(), disturbed.frames.size());
      for (const FrameReport& report : reports) {
        EXPECT_TRUE(report.estimate.covariance.allFinite());
        EXPECT_TRUE(report.T_world_camera.translation.allFinite());
        EXPECT_TRUE(report.T_world_camera.rotation.coeffs().allFinite());
        EXPECT_EQ(report.reason.empty(), report.status != FrameStatus::lost);
      }
      EXPECT_EQ(reports[10].status, FrameStatus::lost);
      // A smaller one may leave numbers that can be computed with, which readers refuse.
      if (std::abs(absurd) < 1e10) continue;
      EXPECT_EQ(reports[10].health, FrameHealth::diverged);
      EXPECT_NE(reports[10].reason.find("not finite"), std::string::npos) << reports[10].reason;
      EXPECT_NE(reports.back().status, FrameStatus::lost) << reports.back().reason;
      const SE3& truth = disturbed.T_first_camera.back();
      EXPECT_LT((reports.back().T_world_camera.translation - truth.translation).norm(), 0.02);
    }
  }
}

TEST(Pipeline, MissingImuIsAnErrorWithItsTimes) {
  SimulatedRun truncated = shared_run();
  std::erase_if(truncated.imu,
                [&](const ImuSample& s) { return s.timestamp_ns > truncated.frames[3].timestamp_ns; });
  const Workers workers(1);
  RecordingEstimator pipeline(config_of("full"), truncated.rig, truncated.imu, workers);
  Result<FrameReport> last = fail(ErrorCode::internal, "");
  for (const RgbdFrame& frame : truncated.frames) {
    last = pipeline.process(frame);
    if (!last) break;
  }
  ASSERT_FALSE(last.has_value());
  EXPECT_EQ(last.error().code, ErrorCode::data_corrupt);
  EXPECT_NE(last.error().message.find("does not cover"), std::string::npos);
}

TEST(Variants, AreUniqueAndTheirEditsAreEffective) {
  std::set<std::string> hashes;
  for (const Variant& variant : all_variants()) {
    EXPECT_TRUE(hashes.insert(config_hash(variant_config(variant).values())).second) << variant.name;
    EXPECT_FALSE(variant.sentence.empty());
  }
}

TEST(Variants, AnUnknownNameGetsTheNearestOne) {
  const auto variant = find_variant("no_imu");
  ASSERT_FALSE(variant.has_value());
  EXPECT_NE(variant.error().message.find("nearest: no-imu"), std::string::npos);
}

}  // namespace
}  // namespace fusebench
