#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/parallel.hpp"
#include "core/config/config.hpp"
#include "tests/support/tracked_system.hpp"

namespace fusebench {

using namespace health;

namespace {

testing::SimulatedRun slow_run(int count) { return testing::simulate(count, {}, {0.15, 0.3, -0.2}); }

TEST(ElasticfusionSystem, FollowsAHandHeldCamera) {
  const testing::SimulatedRun run = slow_run(14);
  for (const char* const variant : {"elasticfusion-open", "elasticfusion-imu"}) {
    config::Config config = testing::config_of_variant(variant);
    config.elasticfusion.stable_confidence = 1.5;  // ten take a second
    const auto tracked = testing::track_with(config, run);
    ASSERT_EQ(tracked.outcomes.size(), run.frames.size());
    EXPECT_EQ(tracked.outcomes.front().status, FrameStatus::initialised);
    for (std::size_t k = 1; k < tracked.outcomes.size(); ++k)
      EXPECT_EQ(tracked.outcomes[k].status, FrameStatus::tracked) << "frame " << k;
    // 14 cm of path.
    EXPECT_LT(testing::worst_position_error_m(run, tracked.outcomes), 0.03) << variant;
    EXPECT_GT(std::get<Mesh>(tracked.surface).vertices.size(), 1000U);
  }
}

TEST(ElasticfusionSystem, GivesTheSameBytesWithAnyNumberOfThreads) {
  const testing::SimulatedRun run = slow_run(5);
  const config::Config config = testing::config_of_variant("elasticfusion");
  const auto one = testing::track_with(config, run, 1);
  const auto three = testing::track_with(config, run, 3);
  ASSERT_EQ(one.outcomes.size(), three.outcomes.size());
  for (std::size_t k = 0; k < one.outcomes.size(); ++k) {
    const SE3 &a = one.outcomes[k].T_world_camera, &b = three.outcomes[k].T_world_camera;
    EXPECT_EQ(a.translation, b.translation) << "frame " << k;
    EXPECT_EQ(a.rotation.coeffs(), b.rotation.coeffs()) << "frame " << k;
  }
}

TEST(ElasticfusionSystem, AFrameWithoutDepthIsLostAndTheNextOneTracked) {
  testing::SimulatedRun run = slow_run(6);
  std::ranges::fill(run.frames[3].depth_m.data, 0.0F);
  const auto tracked = testing::track_with(testing::config_of_variant("elasticfusion"), run);
  EXPECT_EQ(tracked.outcomes[3].status, FrameStatus::lost);
  EXPECT_FALSE(tracked.outcomes[3].reason.empty());
  EXPECT_EQ(tracked.outcomes[5].status, FrameStatus::tracked);
}

/// There and back again: the place of the first frames is inactive when the camera returns.
TEST(ElasticfusionSystem, ClosesALoopWhereItComesBack) {
  testing::SimulatedRun run = testing::simulate(16, {}, {0.1, 0.9, -0.1});
  const std::size_t there = run.frames.size();
  for (std::size_t k = there; k-- > 0;) {
    RgbdFrame frame = run.frames[k];
    frame.timestamp_ns = run.frames.back().timestamp_ns + 33'000'000;
    run.T_first_camera.push_back(run.T_first_camera[k]);
    run.frames.push_back(std::move(frame));
  }
  config::Config config = testing::config_of_variant("elasticfusion");
  config.elasticfusion.loops = config::ElasticfusionLoops::local;
  config.elasticfusion.time_window = 8;
  config.elasticfusion.stable_confidence =
      3;  // what was seen in a few frames is stable, what was seen once is not
  const Workers workers(2);
  const auto system = core::make_system(config, run.rig, run.imu, workers);
  for (const RgbdFrame& frame : run.frames) ASSERT_TRUE(system->process(frame).has_value());
  const auto revised = system->revise();
  ASSERT_TRUE(revised.has_value());
  ASSERT_TRUE(revised->has_value()) << "no loop was closed";
  ASSERT_EQ((*revised)->size(), run.frames.size());
  double worst_m = 0;
  for (std::size_t k = 0; k < run.frames.size(); ++k)
    worst_m = std::max(
        worst_m, ((**revised)[k].T_world_camera.translation - run.T_first_camera[k].translation).norm());
  EXPECT_LT(worst_m, 0.03);
}

}  // namespace
}  // namespace fusebench
