#include "core/estimator/places/landmarks.hpp"

#include <cmath>

#include "core/config/groups/relocalisation_config.hpp"

namespace fusebench::places {

namespace {

Landmarks with_depth(const std::vector<PlaceFeature>& features, const DepthImage& depth_m,
                     const PinholeCamera& camera, const config::RelocalisationConfig& config) {
  Landmarks landmarks;
  for (const PlaceFeature& feature : features) {
    const double z_m = landmark_depth_m(depth_m, feature.pixel_px, config);
    if (z_m <= 0) continue;
    landmarks.features.push_back(feature);
    landmarks.points_camera.push_back(camera.back_project(feature.pixel_px.x(), feature.pixel_px.y(), z_m));
  }
  return landmarks;
}

}  // namespace

double landmark_depth_m(const DepthImage& depth_m, const Vector2d& pixel_px,
                        const config::RelocalisationConfig& config) {
  const auto edge_jump = static_cast<float>(config.landmark_edge_jump);
  const auto x = static_cast<int>(std::lround(pixel_px.x()));
  const auto y = static_cast<int>(std::lround(pixel_px.y()));
  if (!depth_m.contains(x - 1, y - 1) || !depth_m.contains(x + 1, y + 1)) return 0;
  const float centre_m = depth_m(x, y);
  if (!(centre_m > 0)) return 0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const float m = depth_m(x + dx, y + dy);
      if (m > 0 && std::abs(m - centre_m) > edge_jump * centre_m) return 0;
    }
  }
  return static_cast<double>(centre_m);
}

Landmarks landmarks_of(const GreyImage& grey, const DepthImage& depth_m, const PinholeCamera& camera,
                       const config::PlaceFeaturesConfig& features,
                       const config::RelocalisationConfig& relocalisation) {
  return with_depth(find_place_features(grey, features), depth_m, camera, relocalisation);
}

Landmarks coarse_landmarks_of(const GreyImage& grey, const DepthImage& depth_m, const PinholeCamera& camera,
                              int max_count, const config::PlaceFeaturesConfig& features,
                              const config::RelocalisationConfig& relocalisation) {
  constexpr int kLeastWidth_px = 320;
  const bool halved = grey.width >= 2 * kLeastWidth_px;
  const GreyImage half = halved ? build_pyramid(grey, 2).back() : GreyImage{};
  const double step = halved ? 2.0 : 1.0;
  config::PlaceFeaturesConfig fewer = features;
  fewer.max_count = max_count;
  std::vector<PlaceFeature> found = find_place_features(halved ? half : grey, fewer);
  for (PlaceFeature& feature : found) {
    feature.pixel_px *= step;
    feature.scale *= step;
  }
  return with_depth(found, depth_m, camera, relocalisation);
}

}  // namespace fusebench::places
