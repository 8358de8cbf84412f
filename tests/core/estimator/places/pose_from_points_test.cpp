#include "core/estimator/places/pose_from_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/base/solvers.hpp"
#include "core/config/groups/relocalisation_config.hpp"

namespace fusebench {

using namespace places;

namespace {

constexpr PinholeCamera kCamera{640, 480, 520, 520, 319.5, 239.5};

/// Points in front of a camera, their projections, and the true pose.
struct Scene {
  SE3 T_a_camera{so3_exp({0.5, -0.8, 2.0}), {1.0, -2.0, 0.5}};
  std::vector<SeenPoint> seen;
  std::mt19937 random{11};

  double uniform(double low, double high) { return std::uniform_real_distribution(low, high)(random); }
  Vector2d pixel() { return {uniform(0, 639), uniform(0, 479)}; }
  void add(int count, double near_m, double far_m, double noise_px = 0) {
    std::normal_distribution<double> normal(0, 1);
    for (int i = 0; i < count; ++i) {
      const Vector2d p = pixel();
      const double scale = i % 2 == 0 ? 1.0 : 2.0;
      const Vector3d point = kCamera.back_project(p.x(), p.y(), uniform(near_m, far_m));
      const Vector2d error(normal(random), normal(random));
      seen.push_back({T_a_camera * point, p + noise_px * scale * error, scale});
    }
  }
  void add_wrong(int count) {
    for (int i = 0; i < count; ++i) {
      const Vector2d p = pixel();
      const Vector3d point = kCamera.back_project(p.x(), p.y(), uniform(1, 4));
      seen.push_back({T_a_camera * point, pixel(), 1.0});
    }
  }
  [[nodiscard]] Vector6d error(const SE3& found) const { return pose_minus(T_a_camera, found); }
};

TEST(PoseFromPoints, IsExactForExactPointsInDepthAndOnAPlane) {
  for (const double depth_range_m : {3.0, 0.0}) {
    Scene scene;
    scene.add(40, 1.5, 1.5 + depth_range_m);
    const auto found = pose_from_points(scene.seen, kCamera);
    ASSERT_TRUE(found);
    EXPECT_LT(scene.error(found->T_a_camera).norm(), 1e-8) << depth_range_m;
    EXPECT_EQ(found->inliers.size(), 40U);
    EXPECT_LT(found->rms_px, 1e-6);
  }
}

TEST(PoseFromPoints, RejectsTwoThirdsOfWrongPoints) {
  Scene scene;
  scene.add_wrong(80);
  scene.add(40, 1, 4);
  const auto found = pose_from_points(scene.seen, kCamera);
  ASSERT_TRUE(found);
  // A wrong point may lie within three pixels of its place by chance, 1 in 10000, or pull a little.
  EXPECT_LT(scene.error(found->T_a_camera).norm(), 1e-6);
  ASSERT_GE(found->inliers.size(), 40U);
  EXPECT_LE(found->inliers.size(), 41U);
  for (std::size_t i = 80; i < 120; ++i)
    EXPECT_TRUE(std::binary_search(found->inliers.begin(), found->inliers.end(), i));
}

TEST(PoseFromPoints, TheCovarianceIsThatOfTheError) {
  // Mean of the squared, whitened error: 6 for an honest covariance.
  double sum = 0;
  constexpr int kRuns = 300;
  for (int run = 0; run < kRuns; ++run) {
    Scene scene;
    scene.random.seed(static_cast<unsigned>(run));
    scene.add(60, 1, 4, 0.5);
    const auto found = pose_from_points(scene.seen, kCamera);
    ASSERT_TRUE(found);
    const Vector6d error = scene.error(found->T_a_camera);
    sum += error.dot(found->covariance.ldlt().solve(error));
  }
  EXPECT_GT(sum / kRuns, 5.2);
  EXPECT_LT(sum / kRuns, 7.0);
}

TEST(PoseFromPoints, TheCovarianceOfFewPointsAllowsForTheirEstimatedNoise) {
  // 10 points leave n = 20 - 6 degrees of freedom to estimate the variance: the squared, whitened error is
  // six times an F variable, of mean n / (n - 2).
  double sum = 0;
  int found_runs = 0;
  for (int run = 0; run < 600; ++run) {
    Scene scene;
    scene.random.seed(static_cast<unsigned>(1000 + run));
    scene.add(10, 1, 4, 0.2);
    const auto found = pose_from_points(scene.seen, kCamera);
    if (!found) continue;
    const Vector6d error = scene.error(found->T_a_camera);
    sum += error.dot(found->covariance.ldlt().solve(error));
    ++found_runs;
  }
  EXPECT_GT(found_runs, 590);
  EXPECT_GT(sum / found_runs, 6.2);
  EXPECT_LT(sum / found_runs, 8.2);
}

TEST(PoseFromPoints, PointsWithinThreeStandardDeviationsAreInliers) {
  Scene scene;
  scene.add(100, 1, 4, 1.0);
  const auto found = pose_from_points(scene.seen, kCamera);
  ASSERT_TRUE(found);
  // For a two-dimensional error with one pixel of noise, 99 % are within three pixels.
  EXPECT_GT(found->inliers.size(), 90U);
}

TEST(PoseFromPoints, ChanceAgreesOnLittle) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    Scene scene;
    scene.random.seed(seed);
    scene.add_wrong(150);
    const auto found = pose_from_points(scene.seen, kCamera);
    if (found) {
      EXPECT_LT(found->inliers.size(), 12U);
    }
  }
}

TEST(PoseFromPoints, PointsBehindTheCameraDoNotCount) {
  Scene scene;
  scene.add(30, 1, 4);
  // Mirrored through the optical centre they project to the same pixels.
  for (std::size_t i = 0; i < 20; ++i) {
    const Vector3d point_camera = scene.T_a_camera.inverse() * scene.seen[i].point_a;
    scene.seen.push_back({scene.T_a_camera * Vector3d(-point_camera), scene.seen[i].pixel_px, 1.0});
  }
  const auto found = pose_from_points(scene.seen, kCamera);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->inliers.size(), 30U);
  EXPECT_EQ(found->inliers.back(), 29U);
}

TEST(PoseFromPoints, TooFewOrDegeneratePointsGiveNothing) {
  EXPECT_FALSE(pose_from_points({}, kCamera));
  Scene few;
  few.add(5, 1, 4);
  EXPECT_FALSE(pose_from_points(few.seen, kCamera));
  Scene same;
  same.add(1, 1, 4);
  same.seen.resize(30, same.seen.front());
  const auto found = pose_from_points(same.seen, kCamera);
  EXPECT_FALSE(found) << "one point, thirty times";
}

TEST(PoseFromPoints, TheSamePointsGiveTheSameBits) {
  Scene scene;
  scene.add_wrong(30);
  scene.add(50, 1, 4, 1.0);
  const auto a = pose_from_points(scene.seen, kCamera);
  const auto b = pose_from_points(scene.seen, kCamera);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->T_a_camera.translation, b->T_a_camera.translation);
  EXPECT_EQ(a->T_a_camera.rotation.coeffs(), b->T_a_camera.rotation.coeffs());
  EXPECT_EQ(a->covariance, b->covariance);
}

}  // namespace
}  // namespace fusebench
