#include "eval/metrics/loop_error/loop_error.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/config/groups/loops_config.hpp"
#include "core/estimator/places/depth_agreement.hpp"
#include "eval/metrics/statistics.hpp"
#include "eval/metrics/trajectory_error/ate_rpe.hpp"

namespace fusebench::loop_error {

namespace {

using loops::LoopCandidate;
using loops::Place;

/// Of places, by index; nothing where the ground truth has a gap.
using TruePoses = std::vector<std::optional<SE3>>;

TruePoses true_poses_of(std::span<const Place> places, const Trajectory& truth) {
  TruePoses poses;
  for (const Place& place : places) {
    const auto found = std::ranges::lower_bound(truth, place.timestamp_ns, {}, &StampedPose::timestamp_ns);
    poses.emplace_back();
    if (found != truth.end() && found->timestamp_ns == place.timestamp_ns)
      poses.back() = found->T_world_camera;
  }
  return poses;
}

/// Views that are farther apart hardly share 30 % of what they see; comparing their depth takes a
/// millisecond.
bool may_overlap(const SE3& T_a_b) {
  constexpr double kFar_m = 2.5;
  constexpr double kFar_rad = radians(50.0);
  return T_a_b.translation.norm() < kFar_m &&
         rotation_angle_rad(T_a_b.rotation, Quaterniond::Identity()) < kFar_rad;
}

/// The older place that is seen best, by the true poses; nothing if none is.
std::optional<LoopCandidate> true_loop(std::span<const Place> places, const TruePoses& truth,
                                       std::size_t query, const PinholeCamera& camera,
                                       const config::DepthConfig& depth, const config::LoopsConfig& loops) {
  std::optional<LoopCandidate> best;
  double best_share = kRevisitOverlap;
  for (std::size_t known = 0; known < query; ++known) {
    if (seconds_between(places[known].timestamp_ns, places[query].timestamp_ns) < loops.least_age_s) break;
    if (!truth[known]) continue;
    const SE3 T_known_query = truth[known]->inverse() * *truth[query];
    if (!may_overlap(T_known_query)) continue;
    const double share =
        places::depth_agreement(places[known].appearance.small, places[query].appearance.small,
                                T_known_query.inverse(), camera, depth, loops)
            .consistent;
    if (share < best_share) continue;
    best_share = share;
    best.emplace();
    best->known = known;
    best->query = query;
    best->pair.same = true;
    best->pair.T_known_query = T_known_query;
  }
  return best;
}

/// Normalised estimation error squared, by degree of freedom: 1 where the covariance is consistent.
double nees(const Vector3d& error, const Matrix3d& covariance) {
  return error.dot(covariance.ldlt().solve(error)) / 3;
}

void add_edges(const loops::LoopClosure& closure, const TruePoses& truth, LoopError& result) {
  std::vector<double> translations_m, rotations_rad;
  double rotation_nees = 0, position_nees = 0;
  for (const LoopCandidate& candidate : closure.candidates()) {
    if (!candidate.pair.same || !truth[candidate.known] || !truth[candidate.query]) continue;
    const SE3 T_true = truth[candidate.known]->inverse() * *truth[candidate.query];
    const Vector6d error = pose_minus(candidate.pair.T_known_query, T_true);
    const double rotation_rad = error.head<3>().norm();
    const double translation_m = error.tail<3>().norm();
    const Matrix6d covariance = closure.covariance_of(candidate);
    const bool is_false =
        (rotation_rad > kFalseRotation_rad &&
         rotation_rad > kFalseSigmas * largest_sigma(covariance.topLeftCorner<3, 3>())) ||
        (translation_m > kFalseTranslation_m &&
         translation_m > kFalseSigmas * largest_sigma(covariance.bottomRightCorner<3, 3>()));
    const bool verified = candidate.evidence != loops::LoopEvidence::tracker_alone;
    result.verified += verified ? 1U : 0U;
    result.false_verified += verified && is_false ? 1U : 0U;
    if (!candidate.accepted) continue;
    ++result.accepted;
    result.false_accepted += is_false ? 1U : 0U;
    translations_m.push_back(translation_m);
    rotations_rad.push_back(rotation_rad);
    rotation_nees += nees(error.head<3>(), covariance.topLeftCorner<3, 3>());
    position_nees += nees(error.tail<3>(), covariance.bottomRightCorner<3, 3>());
  }
  if (result.accepted == 0) return;
  result.median_translation_m = metrics::statistics(translations_m).median;
  result.median_rotation_rad = metrics::statistics(rotations_rad).median;
  const auto accepted = static_cast<double>(result.accepted);
  result.nees_rotation = rotation_nees / accepted;
  result.nees_position = position_nees / accepted;
}

}  // namespace

Result<LoopError> loop_error(const loops::LoopClosure& closure, const Trajectory& truth,
                             const PinholeCamera& camera, const config::DepthConfig& depth,
                             const config::LoopsConfig& loops) {
  const std::span<const Place> places = closure.places();
  const TruePoses true_poses = true_poses_of(places, truth);
  LoopError result;
  result.places = static_cast<std::size_t>(
      std::ranges::count_if(true_poses, [](const auto& pose) { return pose.has_value(); }));
  add_edges(closure, true_poses, result);

  std::vector<bool> found(places.size());
  for (const LoopCandidate& candidate : closure.candidates()) {
    if (candidate.accepted) found[candidate.query] = true;
  }
  std::vector<LoopCandidate> true_loops;
  for (std::size_t query = 0; query < places.size(); ++query) {
    if (!true_poses[query]) continue;
    auto loop = true_loop(places, true_poses, query, camera, depth, loops);
    if (!loop) continue;
    Revisits& revisits = places[query].blur_px > kBlurred_px ? result.blurred : result.sharp;
    ++revisits.count;
    revisits.found += found[query] ? 1U : 0U;
    true_loops.push_back(std::move(*loop));
  }
  if (true_loops.empty()) return result;
  const auto poses = closure.poses_with(std::move(true_loops));
  if (!poses) return tl::unexpected(poses.error());
  if (const auto ate = trajectory_error::absolute_trajectory_error(truth, *poses))
    result.oracle_ate_m = ate->stats.rmse;
  return result;
}

}  // namespace fusebench::loop_error
