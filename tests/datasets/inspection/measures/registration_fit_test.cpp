#include "datasets/inspection/measures/registration_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/datasets/inspection/clean_recording.hpp"
#include "tests/support/two_cameras.hpp"

namespace fusebench {

using namespace inspection::measures;

namespace {

using testing::clean_recording;
using testing::SwayingMotion;

/// The clean recording with the depth images of a camera of its own, read as if they were registered.
recording::Recording unregistered(const calibration::DepthCamera& depth) {
  recording::Recording recording =
      clean_recording({.camera = testing::small_camera(), .truth = false, .imu = false});
  recording.load_frame = [depth, whole = recording.load_frame,
                          frames = recording.frames](std::size_t k) -> Result<RgbdFrame> {
    auto frame = whole(k);
    const SE3 T_world_color = SwayingMotion::T_world_camera(1e-9 * static_cast<double>(frames[k].capture_ns));
    frame->depth_m =
        testing::exact_depth(testing::TexturedRoom(), depth.pinhole, T_world_color * depth.T_color_depth);
    return frame;
  };
  return recording;
}

TEST(DepthEdges, LieOnTheBorderOfTheNearerSurface) {
  DepthImage depth_m(8, 3);
  std::ranges::fill(depth_m.data, 2.0F);
  for (int x = 0; x < 3; ++x) depth_m(x, 1) = 1.0F;
  depth_m(3, 1) = 0;  // the shaded side
  depth_m(4, 1) = 0;
  std::vector<DepthEdge> along_the_row;
  for (const DepthEdge& edge : depth_edges(depth_m)) {
    if (edge.upright) along_the_row.push_back(edge);
  }
  ASSERT_EQ(along_the_row.size(), 1U);
  EXPECT_FLOAT_EQ(along_the_row[0].x_px, 2.5F);
  EXPECT_FLOAT_EQ(along_the_row[0].y_px, 1.0F);
  EXPECT_FLOAT_EQ(along_the_row[0].depth_m, 1.0F);
}

TEST(DepthEdges, LevelBordersLieBetweenTheRows) {
  DepthImage depth_m(1, 4);
  depth_m.data = {3.0F, 3.0F, 1.0F, 1.0F};
  const std::vector<DepthEdge> edges = depth_edges(depth_m);
  ASSERT_EQ(edges.size(), 1U);
  EXPECT_FALSE(edges[0].upright);
  EXPECT_FLOAT_EQ(edges[0].y_px, 1.5F);
}

TEST(RegistrationModel, IsWhatParallelCamerasDo) {
  const PinholeCamera color = testing::small_camera();
  calibration::DepthCamera depth{{320, 240, 265.0, 265.0, 163.0, 116.0}, SE3{}};
  depth.T_color_depth.translation = {-0.03, 0.01, 0};
  RegistrationModel model;
  model.scale = color.fx_px / depth.pinhole.fx_px;
  model.shift_px =
      Vector2d(color.cx_px - depth.pinhole.cx_px, color.cy_px - depth.pinhole.cy_px) * model.scale;
  model.baseline_m = depth.T_color_depth.translation.head<2>();
  const Vector3d point_depth = depth.pinhole.back_project(250, 40, 1.7);
  const Vector2d moved = model.move({250, 40, 1.7F, true}, color);
  EXPECT_LT((moved - color.project(depth.T_color_depth * point_depth)).norm(), 1e-4);
  // And back: the camera that the model asks for is that camera.
  const calibration::DepthCamera fitted = fitted_depth_camera(model, color, {color, SE3{}});
  EXPECT_NEAR(fitted.pinhole.fx_px, depth.pinhole.fx_px, 1e-9);
  EXPECT_NEAR(fitted.pinhole.cx_px, depth.pinhole.cx_px, 1e-9);
  EXPECT_NEAR(fitted.pinhole.cy_px, depth.pinhole.cy_px, 1e-9);
  EXPECT_LT((fitted.T_color_depth.translation - depth.T_color_depth.translation).norm(), 1e-12);
  const RegistrationModel back = model_between({color, SE3{}}, fitted, color);
  EXPECT_NEAR(back.scale, model.scale, 1e-12);
  EXPECT_LT((back.shift_px - model.shift_px).norm(), 1e-9);
  EXPECT_LT((back.baseline_m - model.baseline_m).norm(), 1e-12);
}

TEST(RegistrationFit, FindsTheDepthCamera) {
  calibration::DepthCamera depth{{320, 240, 265.0, 265.0, 163.0, 116.0}, SE3{}};
  depth.T_color_depth.translation = {-0.03, 0, 0};
  const auto fit = fit_registration(unregistered(depth), Workers(2));
  ASSERT_TRUE(fit);
  EXPECT_GT(fit->moved_px, 8);
  EXPECT_LT(fit->sigma_px, 1.5);
  EXPECT_TRUE(fit->is_significant());
  EXPECT_TRUE(fit->is_determined()) << fit->gain_sigmas;
  EXPECT_GT(fit->strength_moved, 2 * fit->strength_as_read);
  const calibration::DepthCamera& fitted = fit->fitted;
  EXPECT_NEAR(fitted.pinhole.fx_px, 265, 3);
  const DepthCameraSigma& sigma = fit->fitted_sigma;
  EXPECT_LT(std::abs(fitted.pinhole.fx_px - 265), 3 * sigma.focal_length_px);
  EXPECT_LT(std::abs(fitted.T_color_depth.translation.x() + 0.03), 3 * sigma.place_m.x());
}

/// Registered depth that is taken `delay_s` after colour.
recording::Recording delayed(double delay_s) {
  recording::Recording recording =
      clean_recording({.camera = testing::small_camera(), .truth = false, .imu = false});
  recording.load_frame = [delay_s, whole = recording.load_frame, frames = recording.frames,
                          camera = recording.rig.camera](std::size_t k) -> Result<RgbdFrame> {
    auto frame = whole(k);
    const double time_s = 1e-9 * static_cast<double>(frames[k].capture_ns) + delay_s;
    frame->depth_m =
        testing::exact_depth(testing::TexturedRoom(), camera, SwayingMotion::T_world_camera(time_s));
    return frame;
  };
  return recording;
}

TEST(RegistrationFit, TellsADelayOfDepthFromAnotherCamera) {
  const auto fit = fit_registration(delayed(0.02), Workers(2));
  ASSERT_TRUE(fit);
  EXPECT_NEAR(std::abs(fit->delay_frames), 0.02 * 30, 0.25);
  EXPECT_FALSE(fit->is_significant()) << fit->moved_px;
}

TEST(RegistrationFit, LeavesRegisteredDepthAndDoesNotDependOnThreads) {
  const recording::Recording recording =
      clean_recording({.camera = testing::small_camera(), .truth = false, .imu = false});
  const auto one = fit_registration(recording, Workers(1));
  const auto two = fit_registration(recording, Workers(2));
  ASSERT_TRUE(one && two);
  EXPECT_LT(one->moved_px, 2);
  EXPECT_FALSE(one->is_significant());
  EXPECT_EQ(one->moved_px, two->moved_px);
  EXPECT_EQ(one->model.baseline_m, two->model.baseline_m);
}

TEST(RegistrationFit, ASingleViewDoesNotBecomeCertainByRepetition) {
  recording::Recording recording =
      clean_recording({.camera = testing::small_camera(), .truth = false, .imu = false});
  const auto moving = fit_registration(recording, Workers(2));
  recording.load_frame = [whole = recording.load_frame](std::size_t) { return whole(0); };
  const auto still = fit_registration(recording, Workers(2));
  ASSERT_TRUE(moving && still);
  EXPECT_GT(still->sigma_px, 1.5 * moving->sigma_px);
}

TEST(RegistrationFit, NeedsEdges) {
  recording::Recording recording =
      clean_recording({.camera = testing::small_camera(), .truth = false, .imu = false});
  recording.load_frame = [whole = recording.load_frame](std::size_t k) {
    auto frame = whole(k);
    std::ranges::fill(frame->depth_m.data, 1.0F);
    return frame;
  };
  EXPECT_FALSE(fit_registration(recording, Workers(1)));
}

}  // namespace
}  // namespace fusebench
