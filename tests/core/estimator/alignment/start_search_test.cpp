#include "core/estimator/alignment/start_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/config/groups/alignment_config.hpp"
#include "core/config/groups/filter_config.hpp"
#include "core/config/groups/residuals_config.hpp"
#include "core/estimator/filter/pose_clones.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace alignment;

namespace {

/// The groups of options that these tests need.
struct SearchOptions {
  config::AlignmentConfig alignment;
  int patch_levels = 3;
  config::PhotometricConfig photometric;
  config::IekfConfig iekf;
};

/// Prediction of a camera at rest at the origin, with an uncertain pose.
filter::GaussianState prediction(const SensorRig& rig, double sigma_rad, double sigma_m) {
  filter::GaussianState prior;
  prior.mean.T_world_imu = prior.mean.T_world_imu_reference = rig.T_imu_camera.inverse();
  prior.covariance.diagonal().segment<3>(filter::kRotation).setConstant(sigma_rad * sigma_rad);
  prior.covariance.diagonal().segment<3>(filter::kPosition).setConstant(sigma_m * sigma_m);
  return prior;
}

struct Search {
  explicit Search(const SE3& T_world_camera_in) : T_world_camera(T_world_camera_in) {
    rig.camera = testing::small_camera();
    rig.T_imu_camera = {so3_exp({0.1, -0.2, 0.3}), {0.02, -0.01, 0.03}};
    const RgbdFrame first = room.render(rig.camera, SE3{}, 0);
    reference.take(build_pyramid(first.grey, levels()), first.depth_m, rig.camera, config.alignment);
    frame = room.render(rig.camera, T_world_camera, 0);
  }

  [[nodiscard]] int levels() const {
    return pyramid_levels(rig.camera, config.patch_levels, config.alignment);
  }

  FoundStart find(const filter::GaussianState& prior, bool thorough = false) {
    const std::vector<GreyImage> pyramid = build_pyramid(frame.grey, levels());
    return StartSearch(config.alignment, config.patch_levels, config.photometric, config.iekf, rig)
        .find(prior, prior.mean.T_world_imu_reference, reference, pyramid, thorough);
  }

  /// Error of the pose of a start, in pixels at 1 m.
  double error_px(const filter::GaussianState& prior, const FoundStart& found) const {
    const filter::StateVector delta =
        prior.covariance * filter::measured_combinations(prior.mean).transpose() * found.start;
    const SE3 T_camera = filter::plus(prior.mean, delta).T_world_imu * rig.T_imu_camera;
    const SE3 off = T_camera.inverse() * T_world_camera;
    return rig.camera.fx_px *
           (rotation_angle_rad(off.rotation, Quaterniond::Identity()) + off.translation.norm());
  }

  SearchOptions config;
  SensorRig rig;
  testing::TexturedRoom room;
  SE3 T_world_camera;
  ReferencePoints reference;
  RgbdFrame frame;
};

TEST(StartSearch, NothingIsSearchedWhereThePredictionIsNearEnough) {
  Search search(SE3(so3_exp({0, 0.01, 0}), Vector3d::Zero()));
  const FoundStart found = search.find(prediction(search.rig, 0.01, 0.005));
  EXPECT_EQ(found.coarsest_level, -1);
  EXPECT_TRUE(found.start.isZero());
  EXPECT_NEAR(found.landing_sigma_px, 0.01 * 240, 2.0);
}

/// A turn by phi about y moves the pixel of a ray (x, y, 1) by f (1 + x^2) phi and f x y phi.
TEST(StartSearch, TheSpreadOfTheLandingIsThatAlongItsLongerAxis) {
  Search search(SE3{});
  search.rig.T_imu_camera = SE3{};
  filter::GaussianState prior = prediction(search.rig, 0, 0);
  constexpr double kSigma_rad = 0.01;
  prior.covariance(filter::kRotation + 1, filter::kRotation + 1) = kSigma_rad * kSigma_rad;
  const double f = search.rig.camera.fx_px;
  double sum = 0;
  const auto points = search.reference.level(search.reference.coarsest_level());
  for (const ReferencePoint& point : points) {
    const double x = point.point_camera.x() / point.point_camera.z();
    const double y = point.point_camera.y() / point.point_camera.z();
    sum += f * f * kSigma_rad * kSigma_rad * ((1 + x * x) * (1 + x * x) + x * x * y * y);
  }
  const double expected_px = std::sqrt(sum / static_cast<double>(points.size()));
  EXPECT_NEAR(landing_sigma_px(prior, search.reference, search.rig), expected_px, 1e-6 * expected_px);
}

TEST(StartSearch, AQuickTurnIsFoundFromAWidePrediction) {
  // 20 pixels, twice the size of a patch.
  Search search(SE3(so3_exp({0.03, 0.08, -0.02}), {0.02, 0.0, 0.03}));
  const filter::GaussianState prior = prediction(search.rig, 0.08, 0.05);
  const FoundStart found = search.find(prior);
  EXPECT_GE(found.coarsest_level, 3);
  EXPECT_LT(search.error_px(prior, found), 3.0);
}

TEST(StartSearch, ADimmerLightDoesNotMoveIt) {
  Search search(SE3(so3_exp({0.03, 0.08, -0.02}), {0.02, 0.0, 0.03}));
  for (std::uint8_t& grey : search.frame.grey.data) grey = static_cast<std::uint8_t>(0.85 * grey + 12);
  const filter::GaussianState prior = prediction(search.rig, 0.08, 0.05);
  EXPECT_LT(search.error_px(prior, search.find(prior)), 3.0);
}

TEST(StartSearch, ACameraThatStoppedIsFoundAlthoughItWasPredictedToGoOn) {
  Search search{SE3{}};
  filter::GaussianState prior = prediction(search.rig, 0.1, 0.05);
  prior.mean.T_world_imu.rotation =
      prior.mean.T_world_imu.rotation * so3_exp({0.0, 0.25, 0.1});  // 60 pixels further away
  EXPECT_LT(search.error_px(prior, search.find(prior)), 2.0);
}

TEST(StartSearch, AThoroughOneDoesNotAskThePrior) {
  Search search(SE3(so3_exp({0, 0.01, 0}), Vector3d::Zero()));
  const filter::GaussianState prior = prediction(search.rig, 0.01, 0.005);
  const FoundStart found = search.find(prior, true);
  EXPECT_EQ(found.coarsest_level, search.reference.coarsest_level());
  EXPECT_LT(search.error_px(prior, found), 1.0);
}

TEST(StartSearch, AStartAtAPoseIsThere) {
  const Search search{SE3{}};
  filter::GaussianState prior = prediction(search.rig, 0.1, 0.05);
  const SE3 wanted =
      pose_plus(prior.mean.T_world_imu, (Vector6d() << 0.02, -0.1, 0.05, 0.1, 0.0, -0.03).finished());
  const filter::MeasuredVector y = filter::start_at(prior, wanted);
  const filter::StateVector delta =
      prior.covariance * filter::measured_combinations(prior.mean).transpose() * y;
  EXPECT_LT(pose_minus(filter::plus(prior.mean, delta).T_world_imu, wanted).norm(), 1e-5);
}

}  // namespace
}  // namespace fusebench
