#include "core/estimator/places/place_certainty.hpp"

#include <gtest/gtest.h>

#include <random>

#include "core/config/groups/relocalisation_config.hpp"

namespace fusebench {

using namespace places;

namespace {

constexpr PinholeCamera kCertaintyCamera{640, 480, 520, 520, 319.5, 239.5};

/// Points in a part of the image.
struct View {
  double width_px = 640;
  double height_px = 480;
  int right = 40;
  int wrong = 20;
  double noise_px = 0.5;
  double scale = 1;         ///< pixels that corners are wide
  double distance_m = 2.0;  ///< scales the whole scene
};

bool is_certain(const View& view, const config::RelocalisationConfig& config = {}) {
  std::mt19937 random(7);
  const auto uniform = [&](double high) { return std::uniform_real_distribution(0.0, high)(random); };
  std::normal_distribution<double> normal(0, view.noise_px);
  std::vector<SeenPoint> seen;
  for (int i = 0; i < view.right + view.wrong; ++i) {
    const Vector2d p(uniform(view.width_px), uniform(view.height_px));
    const Vector3d point =
        kCertaintyCamera.back_project(p.x(), p.y(), view.distance_m * (0.75 + uniform(0.5)));
    const Vector2d error(normal(random), normal(random));
    const Vector2d off =
        i < view.right ? error : Vector2d(0.5 * kCertaintyCamera.width_px, 20.0 + uniform(100));
    seen.push_back({point, p + off, view.scale});
  }
  const auto pose = pose_from_points(seen, kCertaintyCamera);
  return pose && is_certain_place(seen, *pose, kCertaintyCamera, config);
}

TEST(PlaceCertainty, AWholeViewIsCertainAtAnyDistance) {
  EXPECT_TRUE(is_certain({}));
  EXPECT_TRUE(is_certain({.distance_m = 0.5}));
  EXPECT_TRUE(is_certain({.distance_m = 40}));
  EXPECT_TRUE(is_certain({.width_px = 320, .right = 80})) << "a hand covers half of it";
}

TEST(PlaceCertainty, FewPointsAreNot) { EXPECT_FALSE(is_certain({.right = 20, .wrong = 0})); }

TEST(PlaceCertainty, RequiresTheConfiguredNumberOfPoints) {
  using config::RelocalisationConfig;
  EXPECT_TRUE(is_certain({.right = 20, .wrong = 0}, RelocalisationConfig{.min_inliers = 20}));
  EXPECT_FALSE(is_certain({}, RelocalisationConfig{.min_inliers = 60}));
}

TEST(PlaceCertainty, ASmallShareIsNot) { EXPECT_FALSE(is_certain({.right = 40, .wrong = 120})); }

TEST(PlaceCertainty, OneCornerIsNot) {
  EXPECT_FALSE(is_certain({.width_px = 300, .height_px = 230, .right = 200, .noise_px = 0.05}));
}

TEST(PlaceCertainty, WhatLeavesThePoseVagueIsNot) {
  // Coarse corners in a band.
  const View strip{.width_px = 480, .height_px = 130, .right = 28, .wrong = 10, .noise_px = 4, .scale = 4};
  EXPECT_FALSE(is_certain(strip));
  View near = strip;
  near.distance_m = 0.5;
  EXPECT_FALSE(is_certain(near)) << "a share of the distance, not a length";
  View exact = strip;
  exact.noise_px = 0.4;
  EXPECT_TRUE(is_certain(exact)) << "else it is refused for something else";
}

}  // namespace
}  // namespace fusebench
