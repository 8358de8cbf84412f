#include "core/systems/elasticfusion/deformation/view_registration.hpp"

#include <gtest/gtest.h>

#include "tests/core/systems/elasticfusion/room_views.hpp"

namespace fusebench {

using namespace systems::elasticfusion;

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
  [[nodiscard]] double error_m(const surfels::SurfelView& live, config::PeerDefects defects) const {
    config::ElasticfusionConfig config;
    config.defects = defects;
    const auto motion = deformation::register_view(live, testing::view_of(testing::live_at(SE3{}, workers_)),
                                                   config, workers_);
    return (motion.T_view_camera.translation - T_model_live_.translation).norm();
  }

  Workers workers_{2};
  SE3 T_model_live_{so3_exp({0.004, -0.006, 0.003}), {0.006, -0.004, 0.008}};
  surfels::SurfelView live_ = testing::view_of(testing::live_at(T_model_live_, workers_));
};

TEST_F(ViewRegistration, FindsTheMotionBetweenTwoViews) { EXPECT_LT(error_m(live_, testing::kFixed), 5e-4); }

TEST_F(ViewRegistration, HolesAreNotBlackThings) {
  const surfels::SurfelView patches = in_patches(live_);
  const double fixed_m = error_m(patches, testing::kFixed);
  EXPECT_LT(fixed_m, 1e-3);
  EXPECT_GT(error_m(patches, config::PeerDefects::as_published), 2 * fixed_m);
}

}  // namespace
}  // namespace fusebench
