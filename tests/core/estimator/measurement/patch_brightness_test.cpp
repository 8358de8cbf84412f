#include "core/estimator/measurement/patch_brightness.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cstdint>
#include <random>
#include <vector>

#include "core/config/groups/residuals_config.hpp"

namespace fusebench {

using namespace measurement;

namespace {

using Matrix8d = Eigen::Matrix<double, 8, 8>;
using Vector8d = Eigen::Matrix<double, 8, 1>;

// The quadratic cost of pose and brightness together, minimised over both, and over what is left of it.
TEST(PatchBrightness, EliminationKeepsTheOptimumOfPoseAndBrightness) {
  config::PhotometricConfig config;
  config.gain_sigma = 0.5;
  config.offset_sigma_grey = 2.0;
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 10; ++round) {
    Matrix8d root;
    Vector8d gradient;
    for (int i = 0; i < 8; ++i) {
      gradient[i] = normal(random);
      for (int j = 0; j < 8; ++j) root(i, j) = normal(random);
    }
    const Matrix8d information = root * root.transpose() + Matrix8d::Identity();  // pose, then brightness
    PatchBrightness light;
    light.value = {1.3, -0.7};
    light.information = information.bottomRightCorner<2, 2>();
    light.gradient = gradient.tail<2>();
    light.by_pose = information.bottomLeftCorner<2, 6>();
    filter::PoseQuadratic pose;
    pose.information = information.topLeftCorner<6, 6>();
    pose.gradient = gradient.head<6>();
    pose.cost = 7.0;
    BrightnessPrior(config).eliminate(light, pose);

    Matrix8d joint = information;
    Vector8d joint_gradient = gradient;
    const Vector2d prior(1 / (0.5 * 0.5), 1 / (2.0 * 2.0));
    joint.bottomRightCorner<2, 2>() += prior.asDiagonal().toDenseMatrix();
    joint_gradient.tail<2>() += prior.cwiseProduct(Vector2d(0.3, -0.7));
    const Vector8d optimum = -joint.ldlt().solve(joint_gradient);
    const Vector6d pose_step = -pose.information.ldlt().solve(pose.gradient);
    EXPECT_LT((pose_step - optimum.head<6>()).norm(), 1e-9 * optimum.norm());
    light.try_step(pose_step, 1.0);
    EXPECT_LT((light.trial - light.value - optimum.tail<2>()).norm(), 1e-9 * optimum.norm());
    light.try_step(pose_step, 0.25);
    EXPECT_LT((light.trial - light.value - 0.25 * optimum.tail<2>()).norm(), 1e-9 * optimum.norm());
    EXPECT_NEAR(pose.cost, 7.0 + 0.5 * (0.3 * 0.3 * prior.x() + 0.7 * 0.7 * prior.y()), 1e-12);
  }
}

/// Eight pixels a patch, all of one grey level, at pixel (8, 8) and around.
patches::LevelLanes patches_of(const std::vector<float>& grey) {
  patches::LevelLanes level;
  level.first.push_back(0);
  for (const float intensity : grey) {
    patches::PixelLanes pixels;
    pixels.intensity = simd::all_lanes(intensity);
    level.pixels.push_back(pixels);
    patches::WarpedLanes warped;
    warped.x = warped.y = simd::all_lanes(8.0F);
    warped.visible = warped.x > 0.0F;
    level.warped.push_back(warped);
    level.first.push_back(level.pixels.size());
  }
  return level;
}

GreyImage image_of(std::uint8_t grey) { return GreyImage(16, 16, grey); }

TEST(PatchBrightness, TheCommonGainIsTheMedianOfThePatches) {
  // A lamp that was switched on in front of two of them does not matter.
  EXPECT_NEAR(common_gain(patches_of({100, 100, 100, 20, 20, 100, 100}), image_of(150)), 1.5, 1e-6);
}

TEST(PatchBrightness, AFewPatchesOrDarkOnesGiveNoCommonGain) {
  EXPECT_EQ(common_gain(patches_of({100, 100, 100, 100}), image_of(150)), 1.0);
  EXPECT_EQ(common_gain(patches_of({100, 100, 100, 100, 100, 100}), image_of(2)), 1.0);
}

TEST(PatchBrightness, ThePriorFollowsTheCommonGainAndIsWiderThere) {
  const config::PhotometricConfig config;
  const BrightnessPrior same(config), brighter(config, 1.4);
  EXPECT_EQ(brighter.cost({1.4, 0}), 0.0);
  EXPECT_GT(same.cost({1.2, 0}), brighter.cost({1.6, 0}));
  EXPECT_GT(same.cost({1.0, 10}), brighter.cost({1.4, 10}));
  config::PhotometricConfig fixed;
  fixed.gain_sigma = fixed.offset_sigma_grey = 0;
  EXPECT_GT(BrightnessPrior(fixed, 1.4).cost({1.5, 0}), 1e12);
}

}  // namespace
}  // namespace fusebench
