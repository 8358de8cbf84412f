#include "core/estimator/places/landmarks.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "core/config/groups/relocalisation_config.hpp"
#include "core/estimator/places/pose_from_points.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace places;
using testing::TexturedRoom;

namespace {

constexpr int kMostFeatures = 300;
constexpr config::PlaceFeaturesConfig kFeatureOptions{};

PinholeCamera camera_of(int width_px) {
  const PinholeCamera small = testing::small_camera();
  const double factor = static_cast<double>(width_px) / small.width_px;
  PinholeCamera camera = small;
  camera.width_px = width_px;
  camera.height_px = static_cast<int>(factor * small.height_px);
  camera.fx_px *= factor;
  camera.fy_px *= factor;
  camera.cx_px *= factor;
  camera.cy_px *= factor;
  return camera;
}

Landmarks seen_from(const SE3& T_room_camera, const PinholeCamera& camera) {
  const RgbdFrame frame = TexturedRoom{}.render(camera, T_room_camera, 0);
  return coarse_landmarks_of(frame.grey, frame.depth_m, camera, kMostFeatures, kFeatureOptions, {});
}

TEST(CoarseLandmarks, GiveThePoseOfAnotherView) {
  for (const int width_px : {320, 640}) {
    const PinholeCamera camera = camera_of(width_px);
    const SE3 T_known_query{so3_exp({0.03, -0.08, 0.05}), {0.1, -0.05, 0.08}};
    const Landmarks known = seen_from({}, camera);
    const Landmarks query = seen_from(T_known_query, camera);
    EXPECT_LE(known.features.size(), static_cast<std::size_t>(kMostFeatures));
    std::vector<SeenPoint> seen;
    for (const FeatureMatch& match : match_features(query.features, known.features, kFeatureOptions))
      seen.push_back({known.points_camera[match.known], query.features[match.query].pixel_px,
                      query.features[match.query].scale});
    const auto pose = pose_from_points(seen, camera);
    ASSERT_TRUE(pose) << width_px;
    EXPECT_GT(pose->inliers.size(), 0.5 * static_cast<double>(seen.size()));
    EXPECT_LT((pose->T_a_camera.translation - T_known_query.translation).norm(), 0.02) << width_px;
    EXPECT_LT(rotation_angle_rad(pose->T_a_camera.rotation, T_known_query.rotation), radians(0.6));
  }
}

TEST(CoarseLandmarks, ArePixelsOfTheWholeImage) {
  const PinholeCamera camera = camera_of(640);
  const Landmarks landmarks = seen_from({}, camera);
  ASSERT_GT(landmarks.features.size(), 50U);
  double farthest_px = 0;
  for (std::size_t i = 0; i < landmarks.features.size(); ++i) {
    const PlaceFeature& feature = landmarks.features[i];
    EXPECT_LT((camera.project(landmarks.points_camera[i]) - feature.pixel_px).norm(), 1e-9);
    EXPECT_GE(feature.scale, 2) << "of the image at half its size";
    farthest_px = std::max(farthest_px, feature.pixel_px.x());
  }
  EXPECT_GT(farthest_px, 320);
}

}  // namespace
}  // namespace fusebench
