#include "core/loops/place_verification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/preprocessing/depth_gates.hpp"
#include "core/relocalisation/place_certainty.hpp"
#include "core/relocalisation/pose_from_points.hpp"

namespace fusebench::loops {

namespace {

/// Shares of the measured pixels of one frame.
struct DepthAgreement {
  double consistent = 0;
  double violating = 0;  ///< of those that the other frame has depth for
};

DepthAgreement depth_agreement(const Place& from, const Place& to, const SE3& T_to_from,
                               const PinholeCamera& camera, const config::Config& config) {
  constexpr double kAllowance_m = 0.01;  // what interpolation and calibration leave
  std::size_t measured = 0, seen = 0, consistent = 0, violating = 0;
  for (int y = 0; y < from.small_depth_m.height; ++y) {
    for (int x = 0; x < from.small_depth_m.width; ++x) {
      const auto z = static_cast<double>(from.small_depth_m(x, y));
      if (!(z > 0)) continue;
      ++measured;
      const Vector3d point = T_to_from * camera.back_project(kDepthStep * x, kDepthStep * y, z);
      if (point.z() <= 0) continue;
      const Vector2d pixel = camera.project(point) / kDepthStep;
      const auto u = static_cast<int>(std::lround(pixel.x()));
      const auto v = static_cast<int>(std::lround(pixel.y()));
      if (!to.small_depth_m.contains(u, v) || !(to.small_depth_m(u, v) > 0)) continue;
      ++seen;
      const auto there = static_cast<double>(to.small_depth_m(u, v));
      const double allowed =
          config.loops.depth_sigmas * preprocessing::depth_sigma_m(point.z(), config.depth) + kAllowance_m;
      if (std::abs(point.z() - there) <= allowed) {
        ++consistent;
      } else if (point.z() < there) {
        ++violating;
      }
    }
  }
  const auto share = [](std::size_t part, std::size_t whole) {
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
  };
  return {share(consistent, measured), share(violating, seen)};
}

std::vector<relocalisation::SeenPoint> seen_points(const Place& known, const Place& query,
                                                   const config::Config& config) {
  const auto& features = query.landmarks.features;
  std::vector<relocalisation::SeenPoint> seen;
  for (const relocalisation::FeatureMatch& match :
       relocalisation::match_features(features, known.landmarks.features, config.place_features)) {
    const relocalisation::PlaceFeature& feature = features[match.query];
    seen.push_back({known.landmarks.points_camera[match.known], feature.pixel_px, feature.scale});
  }
  return seen;
}

}  // namespace

VerifiedPair verify_pair(const Place& known, const Place& query, const PinholeCamera& camera,
                         const config::Config& config) {
  VerifiedPair pair;
  const std::vector<relocalisation::SeenPoint> seen = seen_points(known, query, config);
  pair.matches = static_cast<int>(seen.size());
  if (pair.matches < config.relocalisation.min_inliers) {
    pair.reason =
        fmt::format("{} matches of features (at least {})", pair.matches, config.relocalisation.min_inliers);
    return pair;
  }
  const auto pose = relocalisation::pose_from_points(seen, camera, config.place_pose);
  if (pose) pair.inliers = static_cast<int>(pose->inliers.size());
  if (!pose || !relocalisation::is_certain_place(seen, *pose, camera, config.relocalisation)) {
    pair.reason = fmt::format("{} of {} matches agree, which is not certain", pair.inliers, pair.matches);
    return pair;
  }
  pair.T_known_query = pose->T_a_camera;
  pair.covariance = config.relocalisation.shared_error_factor * pose->covariance;
  const SE3 T_query_known = pair.T_known_query.inverse();
  const DepthAgreement forth = depth_agreement(query, known, pair.T_known_query, camera, config);
  const DepthAgreement back = depth_agreement(known, query, T_query_known, camera, config);
  pair.consistent_share = std::min(forth.consistent, back.consistent);
  pair.violating_share = std::max(forth.violating, back.violating);
  if (pair.consistent_share < config.loops.min_consistent_share) {
    pair.reason = fmt::format("{:.0f} % of the depth fits (at least {:.0f} %)", 100 * pair.consistent_share,
                              100 * config.loops.min_consistent_share);
  } else if (pair.violating_share > config.loops.max_violating_share) {
    pair.reason = fmt::format("{:.0f} % of the depth lies in free space (at most {:.0f} %)",
                              100 * pair.violating_share, 100 * config.loops.max_violating_share);
  }
  pair.same = pair.reason.empty();
  return pair;
}

}  // namespace fusebench::loops
