#include "eval/run/preparation/depth_camera.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "eval/run/preparation/preparation.hpp"
#include "tests/support/two_cameras.hpp"

namespace fusebench {

using namespace preparation;

namespace {

constexpr PinholeCamera kColor{320, 240, 262.5, 262.5, 159.5, 119.5};

calibration::DepthCamera other_camera() {
  calibration::DepthCamera depth{{320, 240, 290.0, 290.0, 163.0, 116.0}, SE3{}};
  depth.T_color_depth.translation = {-0.03, 0.01, 0};
  return depth;
}

/// One frame of the textured room, whose depth is of other_camera() and read as if it were registered.
recording::Recording unregistered() {
  recording::Recording recording;
  recording.rig.camera = kColor;
  recording.calibration = calibration::RigCalibration{};
  recording.calibration->color.pinhole = kColor;
  recording.load_frame = [](std::size_t) -> Result<RgbdFrame> {
    RgbdFrame frame;
    frame.depth_m =
        testing::exact_depth(testing::TexturedRoom(), other_camera().pinhole, other_camera().T_color_depth);
    return frame;
  };
  return recording;
}

MeasuredDepthCamera measured(bool is_used) {
  MeasuredDepthCamera result;
  result.as_read = {kColor, SE3{}};
  result.fitted = other_camera();
  result.sigma = {0.6, {1.2, 1.3}, {0.002, 0.003}};
  result.moved_px = 14;
  result.sigma_px = 0.5;
  result.is_used = is_used;
  return result;
}

/// Of pixels with depth: within 1 % of the depth that the colour camera sees.
double right_share(const DepthImage& depth_m) {
  const DepthImage exact_m = testing::exact_depth(testing::TexturedRoom(), kColor, SE3{});
  double right = 0, all = 0;
  for (std::size_t i = 0; i < depth_m.data.size(); ++i) {
    if (!(depth_m.data[i] > 0)) continue;
    ++all;
    if (std::abs(depth_m.data[i] - exact_m.data[i]) < 0.01F * exact_m.data[i]) ++right;
  }
  return right / all;
}

TEST(DepthCamera, RegistersDepthOfAnotherCamera) {
  recording::Recording recording = unregistered();
  const double before = right_share(recording.load_frame(0)->depth_m);
  use_depth_camera(recording, measured(true));
  const double after = right_share(recording.load_frame(0)->depth_m);
  EXPECT_GT(after, 0.98);
  EXPECT_LT(1 - after, 0.3 * (1 - before));
  ASSERT_TRUE(recording.calibration->depth);
  EXPECT_EQ(recording.calibration->depth->pinhole.fx_px, 290);
  ASSERT_EQ(recording.notes.size(), 1U);
  EXPECT_EQ(
      recording.notes[0],
      "prepared: depth camera: focal length 290.0 +- 0.6 px, centre (163.0 +- 1.2, 116.0 +- 1.3) px, at "
      "(-30.0 +- 2.0, 10.0 +- 3.0) mm of colour; edges of depth move 14.0 +- 0.5 px; used in place of "
      "the calibration's");
}

TEST(DepthCamera, KeepsACalibrationThatIsNotContradicted) {
  recording::Recording recording = unregistered();
  const DepthImage before = recording.load_frame(0)->depth_m;
  use_depth_camera(recording, measured(false));
  EXPECT_EQ(recording.load_frame(0)->depth_m.data, before.data);
  EXPECT_FALSE(recording.calibration->depth);
  EXPECT_TRUE(recording.notes.empty());
}

TEST(DepthCamera, IsUsedIfItMovesEdgesByMoreThanTheirUncertainty) {
  inspection::measures::RegistrationFit fit;
  fit.gain_sigmas = 20;
  fit.moved_px = 24;
  fit.sigma_px = 0.5;
  EXPECT_TRUE(measured_depth_camera(fit).is_used);
  fit.moved_px = 2;
  EXPECT_FALSE(measured_depth_camera(fit).is_used) << "edges of registered depth lie 2 px aside";
  fit.moved_px = 24;
  fit.sigma_px = 10;
  EXPECT_FALSE(measured_depth_camera(fit).is_used);
  fit.sigma_px = 0.5;
  fit.gain_sigmas = 3;
  EXPECT_FALSE(measured_depth_camera(fit).is_used);
}

TEST(DepthCamera, IsReadBackAsItWasKept) {
  const MeasuredDepthCamera kept = measured(true);
  const MeasuredDepthCamera read = depth_camera_of(json_of(kept));
  EXPECT_EQ(json_of(read), json_of(kept));
  EXPECT_EQ(to_line(read), to_line(kept));
}

}  // namespace
}  // namespace fusebench
