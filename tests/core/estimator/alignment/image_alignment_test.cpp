#include "core/estimator/alignment/image_alignment.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "core/config/groups/alignment_config.hpp"
#include "core/config/groups/residuals_config.hpp"
#include "tests/support/numeric_jacobian.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace alignment;

namespace {

/// The groups of options that these tests need.
struct AlignmentOptions {
  config::AlignmentConfig alignment;
  config::PhotometricConfig photometric;
};

constexpr int kLevels = 5;
constexpr int kPatchLevels = 3;

/// A reference frame at the origin and another frame, with their pyramids.
struct TwoFrames {
  explicit TwoFrames(const SE3& T_world_camera, const AlignmentOptions& config = AlignmentOptions{})
      : reference_frame(room.render(camera, SE3{}, 0)), frame(room.render(camera, T_world_camera, 0)) {
    rig.camera = camera;
    rig.T_imu_camera = {so3_exp({0.1, -0.2, 0.3}), {0.02, -0.01, 0.03}};
    reference.take(build_pyramid(reference_frame.grey, kLevels), reference_frame.depth_m, camera,
                   config.alignment);
    pyramid = build_pyramid(frame.grey, kLevels);
  }

  testing::TexturedRoom room;
  PinholeCamera camera = testing::small_camera();
  SensorRig rig;
  RgbdFrame reference_frame;
  RgbdFrame frame;
  ReferencePoints reference;
  std::vector<GreyImage> pyramid;
};

TEST(ImageAlignment, TheGradientIsThatOfTheCost) {
  AlignmentOptions config;
  config.alignment.coarsest_level = 3;
  config.photometric.gain_sigma = 0;  // fixed, so that brightness does not follow the pose
  config.photometric.offset_sigma_grey = 0;
  const TwoFrames frames(SE3(so3_exp({0.02, -0.03, 0.01}), {0.03, 0.01, -0.02}), config);
  ImageAlignment measurement(config.alignment, config.photometric, frames.rig);
  measurement.observe(frames.pyramid, frames.reference, SE3{}, 3);
  // Not at the reference itself, where pixels land on pixels and the interpolated image has a kink.
  const SE3 T_world_imu = pose_plus(frames.rig.T_imu_camera.inverse(), Vector6d::Constant(0.0031));
  const filter::MeasurementQuadratic at = measurement.linearise({T_world_imu, T_world_imu}, 0, false);
  const auto cost = [&](const Eigen::VectorXd& e) -> Eigen::VectorXd {
    const SE3 moved = pose_plus(T_world_imu, e);
    return Eigen::VectorXd::Constant(
        1, measurement.trial_cost({moved, moved}, filter::TangentVector::Zero(), 0.0));
  };
  const Eigen::MatrixXd numeric = testing::numeric_jacobian(cost, 6, 1e-7);
  EXPECT_LT(testing::relative_difference(at.by_reference.gradient.transpose(), numeric), 2e-3);
  EXPECT_NEAR(cost(Eigen::VectorXd::Zero(6))[0], at.by_reference.cost, 1e-9 * at.by_reference.cost);
  EXPECT_TRUE(at.by_model.information.isZero());
}

/// A constant grey level gives residuals that do not depend on the pose: each is the offset.
TEST(ImageAlignment, TheCostOfAUniformOffsetIsHubersOfEachPixel) {
  AlignmentOptions config;
  config.alignment.coarsest_level = 3;
  config.photometric.gain_sigma = 0;  // fixed
  config.photometric.offset_sigma_grey = 0;
  const TwoFrames frames(SE3{}, config);
  const double noise = config.photometric.noise_grey;
  const double bound = config.photometric.huber_sigmas;
  const std::size_t points = frames.reference.level(3).size();
  for (const int offset_grey : {1, 60}) {
    const GreyImage flat(40, 30, 100);
    std::vector<GreyImage> reference(4, flat);
    std::vector<GreyImage> seen(4, GreyImage(40, 30, static_cast<std::uint8_t>(100 + offset_grey)));
    ReferencePoints at;
    at.take(reference, frames.reference_frame.depth_m, frames.camera, config.alignment);
    ImageAlignment measurement(config.alignment, config.photometric, frames.rig);
    measurement.observe(seen, at, SE3{}, 3);
    const SE3 T_world_imu = frames.rig.T_imu_camera.inverse();
    const double cost = measurement.linearise({T_world_imu, T_world_imu}, 0, false).by_reference.cost;
    const double r = offset_grey / noise;
    const double each = r <= bound ? 0.5 * r * r : bound * r - 0.5 * bound * bound;
    const double seen_points = measurement.seen_share() * static_cast<double>(points);
    EXPECT_GT(measurement.seen_share(), 0.9);
    EXPECT_NEAR(cost / (each * seen_points / config.alignment.pixels_per_measurement), 1.0, 1e-9)
        << offset_grey;
  }
}

TEST(ImageAlignment, TheBrightnessFollowsADimmerImage) {
  AlignmentOptions config;
  config.alignment.coarsest_level = 3;
  config.photometric.gain_sigma = 10;  // free
  config.photometric.offset_sigma_grey = 1000;
  config.photometric.huber_sigmas = 1000;
  TwoFrames frames(SE3{}, config);
  for (std::uint8_t& grey : frames.pyramid[3].data) grey = static_cast<std::uint8_t>(0.8 * grey + 10);
  ImageAlignment measurement(config.alignment, config.photometric, frames.rig);
  measurement.observe(frames.pyramid, frames.reference, SE3{}, 3);
  const SE3 T_world_imu = frames.rig.T_imu_camera.inverse();
  const filter::PoseHypothesis poses{T_world_imu, T_world_imu};
  static_cast<void>(measurement.linearise(poses, 0, false));
  const double before = measurement.trial_cost(poses, filter::TangentVector::Zero(), 0.0);
  const double after = measurement.trial_cost(poses, filter::TangentVector::Zero(), 1.0);
  EXPECT_GT(before, 0);
  EXPECT_LT(after, 0.02 * before) << "grey levels are rounded";
}

TEST(ImageAlignment, ACoarsePointHasTheDepthOfTheNearestSurfaceUnderItsPixel) {
  AlignmentOptions config;
  config.alignment.coarsest_level = 3;
  const PinholeCamera camera = testing::small_camera();
  DepthImage depth_m(320, 240, 2.0F);
  depth_m(84, 84) = 1.0F;  // at the corner of the pixel (80, 80), which reaches four pixels far
  depth_m(160, 160) = 0.0F;
  const std::vector<GreyImage> pyramid = build_pyramid(GreyImage(320, 240, 90), kLevels);
  ReferencePoints reference;
  reference.take(pyramid, depth_m, camera, config.alignment);
  const auto depth_at = [&](int x, int y) {
    double nearest = 0;
    for (const ReferencePoint& point : reference.level(3)) {
      if ((camera.project(point.point_camera) - Vector2d(8 * x, 8 * y)).norm() < 0.1)
        nearest = point.point_camera.z();
    }
    return nearest;
  };
  EXPECT_EQ(depth_at(10, 10), 1.0);
  EXPECT_EQ(depth_at(11, 11), 1.0) << "its pixel begins there";
  EXPECT_EQ(depth_at(12, 10), 2.0);
  EXPECT_EQ(depth_at(20, 20), 2.0) << "missing depth is not near";
}

TEST(ImageAlignment, TheReferenceHasAPointForEachPixelWithDepth) {
  AlignmentOptions config;
  const TwoFrames frames(SE3{}, config);
  EXPECT_EQ(frames.reference.finest_level(), 3);
  EXPECT_EQ(frames.reference.coarsest_level(), 4);  // 320x240: level 5 has seven rows
  EXPECT_EQ(frames.reference.level(3).size(), 40U * 30U);
  EXPECT_EQ(frames.reference.level(4).size(), 20U * 15U);
}

TEST(ImageAlignment, ItCanBeSwitchedOff) {
  AlignmentOptions config;
  config.alignment.coarsest_level = 0;
  EXPECT_EQ(pyramid_levels(testing::small_camera(), kPatchLevels, config.alignment), kPatchLevels);
  const TwoFrames frames(SE3{}, config);
  EXPECT_TRUE(frames.reference.empty());
}

}  // namespace
}  // namespace fusebench
