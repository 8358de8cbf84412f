#include "core/baselines/elasticfusion/inertial_tracking.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/config/config.hpp"
#include "tests/support/tracked_system.hpp"

namespace fusebench {

using namespace baselines::elasticfusion;

namespace {

class InertialTerm : public ::testing::Test {
 protected:
  InertialTerm() {
    EXPECT_TRUE(inertial_.start(run_.frames[0].capture_ns()).has_value());
    EXPECT_TRUE(inertial_.predict(run_.frames[1].capture_ns()).has_value());
  }

  [[nodiscard]] Vector6d step(const tracking::ImageEquations& images) const {
    return InertialTracking::Term(inertial_, SE3{}).step(off_ * inertial_.T_world_camera(), images);
  }

  testing::SimulatedRun run_ = testing::simulate(2, {}, {0.15, 0.3, -0.2});
  config::Config config_ = testing::config_of_variant("elasticfusion-imu");
  InertialTracking inertial_{config_, run_.rig, run_.imu};
  SE3 off_{so3_exp({1e-4, -2e-4, 1e-4}), {1e-3, 2e-3, -1e-3}};  ///< from the prediction
};

/// Two kinds of residuals with mean squares of their own.
tracking::ImageEquations two_kinds_of_pixels() {
  Matrix6d depth = Matrix6d::Identity(), intensities = Matrix6d::Identity();
  depth.diagonal() << 4e5, 9e5, 1e3, 2e3, 1e3, 3e5;
  intensities.diagonal() << 2e4, 1e4, 5e4, 3e4, 8e3, 1e3;
  depth(0, 5) = depth(5, 0) = 1e4;
  intensities(1, 2) = intensities(2, 1) = -3e3;
  tracking::ImageEquations images;
  images.information = depth + intensities;
  images.descent << 30, -20, 10, 5, -8, 12;
  images.scatter = 1e-3 * depth + 0.2 * intensities;
  return images;
}

// Residuals in other units (millimetres, or grey levels to 1) are the same measurement.
TEST_F(InertialTerm, WeighsImagesByTheirErrorsAndNotByTheirUnits) {
  const tracking::ImageEquations images = two_kinds_of_pixels();
  const double unit = 30;
  const tracking::ImageEquations other{unit * unit * images.information, unit * unit * images.descent,
                                       std::pow(unit, 4) * images.scatter};
  const Vector6d expected = step(images);
  EXPECT_LT((step(other) - expected).norm(), 1e-6 * expected.norm());
  // Larger residuals count for less: the step comes nearer to that of the prediction alone.
  tracking::ImageEquations noisier = images;
  noisier.scatter *= 100;
  const Vector6d predicted = step({});
  EXPECT_LT((step(noisier) - predicted).norm(), (expected - predicted).norm());
}

TEST_F(InertialTerm, ReturnsThePredictionWithoutImageInformation) {
  const Vector6d back = step({});
  const SE3 reached = SE3{so3_exp(back.head<3>()), back.tail<3>()} * off_;
  EXPECT_LT(reached.translation.norm(), 1e-6);
  EXPECT_LT(rotation_angle_rad(reached.rotation, Quaterniond::Identity()), 1e-7);
}

}  // namespace
}  // namespace fusebench
