#include <gtest/gtest.h>

#include <cmath>

#include "core/base/solvers.hpp"
#include "core/baselines/image_gradient.hpp"
#include "core/baselines/infinitam/color_matching.hpp"
#include "core/baselines/infinitam/depth_matching.hpp"
#include "core/baselines/infinitam/depth_pyramid.hpp"
#include "core/baselines/infinitam/model_view.hpp"
#include "core/config/groups/frame_config.hpp"
#include "tests/support/fused_scene.hpp"
#include "tests/support/simulated_frames.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace baselines;
using namespace baselines::infinitam;
using testing::small_camera;

namespace {

/// World points moved by d, as in PoseSums.
SE3 camera_after(const SE3& T_world_camera, const Vector6d& d) {
  return SE3{so3_exp(d.head<3>()), d.tail<3>()} * T_world_camera;
}

class MatchDepth : public ::testing::Test {
 protected:
  MatchDepth() : renderer(camera, depth) { renderer.render(model, SE3{}, false, workers, view); }

  [[nodiscard]] PoseSums sums_at(const SE3& T_world_camera, const DepthMatching& matching) const {
    return match_depth(image, camera, T_world_camera, view, matching, workers);
  }

  Workers workers{2};
  PinholeCamera camera = small_camera();
  config::DepthConfig depth;
  AnalyticScene scene = room_with_a_ball();
  tsdf::TsdfVolume model = fuse(scene, camera, {SE3{}});
  ModelRenderer renderer;
  ModelView view;
  DepthImage image = scene.render(camera, SE3{}).depth_m;
  DepthMatching squares{.max_squared_distance_m2 = 0.01};
  DepthMatching huber{.max_squared_distance_m2 = 0.8, .huber_m = 0.004, .near_m = 0.2, .far_m = 3.0};
};

TEST_F(MatchDepth, HasNoGradientAtTheTruePose) {
  const PoseSums sums = sums_at(SE3{}, squares);
  EXPECT_GT(sums.pixels, 0.7 * static_cast<double>(image.data.size()));
  // Residuals are those of the model: a fraction of a voxel.
  EXPECT_LT(std::sqrt(sums.cost / sums.pixels), 0.003);
}

TEST_F(MatchDepth, DescentIsTheSlopeOfTheCost) {
  const SE3 off{so3_exp({0.004, -0.003, 0.002}), {0.004, 0.003, -0.005}};
  for (const DepthMatching& matching : {squares, huber}) {
    const PoseSums here = sums_at(off, matching);
    for (int axis = 0; axis < 6; ++axis) {
      constexpr double kStep = 2e-4;
      Vector6d d = Vector6d::Zero();
      d[axis] = kStep;
      const double slope =
          (sums_at(camera_after(off, d), matching).cost - sums_at(camera_after(off, -d), matching).cost) /
          (2 * kStep);
      // Squares have the slope of half the cost, as in the program. Where points match differently after the
      // step, the numeric slope has what the analytic one leaves out.
      const double analytic = -(matching.huber_m > 0 ? 1.0 : 2.0) * here.descent[axis];
      EXPECT_NEAR(analytic, slope, 0.15 * here.descent.norm()) << "axis " << axis;
    }
  }
}

TEST_F(MatchDepth, StepsGoBackToTheTruePose) {
  // Towards a corner of the room: three walls constrain all six directions.
  const SE3 truth{so3_exp({0, 0.75, 0}) * so3_exp({0.5, 0, 0}), Vector3d::Zero()};
  const tsdf::TsdfVolume corner = fuse(scene, camera, {truth});
  renderer.render(corner, truth, false, workers, view);
  image = scene.render(camera, truth).depth_m;
  SE3 pose = camera_after(truth, (Vector6d() << 0.01, -0.008, 0.005, 0.01, 0.008, -0.012).finished());
  for (int i = 0; i < 10; ++i) {
    const PoseSums sums = sums_at(pose, squares);
    pose = camera_after(pose, sums.information.ldlt().solve(sums.descent));
  }
  EXPECT_LT((pose.translation - truth.translation).norm(), 0.001);
  EXPECT_LT(rotation_angle_rad(pose.rotation, truth.rotation), 0.001);
}

TEST_F(MatchDepth, GatesFarMatchesAndWeighsByDistanceAndConfidence) {
  const SE3 far_off{Quaterniond::Identity(), {0, 0, 0.2}};
  EXPECT_EQ(sums_at(far_off, DepthMatching{.max_squared_distance_m2 = 1e-4}).pixels, 0);
  DepthMatching weighted = huber;
  weighted.by_weight = true;
  weighted.weight_to_skip = 20;
  // Without weights the view has 1 everywhere, which is less than 20.
  EXPECT_EQ(sums_at(SE3{}, weighted).pixels, 0);
  weighted.weight_to_skip = 0;
  weighted.weight_to_count = 2;
  EXPECT_NEAR(sums_at(SE3{}, weighted).cost, 0.5 * sums_at(SE3{}, huber).cost,
              1e-6 * sums_at(SE3{}, huber).cost);
}

TEST_F(MatchDepth, IsTheSameForImagesOfAnyWidthAndThreads) {
  DepthImage narrow(image.width - 3, image.height);
  for (int y = 0; y < narrow.height; ++y) {
    for (int x = 0; x < narrow.width; ++x) narrow(x, y) = image(x, y);
  }
  PinholeCamera cut = camera;
  cut.width_px -= 3;
  DepthImage holes = image;
  for (int y = 0; y < holes.height; ++y) {
    for (int x = narrow.width; x < holes.width; ++x) holes(x, y) = 0;
  }
  const PoseSums a = match_depth(narrow, cut, SE3{}, view, squares, workers);
  const PoseSums b = match_depth(holes, camera, SE3{}, view, squares, Workers(1));
  EXPECT_EQ(a.pixels, b.pixels);
  EXPECT_EQ(a.information, b.information);
}

TEST(ModelView, HasThePointsAndNormalsOfTheScene) {
  const PinholeCamera camera = small_camera();
  // A wall at 2 m, seen from the front.
  const AnalyticScene wall = {{AnalyticBox{{-3, -3, -3}, {3, 3, 2}, true, {90, 100, 110}}}};
  const tsdf::TsdfVolume model = fuse(wall, camera, {SE3{}, SE3{}, SE3{}});
  ModelRenderer renderer(camera, {});
  ModelView view;
  renderer.render(model, SE3{}, true, Workers(2), view);
  const int x = camera.width_px / 2, y = camera.height_px / 2;
  ASSERT_GE(view.weight(x, y), 0);
  EXPECT_NEAR(view.point.z(x, y), 2, 0.002);
  EXPECT_NEAR(view.normal.z(x, y), -1, 1e-3);
  // Three observations of a weight that is at most 1.
  EXPECT_GT(view.weight(x, y), 1);
  EXPECT_LE(view.weight(x, y), 3);
  EXPECT_LT(view.weight(0, 0), 0) << "no normals at the border";
}

TEST(MatchColor, DescentIsTheSlopeOfTheCost) {
  const PinholeCamera camera = small_camera();
  const testing::TexturedRoom room;
  const RgbdFrame before = testing::render_rolling(room, camera, {}, [](double) { return SE3{}; });
  const auto before_levels = intensity_pyramid(before.grey, 2);
  const auto depth = depth_pyramid(before.depth_m, 2);
  const Gradient gradient = gradient_of(before_levels[1]);
  const ColorLevel level{&depth[1],    &before_levels[1], &before_levels[1],
                         &gradient.dx, &gradient.dy,      camera_of_level(camera, 1)};
  const ColorMatching matching{0.3, 1.0, 0.0, 0.2, 8.0};
  const Workers workers(2);
  const auto cost_at = [&](const SE3& pose) { return match_color(level, pose, SE3{}, matching, workers); };
  const SE3 off{so3_exp({0.002, -0.003, 0.002}), {0.004, 0.003, -0.004}};
  const PoseSums here = cost_at(off);
  ASSERT_GT(here.pixels, 1000);
  Vector6d slope;
  for (int axis = 0; axis < 6; ++axis) {
    constexpr double kStep = 5e-4;
    Vector6d d = Vector6d::Zero();
    d[axis] = kStep;
    slope[axis] = (cost_at(camera_after(off, d)).cost - cost_at(camera_after(off, -d)).cost) / (2 * kStep);
  }
  // Sobel's gradient is smaller than that of the bilinear interpolant, and points the same way.
  const double cosine = -here.descent.dot(slope) / (here.descent.norm() * slope.norm());
  EXPECT_GT(cosine, 0.98);
  EXPECT_NEAR(here.descent.norm() / slope.norm(), 0.85, 0.15);
}

TEST(DepthPyramid, SkipsWhatWasNotMeasured) {
  DepthImage image(4, 2);
  image.data = {1, 0, 0, 0, 3, 0, 0, 0};
  const auto levels = depth_pyramid(image, 2);
  ASSERT_EQ(levels.size(), 2U);
  EXPECT_EQ(levels[1].width, 2);
  EXPECT_FLOAT_EQ(levels[1](0, 0), 2);
  EXPECT_FLOAT_EQ(levels[1](1, 0), 0);
}

}  // namespace
}  // namespace fusebench
