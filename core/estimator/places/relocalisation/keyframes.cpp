#include "core/estimator/places/relocalisation/keyframes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "core/base/error.hpp"
#include "core/config/config.hpp"
#include "core/estimator/places/depth_agreement.hpp"
#include "core/estimator/places/ferns/depth_fern_code.hpp"
#include "core/estimator/places/place_certainty.hpp"
#include "core/estimator/places/place_verification.hpp"
#include "core/estimator/places/pose_from_points.hpp"
#include "core/estimator/places/smallest_first.hpp"

namespace fusebench::relocalisation {

namespace {

// keyframes with less overlap or similarity do not improve the result
constexpr std::size_t kMostAligned = 3;
constexpr std::size_t kSampleStep = 4;  // uses every fourth feature of an image to rank the keyframes

double angle_between_axes_rad(const SE3& a, const SE3& b) {
  const Vector3d axis_a = a.rotation * Vector3d::UnitZ();
  const Vector3d axis_b = b.rotation * Vector3d::UnitZ();
  return std::atan2(axis_a.cross(axis_b).norm(), axis_a.dot(axis_b));
}

/// A frame with this many full-resolution corners has enough features, with rare exceptions (all depth in one
/// corner of a richly textured image), so they are not detected.
bool has_plenty_of_corners(const GreyImage& grey, const DepthImage& depth_m, const config::Config& config) {
  const std::vector<Vector2d> corners_px = places::find_corners(grey, config.place_features);
  const auto with_depth = std::count_if(corners_px.begin(), corners_px.end(), [&](const Vector2d& px) {
    return places::landmark_depth_m(depth_m, px, config.relocalisation) > 0;
  });
  return with_depth >= config.relocalisation.plenty_of_corners;
}

std::vector<places::SeenPoint> seen_points(std::span<const places::PlaceFeature> query,
                                           const places::Landmarks& known,
                                           std::span<const places::FeatureMatch> matches) {
  std::vector<places::SeenPoint> seen;
  seen.reserve(matches.size());
  for (const places::FeatureMatch& m : matches)
    seen.push_back({known.points_camera[m.known], query[m.query].pixel_px, query[m.query].scale});
  return seen;
}

/// Converts a pose in the camera frame of the keyframe, with its covariance, to the world.
FoundPlace found_from(const Keyframe& keyframe, const SE3& T_keyframe_camera, const Matrix6d& covariance) {
  FoundPlace found;
  found.T_world_camera = keyframe.T_world_camera * T_keyframe_camera;
  found.covariance = with_position_in(keyframe.T_world_camera.rotation, covariance);
  return found;
}

/// Pose relative to one keyframe, if it is certain.
std::optional<FoundPlace> place_by(std::span<const places::PlaceFeature> query, const Keyframe& keyframe,
                                   std::span<const places::FeatureMatch> matches, const PinholeCamera& camera,
                                   const config::Config& config) {
  const std::vector<places::SeenPoint> seen = seen_points(query, *keyframe.landmarks, matches);
  const auto pose = places::pose_from_points(seen, camera);
  if (!pose || !places::is_certain_place(seen, *pose, camera, config.relocalisation)) return std::nullopt;
  FoundPlace found =
      found_from(keyframe, pose->T_a_camera, config.relocalisation.shared_error_factor * pose->covariance);
  found.inliers = static_cast<int>(pose->inliers.size());
  found.support = static_cast<double>(found.inliers);
  found.matches = static_cast<int>(seen.size());
  found.rms_px = pose->rms_px;
  return found;
}

/// Removes places with much less support than the best; stable order for equal support.
std::vector<FoundPlace> comparable_best_first(std::vector<FoundPlace> found,
                                              const config::RelocalisationConfig& config) {
  std::ranges::stable_sort(found, std::ranges::greater{}, &FoundPlace::support);
  std::erase_if(found,
                [best = found.empty() ? 0.0 : found.front().support, &config](const FoundPlace& place) {
                  return place.support < config.ambiguous_support * best;
                });
  return found;
}

}  // namespace

/// Distance of two poses divided by the spacing of keyframes: 1 at the spacing.
double Keyframes::separation(const SE3& a, const SE3& b) const {
  return std::max((a.translation - b.translation).norm() / config_.relocalisation.keyframe_distance_m,
                  angle_between_axes_rad(a, b) / radians(config_.relocalisation.keyframe_angle_deg));
}

/// True if the new frame is so much sharper that it should replace the kept one.
bool Keyframes::is_sharper(double blur_px, double blur_before_px) const {
  const config::RelocalisationConfig& config = config_.relocalisation;
  return blur_before_px > config.blurred_px && blur_px < config.sharper_factor * blur_before_px;
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
  const bool replaces_nearest =
      near && distance(*nearest) < config.replacement_reach && is_sharper(blur_px, nearest->blur_px);
  if (near && !replaces_nearest) return false;
  if (featureless_ && separation(featureless_->T_world_camera, T_world_camera) < config.featureless_reach &&
      !is_sharper(blur_px, featureless_->blur_px))
    return false;

  std::optional<places::Landmarks> landmarks;
  if (!has_plenty_of_corners(grey, depth_m, config_)) {
    landmarks = places::landmarks_of(grey, depth_m, camera_, config_.place_features, config_.relocalisation);
    if (landmarks->features.size() < static_cast<std::size_t>(config.min_landmarks)) {
      featureless_ = FeaturelessFrame{T_world_camera, blur_px};
      return false;
    }
  }
  if (replaces_nearest) kept_.erase(nearest);
  kept_.push_back(
      {timestamp_ns, T_world_camera, grey, blur_px, PackedDepth(depth_m), std::move(landmarks), {}, {}});
  if (kept_.size() > static_cast<std::size_t>(config.max_keyframes)) drop_most_crowded();
  return true;
}

void Keyframes::move(const std::function<SE3(std::int64_t timestamp_ns)>& T_world_camera_at) {
  for (Keyframe& keyframe : kept_) keyframe.T_world_camera = T_world_camera_at(keyframe.timestamp_ns);
  featureless_.reset();  // a repeated search of the same featureless area is acceptable
}

void Keyframes::adopt(const Keyframes& other, const SE3& T_world_other) {
  for (const Keyframe& keyframe : other.kept_) {
    kept_.push_back(keyframe);
    kept_.back().T_world_camera = T_world_other * keyframe.T_world_camera;
    if (kept_.size() > static_cast<std::size_t>(config_.relocalisation.max_keyframes)) drop_most_crowded();
  }
}

void Keyframes::drop_most_crowded() {
  // Removes the earlier one of the nearest two, since the later one shows the current state of the place.
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

void Keyframes::complete_landmarks() {
  for (Keyframe& keyframe : kept_) {
    if (!keyframe.landmarks)
      keyframe.landmarks = places::landmarks_of(keyframe.grey, keyframe.depth.unpacked_m(), camera_,
                                                config_.place_features, config_.relocalisation);
  }
}

std::vector<std::size_t> Keyframes::most_matched(std::span<const places::PlaceFeature> query) const {
  const auto max_count = static_cast<std::size_t>(config_.relocalisation.max_candidates);
  std::vector<std::size_t> order(kept_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (order.size() <= max_count) return order;
  std::vector<std::size_t> counts;
  for (const Keyframe& keyframe : kept_)
    counts.push_back(
        places::count_distinct(query, keyframe.landmarks->features, kSampleStep, config_.place_features));
  std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t k) { return counts[k]; });
  order.resize(max_count);
  return order;
}

std::vector<FoundPlace> Keyframes::find(const GreyImage& grey) {
  check(grey.width == camera_.width_px && grey.height == camera_.height_px,
        "the image has the size of the camera's");
  if (kept_.empty()) return {};
  const std::vector<places::PlaceFeature> query = places::find_place_features(grey, config_.place_features);
  const auto min_inliers = static_cast<std::size_t>(config_.relocalisation.min_inliers);
  if (query.size() < min_inliers) return {};

  complete_landmarks();
  std::vector<std::pair<std::size_t, std::vector<places::FeatureMatch>>> candidates;
  for (const std::size_t k : most_matched(query))
    candidates.emplace_back(
        k, places::match_features(query, kept_[k].landmarks->features, config_.place_features));
  std::ranges::stable_sort(candidates, std::ranges::greater{}, [](const auto& c) { return c.second.size(); });

  std::vector<FoundPlace> found;
  double best_support = 0;
  for (const auto& [k, matches] : candidates) {
    // So few matches cannot reach a support comparable to the best.
    const auto count = static_cast<double>(matches.size());
    if (matches.size() < min_inliers || count < config_.relocalisation.ambiguous_support * best_support)
      break;
    std::optional<FoundPlace> place = place_by(query, kept_[k], matches, camera_, config_);
    if (!place) continue;
    place->keyframe = k;
    best_support = std::max(best_support, place->support);
    found.push_back(*place);
  }
  return comparable_best_first(std::move(found), config_.relocalisation);
}

/// Computes the small images and codes for the search by depth.
void Keyframes::complete(Keyframe& keyframe) const {
  if (keyframe.small) return;
  keyframe.small = places::small_images_of(keyframe.grey, keyframe.depth.unpacked_m());
  keyframe.depth_code = ferns::depth_fern_code(keyframe.small->depth_m);
}

std::optional<FoundPlace> Keyframes::refined_by_depth(const FoundPlace& found,
                                                      const places::SmallImages& query) {
  Keyframe& keyframe = kept_[found.keyframe];
  complete(keyframe);
  const SE3 T_keyframe_world = keyframe.T_world_camera.inverse();
  const places::RelativePose pose{T_keyframe_world * found.T_world_camera,
                                  with_position_in(T_keyframe_world.rotation, found.covariance)};
  const places::VerifiedPair pair =
      places::verify_from_features(*keyframe.small, query, pose, camera_, config_);
  if (!pair.same) return std::nullopt;
  FoundPlace place = found;
  const FoundPlace by_depth = found_from(keyframe, pair.T_known_query, pair.covariance);
  place.T_world_camera = by_depth.T_world_camera;
  place.covariance = by_depth.covariance;
  return place;
}

std::vector<Keyframes::AlignmentCandidate> Keyframes::seen_by_prediction(const places::SmallImages& query,
                                                                         const SE3& T_world_camera) const {
  std::vector<std::pair<double, AlignmentCandidate>> overlaps;
  for (std::size_t k = 0; k < kept_.size(); ++k) {
    const SE3 T_keyframe_camera = kept_[k].T_world_camera.inverse() * T_world_camera;
    const double overlap = places::depth_agreement(query, *kept_[k].small, T_keyframe_camera, camera_,
                                                   config_.depth, config_.loops)
                               .overlap;
    if (overlap >= config_.loops.min_consistent_share) overlaps.push_back({-overlap, {k, T_keyframe_camera}});
  }
  return places::smallest_first(std::move(overlaps), kMostAligned);
}

std::vector<Keyframes::AlignmentCandidate> Keyframes::most_similar(const places::SmallImages& query) const {
  const ferns::FernCode code = ferns::depth_fern_code(query.depth_m);
  std::vector<std::pair<double, AlignmentCandidate>> similar;
  for (std::size_t k = 0; k < kept_.size(); ++k) {
    const double different = ferns::dissimilarity(kept_[k].depth_code, code);
    if (different <= config_.loops.max_dissimilarity) similar.push_back({different, {k, SE3{}}});
  }
  return places::smallest_first(std::move(similar), kMostAligned);
}

std::vector<FoundPlace> Keyframes::aligned(const places::SmallImages& query,
                                           const std::vector<AlignmentCandidate>& candidates,
                                           double reach_m) const {
  std::vector<FoundPlace> found;
  for (const AlignmentCandidate& candidate : candidates) {
    const Keyframe& keyframe = kept_[candidate.keyframe];
    const places::VerifiedPair pair = places::verify_by_depth(
        *keyframe.small, query, candidate.T_keyframe_camera, reach_m, camera_, config_);
    if (!pair.same) continue;
    found.push_back(found_from(keyframe, pair.T_known_query, pair.covariance));
    found.back().keyframe = candidate.keyframe;
    found.back().support = pair.consistent_share;
  }
  return comparable_best_first(std::move(found), config_.relocalisation);
}

std::vector<FoundPlace> Keyframes::find_by_depth(const places::SmallImages& query,
                                                 const SE3& T_world_camera_predicted, double reach_m) {
  for (Keyframe& keyframe : kept_) complete(keyframe);
  std::vector<FoundPlace> found =
      aligned(query, seen_by_prediction(query, T_world_camera_predicted), reach_m);
  if (!found.empty()) return found;
  return aligned(query, most_similar(query), config_.relocalisation.keyframe_distance_m);
}

}  // namespace fusebench::relocalisation
