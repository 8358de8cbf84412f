#include "core/baselines/elasticfusion/deformation/view_registration.hpp"

#include <gtest/gtest.h>

#include "core/baselines/elasticfusion/tracking/camera_tracker.hpp"
#include "core/config/groups/systems_config.hpp"
#include "tests/core/baselines/elasticfusion/room_views.hpp"

namespace fusebench {

using namespace baselines::elasticfusion;

namespace {

/// A view of which only patches are there: squares of 24 pixels, each second one.
surfels::SurfelView in_patches(surfels::SurfelView view) {
  constexpr int kSide_px = 24;
  for (int y = 0; y < view.color.height; ++y) {
    for (int x = 0; x < view.color.width; ++x) {
      if ((x / kSide_px + y / kSide_px) % 2 == 0) continue;
      const std::size_t pixel = view.point.x.index(x, y);
      view.point.put(pixel, Eigen::Vector3f::Zero());
      view.normal.put(pixel, Eigen::Vector3f::Zero());
      view.color(x, y) = {};
    }
  }
  return view;
}

class ViewRegistration : public ::testing::Test {
 protected:
  [[nodiscard]] double error_m(const tracking::TrackedMotion& motion) const {
    return (motion.T_view_camera.translation - T_model_live_.translation).norm();
  }

  Workers workers_{2};
  config::ElasticfusionConfig config_;
  SE3 T_model_live_{so3_exp({0.004, -0.006, 0.003}), {0.006, -0.004, 0.008}};
  surfels::SurfelView live_ = testing::view_of(testing::live_at(T_model_live_, workers_));
  surfels::SurfelView model_ = testing::view_of(testing::live_at(SE3{}, workers_));
};

TEST_F(ViewRegistration, FindsTheMotionBetweenTwoViews) {
  EXPECT_LT(error_m(deformation::register_view(live_, model_, config_, workers_)), 5e-4);
}

TEST_F(ViewRegistration, HolesAreNotBlackSurfaces) {
  const surfels::SurfelView patches = in_patches(live_);
  const double found_m = error_m(deformation::register_view(patches, model_, config_, workers_));
  EXPECT_LT(found_m, 1e-3);
  const surfels::LiveFrame with_black{patches.point.z, patches.point.z, patches.normal, patches.color,
                                      surfels::intensity_of(patches.color, testing::kFixed)};
  const double with_black_m = error_m(tracking::CameraTracker(config_, workers_)
                                          .track(tracking::live_pyramid(with_black, patches.camera, workers_),
                                                 tracking::view_pyramid(model_, testing::kFixed), SE3{}));
  EXPECT_GT(with_black_m, 2 * found_m) << found_m;
}

}  // namespace
}  // namespace fusebench
