#include "core/all_systems.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "core/config/config.hpp"
#include "core/config/config_access.hpp"
#include "tests/support/tracked_system.hpp"

namespace fusebench {

using namespace health;

namespace {

/// A variant of each system.
constexpr std::array kVariants = {"full",        "no-imu",     "infinitam",      "infinitam-color",
                                  "opencv-rgbd", "opencv-icp", "opencv-rgbdicp", "infinitam-icp"};

class EachSystem : public ::testing::TestWithParam<const char*> {};

TEST_P(EachSystem, FollowsAHandHeldCamera) {
  const testing::SimulatedRun run = testing::simulate(20, {}, {0.15, 0.3, -0.2});
  const auto tracked = testing::track_with(testing::config_of_variant(GetParam()), run);
  ASSERT_EQ(tracked.outcomes.size(), run.frames.size());
  EXPECT_EQ(tracked.outcomes.front().status, FrameStatus::initialised);
  for (std::size_t k = 1; k < tracked.outcomes.size(); ++k) {
    const FrameOutcome& outcome = tracked.outcomes[k];
    EXPECT_EQ(outcome.status, FrameStatus::tracked) << "frame " << k << ": " << outcome.reason;
    EXPECT_EQ(outcome.timestamp_ns, run.frames[k].timestamp_ns);
    EXPECT_GT(outcome.model_blocks, 0U);
  }
  // 20 cm of path. Frame to frame by colour alone drifts most.
  const double limit_m = std::string_view(GetParam()) == "opencv-rgbd" ? 0.1 : 0.04;
  EXPECT_LT(testing::worst_position_error_m(run, tracked.outcomes), limit_m);
  EXPECT_TRUE(std::holds_alternative<tsdf::TsdfVolume>(tracked.surface));
}

TEST_P(EachSystem, GivesTheSameBytesWithAnyNumberOfThreads) {
  const testing::SimulatedRun run = testing::simulate(6);
  const config::Config config = testing::config_of_variant(GetParam());
  const auto one = testing::track_with(config, run, 1);
  const auto three = testing::track_with(config, run, 3);
  ASSERT_EQ(one.outcomes.size(), three.outcomes.size());
  for (std::size_t k = 0; k < one.outcomes.size(); ++k) {
    const SE3 &a = one.outcomes[k].T_world_camera, &b = three.outcomes[k].T_world_camera;
    EXPECT_EQ(a.translation, b.translation) << "frame " << k;
    EXPECT_EQ(a.rotation.coeffs(), b.rotation.coeffs()) << "frame " << k;
    EXPECT_EQ(one.outcomes[k].model_blocks, three.outcomes[k].model_blocks);
  }
}

TEST_P(EachSystem, BeginsAtTheGivenPose) {
  testing::SimulatedRun run = testing::simulate(6);
  const config::Config config = testing::config_of_variant(GetParam());
  const auto at_identity = testing::track_with(config, run);
  const SE3 start = pose_plus(SE3{}, 1e-3 * (Vector6d() << 3, -2, 1, 5, 2, -4).finished());
  run.rig.T_world_first_camera = start;
  const auto moved = testing::track_with(config, run);
  EXPECT_LT((moved.outcomes.front().T_world_camera.translation - start.translation).norm(), 1e-12);
  // The whole trajectory moves with it, up to what the grid of another model does.
  for (std::size_t k = 0; k < moved.outcomes.size(); ++k) {
    const SE3 expected = start * at_identity.outcomes[k].T_world_camera;
    const Vector6d off = pose_minus(moved.outcomes[k].T_world_camera, expected);
    EXPECT_LT(off.head<3>().norm(), 0.01) << "frame " << k;
    EXPECT_LT(off.tail<3>().norm(), 0.01) << "frame " << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Variants, EachSystem, ::testing::ValuesIn(kVariants), [](const auto& variant) {
  std::string name = variant.param;
  std::erase(name, '-');
  return name;
});

TEST(AllSystems, HasARowForEachMethodThatTheOptionNames) {
  std::set<std::string_view> rows;
  for (const core::SystemRow& row : core::all_systems()) {
    EXPECT_TRUE(rows.insert(row.name).second) << row.name;
    config::EffectiveConfig config;
    const auto set = config.set_assignment("system.method=" + std::string(row.name));
    ASSERT_TRUE(set.has_value()) << set.error().message;
    EXPECT_EQ(config.values().system.method, row.method);
  }
  EXPECT_EQ(rows.size(), option_choices(config::SystemMethod{}).size());
}

TEST(AllSystems, AFrameWithoutDepthIsLostAndTheNextOneTracked) {
  for (const char* const variant : {"infinitam", "opencv-rgbdicp"}) {
    testing::SimulatedRun run = testing::simulate(6, {}, {0.15, 0.3, -0.2});
    std::ranges::fill(run.frames[3].depth_m.data, 0.0F);
    const auto tracked = testing::track_with(testing::config_of_variant(variant), run);
    EXPECT_EQ(tracked.outcomes[3].status, FrameStatus::lost) << variant;
    EXPECT_FALSE(tracked.outcomes[3].reason.empty()) << variant;
    EXPECT_EQ(tracked.outcomes[5].status, FrameStatus::tracked) << variant << tracked.outcomes[5].reason;
  }
}

}  // namespace
}  // namespace fusebench
