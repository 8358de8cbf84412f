#include "core/relocalisation/keyframes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "core/base/error.hpp"
#include "core/relocalisation/place_certainty.hpp"
#include "core/relocalisation/pose_from_points.hpp"

namespace fusebench::relocalisation {

namespace {

double angle_between_axes_rad(const SE3& a, const SE3& b) {
  const Vector3d axis_a = a.rotation * Vector3d::UnitZ();
  const Vector3d axis_b = b.rotation * Vector3d::UnitZ();
  return std::atan2(axis_a.cross(axis_b).norm(), axis_a.dot(axis_b));
}

/// The depth of a feature; 0 if it is at an edge of depth, where it may be that of the thing behind.
double feature_depth_m(const DepthImage& depth_m, const Vector2d& pixel_px,
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

/// A frame with so many corners of full resolution has enough features but in odd cases (all depth in one
/// corner of a richly textured image), so that they need not be looked for.
bool has_plenty_of_corners(const GreyImage& grey, const DepthImage& depth_m, const config::Config& config) {
  const std::vector<Vector2d> corners_px = find_corners(grey, config.place_features);
  const auto with_depth = std::count_if(corners_px.begin(), corners_px.end(), [&](const Vector2d& px) {
    return feature_depth_m(depth_m, px, config.relocalisation) > 0;
  });
  return with_depth >= config.relocalisation.plenty_of_corners;
}

std::vector<SeenPoint> seen_points(std::span<const PlaceFeature> query, const Landmarks& known,
                                   std::span<const FeatureMatch> matches) {
  std::vector<SeenPoint> seen;
  seen.reserve(matches.size());
  for (const FeatureMatch& m : matches)
    seen.push_back({known.points_camera[m.known], query[m.query].pixel_px, query[m.query].scale});
  return seen;
}

/// The pose by one keyframe, if it is certain.
std::optional<FoundPlace> place_by(std::span<const PlaceFeature> query, const Keyframe& keyframe,
                                   std::span<const FeatureMatch> matches, const PinholeCamera& camera,
                                   const config::Config& config) {
  const std::vector<SeenPoint> seen = seen_points(query, *keyframe.landmarks, matches);
  const auto pose = pose_from_points(seen, camera, config.place_pose);
  if (!pose || !is_certain_place(seen, *pose, camera, config.relocalisation)) return std::nullopt;
  FoundPlace found;
  found.T_world_camera = keyframe.T_world_camera * pose->T_a_camera;
  found.inliers = static_cast<int>(pose->inliers.size());
  found.matches = static_cast<int>(seen.size());
  found.rms_px = pose->rms_px;
  Matrix6d to_world = Matrix6d::Identity();
  to_world.bottomRightCorner<3, 3>() = keyframe.T_world_camera.rotation_matrix();
  found.covariance =
      config.relocalisation.shared_error_factor * to_world * pose->covariance * to_world.transpose();
  return found;
}

}  // namespace

Landmarks landmarks_of(const GreyImage& grey, const DepthImage& depth_m, const PinholeCamera& camera,
                       const config::Config& config) {
  Landmarks landmarks;
  for (const PlaceFeature& feature : find_place_features(grey, config.place_features)) {
    const double z_m = feature_depth_m(depth_m, feature.pixel_px, config.relocalisation);
    if (z_m <= 0) continue;
    landmarks.features.push_back(feature);
    landmarks.points_camera.push_back(camera.back_project(feature.pixel_px.x(), feature.pixel_px.y(), z_m));
  }
  return landmarks;
}

/// 1 where the spacing ends.
double Keyframes::separation(const SE3& a, const SE3& b) const {
  return std::max((a.translation - b.translation).norm() / config_.relocalisation.keyframe_distance_m,
                  angle_between_axes_rad(a, b) / radians(config_.relocalisation.keyframe_angle_deg));
}

bool Keyframes::offer(const GreyImage& grey, const DepthImage& depth_m, const SE3& T_world_camera,
                      std::int64_t timestamp_ns, double blur_px) {
  check(grey.width == camera_.width_px && grey.height == camera_.height_px && depth_m.width == grey.width &&
            depth_m.height == grey.height,
        "images have the size of the camera's");
  const config::RelocalisationConfig& config = config_.relocalisation;
  const auto distance = [&](const Keyframe& k) { return separation(k.T_world_camera, T_world_camera); };
  const auto nearest =
      std::min_element(kept_.begin(), kept_.end(),
                       [&](const Keyframe& a, const Keyframe& b) { return distance(a) < distance(b); });
  const bool near = nearest != kept_.end() && distance(*nearest) < 1;
  const bool replaces_nearest = near && distance(*nearest) < config.replacement_reach &&
                                nearest->blur_px > config.blurred_px &&
                                blur_px < config.sharper_factor * nearest->blur_px;
  if (near && !replaces_nearest) return false;
  if (T_world_featureless_ && separation(*T_world_featureless_, T_world_camera) < config.featureless_reach)
    return false;

  std::optional<Landmarks> landmarks;
  if (!has_plenty_of_corners(grey, depth_m, config_)) {
    landmarks = landmarks_of(grey, depth_m, camera_, config_);
    if (landmarks->features.size() < static_cast<std::size_t>(config.min_landmarks)) {
      T_world_featureless_ = T_world_camera;
      return false;
    }
  }
  if (replaces_nearest) kept_.erase(nearest);
  kept_.push_back({timestamp_ns, T_world_camera, grey, blur_px, PackedDepth(depth_m), std::move(landmarks)});
  if (kept_.size() > static_cast<std::size_t>(config.max_keyframes)) drop_most_crowded();
  return true;
}

void Keyframes::move(const std::function<SE3(std::int64_t timestamp_ns)>& T_world_camera_at) {
  for (Keyframe& keyframe : kept_) keyframe.T_world_camera = T_world_camera_at(keyframe.timestamp_ns);
  T_world_featureless_.reset();  // at worst the same bare wall is looked at once more
}

void Keyframes::drop_most_crowded() {
  // Of the nearest two the earlier one goes: the later one shows the place as it is now.
  std::size_t crowded = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    for (std::size_t j = i + 1; j < kept_.size(); ++j) {
      const double apart = separation(kept_[i].T_world_camera, kept_[j].T_world_camera);
      if (apart >= nearest) continue;
      nearest = apart;
      crowded = i;
    }
  }
  kept_.erase(kept_.begin() + static_cast<std::ptrdiff_t>(crowded));
}

std::optional<FoundPlace> Keyframes::find(const GreyImage& grey) {
  check(grey.width == camera_.width_px && grey.height == camera_.height_px,
        "the image has the size of the camera's");
  if (kept_.empty()) return std::nullopt;
  const std::vector<PlaceFeature> query = find_place_features(grey, config_.place_features);
  const auto min_inliers = static_cast<std::size_t>(config_.relocalisation.min_inliers);
  if (query.size() < min_inliers) return std::nullopt;

  std::vector<std::vector<FeatureMatch>> matches;
  matches.reserve(kept_.size());
  for (Keyframe& keyframe : kept_) {
    if (!keyframe.landmarks)
      keyframe.landmarks = landmarks_of(keyframe.grey, keyframe.depth.unpacked_m(), camera_, config_);
    matches.push_back(match_features(query, keyframe.landmarks->features, config_.place_features));
  }
  std::vector<std::size_t> order(kept_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return matches[a].size() > matches[b].size(); });
  order.resize(std::min(order.size(), static_cast<std::size_t>(config_.relocalisation.max_candidates)));

  std::optional<FoundPlace> best;
  for (const std::size_t k : order) {
    // Fewer matches than the best has inliers cannot win.
    if (matches[k].size() < min_inliers ||
        (best && matches[k].size() <= static_cast<std::size_t>(best->inliers)))
      break;
    std::optional<FoundPlace> found = place_by(query, kept_[k], matches[k], camera_, config_);
    if (!found || (best && found->inliers <= best->inliers)) continue;
    found->keyframe = k;
    best = found;
  }
  return best;
}

}  // namespace fusebench::relocalisation
