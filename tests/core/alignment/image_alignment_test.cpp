#include "core/alignment/image_alignment.hpp"

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
