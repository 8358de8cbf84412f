#include "core/estimator/places/place_verification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "core/config/config.hpp"
#include "core/estimator/places/depth_agreement.hpp"
#include "core/estimator/places/place_certainty.hpp"
#include "core/estimator/places/pose_from_points.hpp"

namespace fusebench::places {

namespace {

std::vector<SeenPoint> seen_points(const Appearance& known, const Appearance& query,
                                   const config::Config& config) {
  const auto& features = query.landmarks.features;
  std::vector<SeenPoint> seen;
  for (const FeatureMatch& match :
       match_features(features, known.landmarks.features, config.place_features)) {
    const PlaceFeature& feature = features[match.query];
    seen.push_back({known.landmarks.points_camera[match.known], feature.pixel_px, feature.scale});
  }
  return seen;
}

/// Pose by features; on failure sets pair.reason.
std::optional<RelativePose> pose_by_features(const Appearance& known, const Appearance& query,
                                             const PinholeCamera& camera, const config::Config& config,
                                             VerifiedPair& pair) {
  const std::vector<SeenPoint> seen = seen_points(known, query, config);
  pair.matches = static_cast<int>(seen.size());
  if (pair.matches < config.relocalisation.min_inliers) {
    pair.reason =
        fmt::format("{} matches of features (at least {})", pair.matches, config.relocalisation.min_inliers);
    return std::nullopt;
  }
  const auto pose = pose_from_points(seen, camera);
  if (pose) pair.inliers = static_cast<int>(pose->inliers.size());
  if (!pose || !is_certain_place(seen, *pose, camera, config.relocalisation)) {
    pair.reason = fmt::format("{} of {} matches agree, too few to be certain", pair.inliers, pair.matches);
    return std::nullopt;
  }
  return RelativePose{pose->T_a_camera, config.relocalisation.shared_error_factor * pose->covariance};
}

/// Pose by depth alone; on failure sets pair.reason.
std::optional<RelativePose> pose_by_depth(const SmallImages& known, const SmallImages& query,
                                          const SE3& T_known_query, double reach_m,
                                          const PinholeCamera& camera, const config::Config& config,
                                          VerifiedPair& pair) {
  const config::LoopsConfig& loops = config.loops;
  const auto aligned = aligned_by_depth(known, query, {{T_known_query, Matrix6d::Identity()}, false, reach_m},
                                        camera, config.depth, config.loops);
  if (!aligned) {
    pair.reason = "the depth images cannot be aligned";
    return std::nullopt;
  }
  const double rotation_sigma_rad = largest_sigma(aligned->covariance.topLeftCorner<3, 3>());
  const double position_sigma_m = largest_sigma(aligned->covariance.bottomRightCorner<3, 3>());
  if (rotation_sigma_rad > radians(loops.max_rotation_sigma_deg) ||
      position_sigma_m > loops.max_position_sigma_m) {
    pair.reason = fmt::format("depth determines the pose to {:.2f} degrees and {:.1f} cm only",
                              degrees(rotation_sigma_rad), 100 * position_sigma_m);
    return std::nullopt;
  }
  const auto correlation = grey_correlation(query, known, aligned->T_known_query, camera, config.depth,
                                            config.loops, config.health.min_contrast_grey);
  if (correlation && *correlation < loops.min_grey_correlation) {
    pair.reason = fmt::format("intensities correlate by {:.2f} where depth fits (at least {})", *correlation,
                              loops.min_grey_correlation);
    return std::nullopt;
  }
  pair.by_depth_alone = true;
  return aligned;
}

/// Contradiction of the pose by the depth of either place; empty if there is none.
std::string contradiction_of_depth(const SmallImages& known, const SmallImages& query,
                                   const PinholeCamera& camera, const config::Config& config,
                                   VerifiedPair& pair) {
  const config::LoopsConfig& loops = config.loops;
  const DepthAgreement forth =
      depth_agreement(query, known, pair.T_known_query, camera, config.depth, config.loops);
  const DepthAgreement back =
      depth_agreement(known, query, pair.T_known_query.inverse(), camera, config.depth, config.loops);
  pair.consistent_share = std::min(forth.consistent, back.consistent);
  pair.violating_share = std::max(forth.violating, back.violating);
  if (pair.consistent_share < loops.min_consistent_share)
    return fmt::format("{:.0f} % of the depth fits (at least {:.0f} %)", 100 * pair.consistent_share,
                       100 * loops.min_consistent_share);
  if (pair.violating_share > loops.max_violating_share)
    return fmt::format("{:.0f} % of the depth is in free space (at most {:.0f} %)",
                       100 * pair.violating_share, 100 * loops.max_violating_share);
  return {};
}

/// Sets the result of the pair at that pose, if the depth of both agrees with it.
void conclude(const RelativePose& pose, const SmallImages& known, const SmallImages& query,
              const PinholeCamera& camera, const config::Config& config, VerifiedPair& pair) {
  pair.T_known_query = pose.T_known_query;
  pair.covariance = pose.covariance;
  pair.reason = contradiction_of_depth(known, query, camera, config, pair);
  pair.same = pair.reason.empty();
}

}  // namespace

VerifiedPair verify_by_depth(const SmallImages& known, const SmallImages& query,
                             const SE3& T_known_query_start, double reach_m, const PinholeCamera& camera,
                             const config::Config& config) {
  VerifiedPair pair;
  const auto pose = pose_by_depth(known, query, T_known_query_start, reach_m, camera, config, pair);
  if (pose) conclude(*pose, known, query, camera, config, pair);
  return pair;
}

VerifiedPair verify_from_features(const SmallImages& known, const SmallImages& query,
                                  const RelativePose& pose, const PinholeCamera& camera,
                                  const config::Config& config) {
  VerifiedPair pair;
  const auto refined = aligned_by_depth(known, query, {pose, true, 0}, camera, config.depth, config.loops);
  conclude(refined ? *refined : pose, known, query, camera, config, pair);
  return pair;
}

VerifiedPair verify_pair(const Appearance& known, const Appearance& query, const SE3& T_known_query_by_path,
                         const PinholeCamera& camera, const config::Config& config) {
  VerifiedPair by_features;
  const std::optional<RelativePose> pose = pose_by_features(known, query, camera, config, by_features);
  const auto with_counts = [&](VerifiedPair pair) {
    pair.matches = by_features.matches;
    pair.inliers = by_features.inliers;
    return pair;
  };
  if (pose) return with_counts(verify_from_features(known.small, query.small, *pose, camera, config));
  if (depth_agreement(query.small, known.small, T_known_query_by_path, camera, config.depth, config.loops)
          .overlap < config.loops.min_consistent_share)
    return by_features;
  VerifiedPair by_depth = verify_by_depth(known.small, query.small, T_known_query_by_path, 0, camera, config);
  // The reason is that of depth if it was aligned; otherwise that of the features, followed by that of depth.
  if (!by_depth.by_depth_alone) by_depth.reason = by_features.reason + "; " + by_depth.reason;
  return with_counts(std::move(by_depth));
}

}  // namespace fusebench::places
