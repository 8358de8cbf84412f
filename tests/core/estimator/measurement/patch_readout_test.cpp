#include "core/estimator/measurement/patch_readout.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "tests/support/numeric_jacobian.hpp"

namespace fusebench {

using namespace measurement;

namespace {

ReadoutMotion some_motion() {
  ReadoutMotion motion;
  motion.color_readout_s = 0.03;
  motion.depth_readout_s = 0.02;
  motion.depth_delay_s = -0.01;
  motion.rate << 0.5, -1.8, 0.7, 0.3, 0.2, -0.4;
  motion.reference_rate << 0.2, -1.1, 0.9, 0.1, 0.4, -0.2;
  motion.tells_color_readout = true;
  // The reference and the frames in the model were compensated by other read-outs, these from rest on.
  motion.supposed_s = {0.03, 0.02, -0.01};
  motion.reference_color_readout_s = 0.022;
  motion.model.rate << 0.4, -0.9, 0.2, 0.2, 0.3, -0.1;
  motion.model.by_readout = 0.014 * motion.model.rate;
  motion.model.by_delay = -0.004 * motion.model.rate;
  return motion;
}

/// Motion of a pose until the read-out of the row at `share` of the image height below the middle.
Vector6d moved(double share, double readout_s, double delay_s, const Vector6d& rate) {
  return (share * readout_s + delay_s) * rate;
}

/// Displacement of a patch's pose by errors of the read-out, if the images were compensated without them.
Vector6d displaced_color(const PatchRows& rows, const filter::ReadoutVector& errors) {
  const ReadoutMotion motion = some_motion();
  const double readout_s = motion.color_readout_s + errors[0];
  const double compensated_s = motion.color_readout_s - errors[3] * (motion.color_readout_s - 0.022);
  const auto rate = errors.segment<6>(4);
  return moved(rows.now, readout_s, 0, motion.rate + rate) -
         moved(rows.reference, readout_s, 0, motion.reference_rate) -
         (moved(rows.now, motion.color_readout_s, 0, motion.rate) -
          moved(rows.reference, compensated_s, 0, motion.reference_rate));
}
Vector6d displaced_depth(const PatchRows& rows, const filter::ReadoutVector& errors) {
  const ReadoutMotion motion = some_motion();
  const double readout_s = motion.depth_readout_s + errors[1];
  const double delay_s = motion.depth_delay_s + errors[2];
  const double compensated_readout_s = motion.depth_readout_s - errors[3] * (motion.depth_readout_s - 0.014);
  const double compensated_delay_s = motion.depth_delay_s - errors[3] * (motion.depth_delay_s + 0.004);
  return moved(rows.now, readout_s, delay_s, motion.rate + errors.tail<6>()) -
         moved(rows.now, readout_s, delay_s, motion.model.rate) -
         (moved(rows.now, motion.depth_readout_s, motion.depth_delay_s, motion.rate) -
          moved(rows.now, compensated_readout_s, compensated_delay_s, motion.model.rate));
}

TEST(PatchReadout, ErrorsDisplaceAPatchByTheMotionUntilItsRow) {
  for (const PatchRows& rows : {PatchRows{0.4, 0.3}, PatchRows{-0.5, -0.2}, PatchRows{0, 0.1}}) {
    const auto numeric = [&](const auto& displaced) {
      return testing::numeric_jacobian(
          [&](const auto& errors) -> Eigen::VectorXd { return displaced(rows, errors); },
          filter::kReadoutSize);
    };
    const auto color = color_displacement(some_motion());
    const auto depth = depth_displacement(some_motion());
    const Vector2d by_color = rows.color_weights();
    const Vector2d by_depth = rows.depth_weights();
    EXPECT_LT((by_color[0] * color[0] + by_color[1] * color[1] - numeric(displaced_color)).norm(), 1e-8);
    EXPECT_LT((by_depth[0] * depth[0] + by_depth[1] * depth[1] - numeric(displaced_depth)).norm(), 1e-8);
  }
}

TEST(PatchReadout, ColourOfTwoFramesInOneMotionGivesNoTiming) {
  ReadoutMotion motion = some_motion();
  motion.tells_color_readout = false;
  for (const PoseByReadout& map : color_displacement(motion)) EXPECT_EQ(map.col(0).norm(), 0.0);
}

TEST(PatchReadout, DepthAgainstAModelOfTheSameMotionGivesNoTiming) {
  ReadoutMotion motion = some_motion();
  motion.model = {motion.rate, motion.depth_readout_s * motion.rate, motion.depth_delay_s * motion.rate};
  for (const PoseByReadout& map : depth_displacement(motion))
    EXPECT_LT(map.leftCols<filter::kTimingSize + 1>().norm(), 1e-15);
}

TEST(PatchReadout, SumsAreTheDerivativesOfTheCost) {
  // Residuals r = H (pose + D errors) + r0 of some patches, each with a D of its own.
  struct Patch {
    Eigen::Matrix<double, 8, 6> H;
    Eigen::Matrix<double, 8, 1> r0;
    PatchRows rows;
  };
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::vector<Patch> patches(5);
  DisplacedPatches sum;
  constexpr double kVariance = 2.5;
  for (Patch& patch : patches) {
    patch.H = patch.H.NullaryExpr([&] { return normal(random); });
    patch.r0 = patch.r0.NullaryExpr([&] { return normal(random); });
    patch.rows = {0.3 * normal(random), 0.3 * normal(random)};
    sum.add({patch.H.transpose() * patch.H, patch.H.transpose() * patch.r0, 0}, patch.rows.depth_weights());
  }
  const auto maps = depth_displacement(some_motion());
  const auto gradient = [&](const Vector6d& pose, const filter::ReadoutVector& errors) {
    Eigen::Matrix<double, 6 + filter::kReadoutSize, 1> result;
    result.setZero();
    for (const Patch& patch : patches) {
      const PoseByReadout D = maps[0] + patch.rows.now * maps[1];
      const Vector6d by_pose = patch.H.transpose() * (patch.H * (pose + D * errors) + patch.r0) / kVariance;
      result.head<6>() += by_pose;
      result.tail<filter::kReadoutSize>() += D.transpose() * by_pose;
    }
    return result;
  };
  const filter::ReadoutQuadratic quadratic = sum.by_readout(maps, kVariance);
  const auto at_zero = gradient(Vector6d::Zero(), filter::ReadoutVector::Zero());
  EXPECT_LT((quadratic.gradient - at_zero.tail<filter::kReadoutSize>()).norm(), 1e-12);
  for (int i = 0; i < filter::kReadoutSize; ++i) {  // linear: a unit step is exact
    const auto change = (gradient(Vector6d::Zero(), filter::ReadoutVector::Unit(i)) - at_zero).eval();
    EXPECT_LT((quadratic.with_pose.col(i) - change.head<6>()).norm(), 1e-12) << i;
    EXPECT_LT((quadratic.information.col(i) - change.tail<filter::kReadoutSize>()).norm(), 1e-12) << i;
  }
}

}  // namespace
}  // namespace fusebench
