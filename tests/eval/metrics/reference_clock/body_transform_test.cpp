#include "eval/metrics/reference_clock/body_transform.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "eval/metrics/reference_clock/body_motions.hpp"
#include "tests/eval/metrics/reference_clock/moving_bodies.hpp"

namespace fusebench {

using namespace reference_clock;
using testing::random_motion;
using testing::sampled;
using testing::seen_by;

namespace {

const SE3 kCameraInBody(so3_exp({0.9, 0.7, -1.8}), {0.2, -0.17, 0.14});

/// Motions over half a second of a body, and of a camera on it whose lengths are scaled.
std::vector<MotionPair> rigid_pairs(double scale) {
  const Trajectory body = sampled(random_motion(3, 0.5, 0.3), 0, 10, 10);
  const Trajectory camera = seen_by(body, kCameraInBody, scale);
  std::vector<MotionPair> pairs;
  for (std::size_t i = 0; i + 5 < body.size(); ++i) {
    pairs.push_back({body[i].T_world_camera.inverse() * body[i + 5].T_world_camera,
                     camera[i].T_world_camera.inverse() * camera[i + 5].T_world_camera});
  }
  return pairs;
}

TEST(BodyTransform, MapsMotionsOfTheCameraToThoseOfTheBody) {
  const BodyTransform transform{kCameraInBody.rotation, kCameraInBody.translation, 1 / 1.05};
  for (const auto& [body, camera] : rigid_pairs(1.05))
    EXPECT_LT(pose_minus(body, transform(camera)).norm(), 1e-12);
}

TEST(BodyTransform, IsFoundWithoutAStart) {
  const std::vector<MotionPair> pairs = rigid_pairs(1.05);
  const BodyTransform found = rough_transform(pairs, std::vector<double>(pairs.size(), 1.0), {});
  EXPECT_LT(rotation_angle_rad(found.rotation, kCameraInBody.rotation), 0.02);
  EXPECT_LT((found.offset_m - kCameraInBody.translation).norm(), 0.02);
  EXPECT_NEAR(found.scale, 1 / 1.05, 0.02);
}

TEST(BodyTransform, JacobianIsTheNumericDerivative) {
  constexpr double kStep = 1e-6;
  const BodyTransform transform{so3_exp({0.3, -1.1, 0.4}), {0.2, 0.3, -0.1}, 1.2};
  const SE3 camera(so3_exp({0.4, -0.2, 0.7}), {0.3, -0.1, 0.2});
  const BodyJacobian jacobian = transform.jacobian(camera);
  for (int column = 0; column < 7; ++column) {
    BodyTransform up = transform;
    BodyTransform down = transform;
    up.step(kStep * Vector7d::Unit(column));
    down.step(-kStep * Vector7d::Unit(column));
    // The tangent at the motion, of which pose_minus() takes the right rotation.
    const Vector6d numeric =
        (pose_minus(up(camera), transform(camera)) - pose_minus(down(camera), transform(camera))) /
        (2 * kStep);
    EXPECT_LT((jacobian.col(column) - numeric).norm(), 1e-8) << column;
  }
}

TEST(BodyMotions, RateIsTheDerivativeOfTheMotion) {
  const testing::Motion motion = random_motion(4, 0.5, 0.3);
  const Trajectory reference = sampled(motion, 0, 4, 1000);
  constexpr std::int64_t kBegin_ns = 1'500'000'000;
  constexpr std::int64_t kEnd_ns = kBegin_ns + kMotion_ns;
  const auto found = reference_motion_with_rate(reference, kBegin_ns, kEnd_ns);
  ASSERT_TRUE(found);
  const auto exact = [&](double by_s) { return motion(1.5 + by_s).inverse() * motion(2.0 + by_s); };
  EXPECT_LT(pose_minus(found->motion, exact(0)).norm(), 1e-6);
  const Vector6d rate = pose_minus(exact(1e-4), exact(-1e-4)) / 2e-4;
  EXPECT_LT((found->rate - rate).norm(), 0.1 * rate.norm()) << "over 0.2 s";
  EXPECT_FALSE(reference_motion_with_rate(reference, 0, kMotion_ns)) << "nothing is known 0.1 s before";
  EXPECT_TRUE(reference_motion(reference, 0, kMotion_ns));
  EXPECT_FALSE(reference_motion(reference, 3'600'000'000, 4'100'000'000));
}

TEST(BodyMotions, EachBeginsAtAPoseThatHasNeighbours) {
  const Trajectory poses = sampled(random_motion(4, 0.5, 0.3), 0, 3, 30);
  const std::vector<EstimatedMotion> motions = estimated_motions(poses, 1000);
  // 3 poses before; behind the last begin 3 for its neighbour, and half of 0.5 s at the end.
  ASSERT_EQ(motions.size(), 90U - 3 - 3 - 8);
  const EstimatedMotion& first = motions.front();
  EXPECT_EQ(first.begin_ns, poses[3].timestamp_ns);
  EXPECT_EQ(first.end_ns, poses[18].timestamp_ns);
  EXPECT_NEAR(first.span_s, 0.2, 1e-6);
  const SE3 before = poses[0].T_world_camera.inverse() * poses[15].T_world_camera;
  const SE3 after = poses[6].T_world_camera.inverse() * poses[21].T_world_camera;
  EXPECT_LT(pose_minus(first.before, before).norm(), 1e-12);
  EXPECT_LT(pose_minus(first.after, after).norm(), 1e-12);
  EXPECT_EQ(estimated_motions(poses, 45).size(), motions.size() / 2);
  EXPECT_TRUE(estimated_motions({}, 1000).empty());
}

}  // namespace
}  // namespace fusebench
