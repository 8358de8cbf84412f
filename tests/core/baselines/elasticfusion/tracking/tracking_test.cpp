#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/baselines/elasticfusion/tracking/camera_tracker.hpp"
#include "core/baselines/elasticfusion/tracking/intensity_matching.hpp"
#include "core/baselines/elasticfusion/tracking/plane_matching.hpp"
#include "core/config/groups/systems_config.hpp"
#include "tests/core/baselines/elasticfusion/room_views.hpp"

namespace fusebench {

using namespace baselines;
using namespace baselines::elasticfusion;
using testing::kFixed;
using testing::live_at;
using testing::small_camera;
using testing::view_of;

namespace {

SE3 stepped(const SE3& T_view_camera, const Vector6d& step) {
  return SE3{so3_exp(step.head<3>()), step.tail<3>()} * T_view_camera;
}

class Tracking : public ::testing::Test {
 protected:
  Workers workers{2};
  SE3 T_view_camera{so3_exp({0.004, -0.006, 0.003}), {0.006, -0.004, 0.008}};
  surfels::LiveFrame before = live_at(SE3{}, workers);
  surfels::LiveFrame now = live_at(T_view_camera, workers);
  tracking::LivePyramid live = tracking::live_pyramid(now, small_camera(), workers);
  tracking::ViewPyramid view = tracking::view_pyramid(view_of(before), kFixed);
};

TEST_F(Tracking, PlanesHaveTheSlopeOfTheirCost) {
  // Without outliers that appear or go, the cost is smooth: a gate that nothing is near to.
  const auto sums_at = [&](const SE3& pose) {
    return tracking::match_planes(live[1], view[1], pose, workers);
  };
  const SE3 off =
      stepped(T_view_camera, (Vector6d() << 0.002, 0.001, -0.002, 0.01, 0.008, -0.006).finished());
  const PoseSums here = sums_at(off);
  EXPECT_GT(here.pixels, 5000);
  for (int axis = 0; axis < 6; ++axis) {
    Vector6d step = Vector6d::Zero();
    step[axis] = 1e-4;
    const double slope = (sums_at(stepped(off, step)).cost - sums_at(stepped(off, -step)).cost) / 2e-4;
    EXPECT_NEAR(-2 * here.descent[axis], slope, 0.15 * here.descent.norm()) << "axis " << axis;
  }
}

TEST_F(Tracking, IntensitiesHaveTheSlopeOfTheirResiduals) {
  // One pixel at a given point of a view of one surface. The model point is at its projection in the view,
  // and the frame is linear by its gradient.
  const auto pixels = tracking::telling_pixels(live[0], 5);
  ASSERT_GT(pixels.z.size(), 1000U);
  const PinholeCamera& camera = live[0].camera;
  int checked = 0;
  for (std::size_t i = 0; i + 8 < pixels.z.size(); i += pixels.z.size() / 50) {
    tracking::TellingPixels one = pixels;
    for (std::size_t other = 0; other < one.z.size(); ++other) one.z[other] = other == i ? pixels.z[i] : 0;
    const auto sums = tracking::match_intensities(one, view[0], T_view_camera, kFixed, workers);
    const Vector3d seen_point(static_cast<double>(pixels.x[i]), static_cast<double>(pixels.y[i]),
                              static_cast<double>(pixels.z[i]));
    const Vector2d gradient(static_cast<double>(pixels.dx[i]), static_cast<double>(pixels.dy[i]));
    if (sums.pixels == 0) continue;
    // Intensity of the frame's linear image at the model point.
    const Vector3d seen = T_view_camera * seen_point;
    const Vector2d at = camera.project(seen);
    const double expected =
        sample_bilinear(surfels::intensity_of(before.color, kFixed), at.x(), at.y()).value;
    const double residual = std::abs(static_cast<double>(pixels.intensity[i]) - expected);
    if (residual < 0.5) continue;
    const int x = static_cast<int>(at.x() + 0.5), y = static_cast<int>(at.y() + 0.5);
    const Vector3d model = camera.back_project(at.x(), at.y(), static_cast<double>(view[0].depth_m(x, y)));
    const auto value_at = [&](const Vector6d& step) {
      const Vector3d point = stepped(T_view_camera, step).inverse() * model;
      return gradient.dot(camera.project(point));
    };
    Vector6d slope;
    for (int axis = 0; axis < 6; ++axis) {
      Vector6d step = Vector6d::Zero();
      step[axis] = 1e-6;
      slope[axis] = (value_at(step) - value_at(-step)) / 2e-6;
    }
    // A step of Gauss-Newton along the row: descent = -w^2 r slope, information = w^2 slope slope^T.
    const double weight = 1 / (2 * residual);
    const Matrix6d information = weight * weight * slope * slope.transpose();
    EXPECT_LT((sums.information - information).norm(), 1e-3 * information.norm());
    EXPECT_NEAR(std::abs(sums.descent.dot(slope)), weight * weight * residual * slope.squaredNorm(),
                1e-3 * weight * weight * residual * slope.squaredNorm());
    EXPECT_NEAR(sums.cost, 0.25, 1e-3);  // (w r)^2
    const double sign = static_cast<double>(pixels.intensity[i]) > expected ? -1 : 1;
    EXPECT_GT(sign * sums.descent.dot(slope), 0);
    ++checked;
  }
  EXPECT_GT(checked, 10);
}

TEST_F(Tracking, WeightsAreByTheDeviationOrAsPublishedByTheNumber) {
  const auto pixels = tracking::telling_pixels(live[0], 5);
  const auto fixed = tracking::match_intensities(pixels, view[0], T_view_camera, kFixed, workers);
  const auto published =
      tracking::match_intensities(pixels, view[0], T_view_camera, config::PeerDefects::as_published, workers);
  // Interpolation needs four pixels of one surface.
  EXPECT_LE(fixed.pixels, published.pixels);
  EXPECT_GT(fixed.pixels, 0.8 * published.pixels);
  // Residuals of a few grey levels against the root of thousands of pixels.
  EXPECT_LT(published.information.trace(), 0.1 * fixed.information.trace());
}

TEST_F(Tracking, FindsTheMotionBetweenTwoFrames) {
  config::ElasticfusionConfig config;
  // As published, intensities are compared at whole pixels: an error of half a pixel is expected, here 2 m
  // away.
  for (const auto& [defects, expected_px] :
       {std::pair{kFixed, 0.1}, {config::PeerDefects::as_published, 0.5}}) {
    config.defects = defects;
    const auto motion = tracking::CameraTracker(config, workers).track(live, view, SE3{});
    EXPECT_FALSE(motion.was_dropped);
    const double limit_rad = expected_px / small_camera().fx_px;
    EXPECT_LT((motion.T_view_camera.translation - T_view_camera.translation).norm(), 2 * limit_rad);
    EXPECT_LT(rotation_angle_rad(motion.T_view_camera.rotation, T_view_camera.rotation), limit_rad);
    EXPECT_GT(motion.matches, 10000);
    EXPECT_LT(motion.variance(), 1e-3);
  }
}

TEST_F(Tracking, IsTheSameForAnyNumberOfThreads) {
  const config::ElasticfusionConfig config;
  const Workers one(1), three(3);
  const auto a = tracking::CameraTracker(config, one).track(live, view, SE3{});
  const auto b = tracking::CameraTracker(config, three).track(live, view, SE3{});
  EXPECT_EQ(a.T_view_camera.translation, b.T_view_camera.translation);
  EXPECT_EQ(a.images.information, b.images.information);
}

}  // namespace
}  // namespace fusebench
