#include "core/steps/map_segments.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "core/base/geometry.hpp"
#include "core/base/solvers.hpp"

namespace fusebench {

using namespace filter;
using namespace core;

namespace {

SE3 pose(double yaw_rad, double x_m, double z_m) { return {so3_exp({0, yaw_rad, 0}), {x_m, 0, z_m}}; }

PosedFrame frame_at(std::int64_t timestamp_ns, std::size_t segment, const SE3& T_world_imu) {
  PosedFrame frame{timestamp_ns, segment, true, {}};
  frame.state.T_world_imu = T_world_imu;
  return frame;
}

GaussianState reckoned_at(const SE3& T_world_imu, double rotation_sigma_rad, double position_sigma_m) {
  GaussianState state;
  state.mean.T_world_imu = T_world_imu;
  state.covariance.diagonal().segment<3>(kRotation).setConstant(rotation_sigma_rad * rotation_sigma_rad);
  state.covariance.diagonal().segment<3>(kPosition).setConstant(position_sigma_m * position_sigma_m);
  return state;
}

double distance(const SE3& a, const SE3& b) { return pose_minus(a, b).norm(); }

/// The map, a segment whose dead reckoning was off by a rigid motion, and the map again.
struct Joined {
  SE3 T_map_segment = pose(0.2, 0.5, -0.1);
  SE3 T_camera_at_join = pose(1.1, 1.4, 0.3);
  MapSegments segments;

  Joined() {
    segments.add(frame_at(1, 0, pose(0, 0, 0)));
    segments.begin(reckoned_at(pose(0.9, 1, 0), 0.1, 0.3));
    segments.add(frame_at(2, 1, pose(0.9, 1, 0)));
    segments.add(frame_at(3, 1, pose(1, 1.2, 0)));
    segments.join(4, T_map_segment * T_camera_at_join, T_camera_at_join);
    segments.add(frame_at(4, 0, T_map_segment * T_camera_at_join));
  }
};

TEST(MapSegments, AJoinedSegmentMovesAsAWhole) {
  const Joined joined;
  EXPECT_TRUE(joined.segments.has_joined());
  EXPECT_EQ(joined.segments.open(), 0U);
  const Trajectory poses = joined.segments.trajectory(SE3{}, true, {});
  ASSERT_EQ(poses.size(), 4U);
  EXPECT_LT(distance(poses[1].T_world_camera, joined.T_map_segment * pose(0.9, 1, 0)), 1e-12);
  EXPECT_LT(distance(poses[2].T_world_camera, joined.T_map_segment * pose(1, 1.2, 0)), 1e-12);
  const std::optional<FilterState> state = joined.segments.fused_state(3, {});
  ASSERT_TRUE(state);
  EXPECT_LT(distance(state->T_world_imu, joined.T_map_segment * pose(1, 1.2, 0)), 1e-12);
  EXPECT_EQ(joined.segments.trajectory(SE3{}, false, {}).size(), 2U) << "without the map's own frames";
}

TEST(MapSegments, FollowsACorrectionOfTheFrameThatJoinedIt) {
  const Joined joined;
  const SE3 T_corrected_map = pose(-0.05, 0, 0.2);
  const auto corrected = [&](std::int64_t timestamp_ns) {
    EXPECT_EQ(timestamp_ns, 4);
    return T_corrected_map * joined.T_map_segment * joined.T_camera_at_join;
  };
  const std::optional<SE3> near = joined.segments.joined_pose_near(2, corrected);
  ASSERT_TRUE(near);
  EXPECT_LT(distance(*near, T_corrected_map * joined.T_map_segment * pose(0.9, 1, 0)), 1e-12);
  EXPECT_FALSE(joined.segments.joined_pose_near(1, corrected)) << "a frame of the map";
}

TEST(MapSegments, OneThatIsNotJoinedStaysApart) {
  MapSegments segments;
  segments.add(frame_at(1, 0, {}));
  segments.begin(reckoned_at({}, 0.1, 0.1));
  segments.add(frame_at(2, 1, {}));
  segments.close();
  EXPECT_FALSE(segments.has_joined());
  EXPECT_EQ(segments.trajectory(SE3{}, true, {}).size(), 1U);
  EXPECT_FALSE(segments.fused_state(2, {}));
  EXPECT_TRUE(segments.fused_state(1, {}));
  EXPECT_FALSE(segments.fused_state(5, {})) << "no frame";
}

TEST(MapSegments, FramesThatWereNotFusedAreNotFusedAgain) {
  MapSegments segments;
  PosedFrame frame = frame_at(1, 0, {});
  frame.fused = false;
  segments.add(frame);
  EXPECT_FALSE(segments.fused_state(1, {}));
}

TEST(MapSegments, InitialUncertaintyHasALeverArmInTheMap) {
  MapSegments segments;
  segments.begin(reckoned_at({}, 0.1, 0.2));
  GaussianState now;
  now.mean.T_world_imu = pose(0, 3, 0);
  now.mean.velocity_world_mps = {0, 0, 2};
  const GaussianState in_map = segments.in_map(now);
  EXPECT_NEAR(in_map.covariance(kPosition, kPosition), 0.2 * 0.2, 1e-12) << "along the way";
  EXPECT_NEAR(in_map.covariance(kPosition + 2, kPosition + 2), 0.2 * 0.2 + 9 * 0.1 * 0.1, 1e-12);
  EXPECT_NEAR(in_map.covariance(kRotation + 1, kRotation + 1), 0.1 * 0.1, 1e-12);
  EXPECT_NEAR(in_map.covariance(kVelocity, kVelocity), 4 * 0.1 * 0.1, 1e-12);
}

}  // namespace
}  // namespace fusebench
