#include "core/estimator/places/loops/loop_closure.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/base/upper_median.hpp"
#include "core/config/config.hpp"
#include "core/estimator/filter/moved_state.hpp"
#include "core/estimator/filter/pose_clones.hpp"
#include "core/estimator/places/loops/place_search.hpp"

namespace fusebench::loops {

namespace {

// Error of the first pose after a relocalisation whose pair of places could not be verified: 1 to 28 mrad and
// 0.2 to 3.0 cm in simulated rooms.
constexpr double kFoundRotationSigma_rad = 0.02;
constexpr double kFoundPositionSigma_m = 0.03;

double median_depth_m(const DepthImage& depth_m) {
  std::vector<float> measured;
  std::ranges::copy_if(depth_m.data, std::back_inserter(measured), [](float m) { return m > 0; });
  if (measured.empty()) return 0;
  return static_cast<double>(upper_median(std::move(measured)));
}

}  // namespace

bool LoopClosure::enabled() const { return config_.loops.mode != config::LoopMode::off; }

bool LoopClosure::may_correct_online() const {
  return config_.loops.mode == config::LoopMode::online &&
         corrections_ < config_.loops.max_online_corrections;
}

Matrix6d LoopClosure::covariance_of(const LoopCandidate& candidate) const {
  return loop_edge(places_, candidate, config_.loops).covariance;
}

void LoopClosure::add_pose(std::int64_t timestamp_ns, const SE3& T_world_camera) {
  if (!enabled()) return;
  poses_.push_back(
      {timestamp_ns, odometry_.T_current_odometry().inverse() * T_world_camera, odometry_.relocalisations()});
}

void LoopClosure::add_fused(const RgbdFrame& frame, const filter::GaussianState& estimate, double blur_px) {
  if (!enabled()) return;
  const config::LoopsConfig& config = config_.loops;
  const filter::GaussianState in_odometry = filter::moved(estimate, odometry_.T_current_odometry().inverse());
  poses_are_wrong_ = false;
  fused_.push_back({frame.timestamp_ns, in_odometry.mean});
  const SE3 T_world_camera = in_odometry.mean.T_world_imu * rig_.T_imu_camera;
  ++fused_since_place_;
  const bool was_found = was_found_since_last_place();
  if (!places_.empty() && !was_found) {
    const SE3 moved = places_.back().T_world_camera.inverse() * T_world_camera;
    const bool near =
        moved.translation.norm() < config.place_distance_m &&
        rotation_angle_rad(moved.rotation, Quaterniond::Identity()) < radians(config.place_angle_deg);
    if (near && fused_since_place_ < config.query_every) return;
  }
  fused_since_place_ = 0;
  Place place;
  place.timestamp_ns = frame.timestamp_ns;
  place.appearance = places::appearance_of(frame, rig_.camera, config_.loops, config_.place_features,
                                           config_.relocalisation);
  place.view_depth_m = median_depth_m(place.appearance.small.depth_m);
  place.T_world_camera = T_world_camera;
  place.relocalisations = odometry_.relocalisations();
  place.covariance = camera_covariance(in_odometry);
  place.lost_covariance = odometry_.lost_covariance_at(T_world_camera);
  if (config_.terms.prior == config::Prior::imu)
    place.gravity_camera = T_world_camera.rotation.conjugate() * in_odometry.mean.gravity_direction_world;
  place.blur_px = blur_px;
  const Vector3d& rate_imu_radps = in_odometry.mean.angular_velocity_imu_radps;
  place.angular_velocity_camera_radps = rig_.T_imu_camera.rotation.conjugate() * rate_imu_radps;
  place.velocity_camera_mps =
      T_world_camera.rotation.conjugate() * in_odometry.mean.velocity_world_mps +
      rig_.T_imu_camera.rotation.conjugate() * rate_imu_radps.cross(rig_.T_imu_camera.translation);
  places_.push_back(std::move(place));
  if (was_found) add_relocalisation_edge(places_.size() - 1);
  look_for_loops(places_.size() - 1);
}

/// Covariance of the camera pose, in its tangent, in the first camera frame.
Matrix6d LoopClosure::camera_covariance(const filter::GaussianState& in_odometry) const {
  const SE3 T_world_camera = in_odometry.mean.T_world_imu * rig_.T_imu_camera;
  const Matrix6d to_camera = filter::pose_transport(T_world_camera, in_odometry.mean.T_world_imu);
  const filter::GaussianState in_first = filter::in_first_camera_world(in_odometry);
  return to_camera * in_first.covariance.topLeftCorner<filter::kPoseSize, filter::kPoseSize>() *
         to_camera.transpose();
}

void LoopClosure::add_relocalisation(const filter::GaussianState& predicted,
                                     const filter::GaussianState& found, std::int64_t found_by_ns) {
  if (!enabled() || places_.empty()) return;
  OdometryPose last{places_.back().T_world_camera, places_.back().covariance};
  if (was_found_since_last_place()) {
    const Relocalisation& before = odometry_.relocalisation(odometry_.relocalisations());
    last = {before.T_odometry_camera, before.found_covariance};
  }
  const filter::GaussianState in_odometry =
      filter::moved(predicted, odometry_.T_current_odometry().inverse());
  const SE3 T_current_camera_found = found.mean.T_world_imu * rig_.T_imu_camera;
  Relocalisation again;
  again.known = place_near(found_by_ns);
  again.T_known_camera = T_current_camera(again.known).inverse() * T_current_camera_found;
  again.T_odometry_camera = in_odometry.mean.T_world_imu * rig_.T_imu_camera;
  again.predicted_covariance = camera_covariance(in_odometry);
  again.found_covariance =
      camera_covariance(filter::moved(found, again.T_odometry_camera * T_current_camera_found.inverse()));
  odometry_.relocalise(again, T_current_camera_found, last);
}

/// Uses the pose of the verified pair of places. Without one, uses the self-relocalisation pose, whose first
/// motion after the loss is unknown.
void LoopClosure::add_relocalisation_edge(std::size_t query) {
  const Relocalisation& found = odometry_.relocalisation(odometry_.relocalisations());
  LoopCandidate candidate;
  candidate.known = found.known;
  candidate.query = query;
  candidate.dissimilarity = dissimilarity(places_[candidate.known], places_[query]);
  const SE3 T_known_query =
      found.T_known_camera * (found.T_odometry_camera.inverse() * places_[query].T_world_camera);
  candidate.pair = places::verify_pair(places_[candidate.known].appearance, places_[query].appearance,
                                       T_known_query, rig_.camera, config_);
  candidate.evidence = candidate.pair.same ? LoopEvidence::pair_and_tracker : LoopEvidence::tracker_alone;
  if (!candidate.pair.same) {
    candidate.pair.same = true;
    candidate.pair.reason.clear();
    candidate.pair.T_known_query = T_known_query;
    candidate.pair.covariance = covariance_by_axis(kFoundRotationSigma_rad, kFoundPositionSigma_m);
  }
  candidate.accepted = true;
  candidate.verdict = kFoundItself;
  candidates_.push_back(std::move(candidate));
}

/// Verifies the candidates; the last place is a candidate until one of them is verified.
void LoopClosure::look_for_loops(std::size_t query) {
  const auto T_world_camera = [&](std::size_t place) { return T_current_camera(place); };
  std::vector<std::size_t> known_places = similar_places(places_, config_.loops);
  for (const std::size_t known : places_in_view(places_, T_world_camera, config_.loops)) {
    if (std::ranges::find(known_places, known) == known_places.end()) known_places.push_back(known);
  }
  for (const std::size_t known : known_places) {
    if (is_candidate(known, query)) continue;
    LoopCandidate candidate;
    candidate.known = known;
    candidate.query = query;
    candidate.dissimilarity = dissimilarity(places_[known], places_[query]);
    candidate.pair = places::verify_pair(places_[known].appearance, places_[query].appearance,
                                         T_current_camera(known).inverse() * T_current_camera(query),
                                         rig_.camera, config_);
    const bool same = candidate.pair.same;
    if (!same) candidate.verdict = candidate.pair.reason;
    if (same) poses_are_wrong_ = contradicts_current_poses(candidate);
    candidates_.push_back(std::move(candidate));
    if (same) break;
  }
}

/// True if the pair is already a candidate, by a self-relocalisation to that place. The candidates of the
/// query are the last ones.
bool LoopClosure::is_candidate(std::size_t known, std::size_t query) const {
  for (auto candidate = candidates_.rbegin(); candidate != candidates_.rend() && candidate->query == query;
       ++candidate) {
    if (candidate->known == known) return true;
  }
  return false;
}

/// Removes edges that are inconsistent with the others.
Result<void> LoopClosure::optimise() {
  optimised_.clear();
  PoseGraph graph;
  // The errors of gravity (bias, scale and rotation of the accelerometer) are common to all places, so all
  // places together have the weight of one.
  graph.gravity_sigma_rad =
      radians(config_.loops.gravity_sigma_deg) * std::sqrt(static_cast<double>(places_.size()));
  for (std::size_t i = 0; i < places_.size(); ++i) {
    graph.T_world_camera.push_back(places_[i].T_world_camera);
    graph.gravity_camera.push_back(places_[i].gravity_camera);
    if (i > 0) graph.edges.push_back(path_edge(places_, i - 1, i, config_.loops));
  }
  const std::vector<GraphEdge> path = graph.edges;
  const double worst_allowed =
      filter::kPoseSize * config_.loops.worst_edge_sigmas * config_.loops.worst_edge_sigmas;
  for (bool fit = false; !fit;) {
    graph.edges = path;
    for (const LoopCandidate& candidate : candidates_) {
      if (candidate.accepted) graph.edges.push_back(loop_edge(places_, candidate, config_.loops));
    }
    if (graph.edges.size() == path.size()) return {};
    auto poses = optimised_poses(graph);
    if (!poses) return tl::unexpected(poses.error());
    fit = true;
    for (LoopCandidate& candidate : candidates_) {
      if (!candidate.accepted || candidate.by_tracker() ||
          squared_residual(loop_edge(places_, candidate, config_.loops), *poses) <= worst_allowed)
        continue;
      candidate.accepted = fit = false;
      candidate.verdict = "does not fit the other edges after the optimisation";
    }
    if (fit) optimised_ = std::move(*poses);
  }
  return {};
}

/// Pose in the current frame.
SE3 LoopClosure::T_current_camera(std::size_t place) const {
  if (place < optimised_.size()) return optimised_[place];
  return odometry_.T_current_camera(places_[place].T_world_camera, places_[place].relocalisations);
}

/// True if the difference exceeds the uncertainty of the candidate.
bool LoopClosure::contradicts_current_poses(const LoopCandidate& candidate) const {
  const GraphEdge edge = loop_edge(places_, candidate, config_.loops);
  const SE3 T_known_query = T_current_camera(candidate.known).inverse() * T_current_camera(candidate.query);
  const Vector6d error = pose_minus(T_known_query, edge.T_a_b);
  return is_large(edge.T_a_b.inverse() * T_known_query) &&
         error.dot(edge.covariance.ldlt().solve(error)) > config_.loops.max_chi2;
}

bool LoopClosure::is_large(const SE3& motion) const {
  return motion.translation.norm() > config_.loops.online_translation_m ||
         rotation_angle_rad(motion.rotation, Quaterniond::Identity()) >
             radians(config_.loops.online_rotation_deg);
}

Result<std::optional<SE3>> LoopClosure::correct_online() {
  const config::LoopsConfig& config = config_.loops;
  if (!may_correct_online() || !poses_are_wrong_ ||
      fused_.size() - fused_at_attempt_ < static_cast<std::size_t>(config.online_every))
    return std::nullopt;
  poses_are_wrong_ = false;
  fused_at_attempt_ = fused_.size();
  decide(places_, config_.loops, candidates_);
  std::vector<SE3> before = optimised_;
  if (auto done = optimise(); !done) return tl::unexpected(done.error());
  const SE3& T_odometry_last = places_.back().T_world_camera;
  const SE3 T_current_odometry = odometry_.T_current_odometry();
  const SE3 T_corrected_odometry =
      optimised_.empty() ? T_current_odometry : optimised_.back() * T_odometry_last.inverse();
  const SE3 motion =
      (T_current_odometry * T_odometry_last).inverse() * T_corrected_odometry * T_odometry_last;
  if (!is_large(motion)) {
    optimised_ = std::move(before);
    return std::nullopt;
  }
  ++corrections_;
  odometry_.correct(T_corrected_odometry);
  return T_corrected_odometry * T_current_odometry.inverse();
}

Result<bool> LoopClosure::close() {
  if (!enabled()) return false;
  decide(places_, config_.loops, candidates_);
  if (config_.loops.mode == config::LoopMode::detect) return false;
  if (auto done = optimise(); !done) return tl::unexpected(done.error());
  return !optimised_.empty() || corrections_ > 0;
}

/// Index of the last place that is not later; 0 if all are later.
std::size_t LoopClosure::place_before(std::int64_t timestamp_ns) const {
  const auto after = std::ranges::upper_bound(places_, timestamp_ns, {}, &Place::timestamp_ns);
  return after == places_.begin() ? 0 : static_cast<std::size_t>(after - places_.begin()) - 1;
}

std::size_t LoopClosure::place_near(std::int64_t timestamp_ns) const {
  const std::size_t before = place_before(timestamp_ns);
  const auto apart_ns = [&](std::size_t place) {
    return std::abs(places_[place].timestamp_ns - timestamp_ns);
  };
  return before + 1 < places_.size() && apart_ns(before + 1) < apart_ns(before) ? before + 1 : before;
}

/// True if the first place after a relocalisation agrees with the self-relocalisation; true if there is no
/// such place.
bool LoopClosure::is_accepted(std::size_t relocalisation) const {
  const auto next = std::ranges::lower_bound(places_, relocalisation, {}, &Place::relocalisations);
  const auto query = static_cast<std::size_t>(next - places_.begin());
  const auto edge = std::ranges::find_if(candidates_, [&](const LoopCandidate& candidate) {
    return candidate.by_tracker() && candidate.query == query;
  });
  return edge == candidates_.end() || edge->accepted;
}

/// Moves a pose with the places before and after it. Without optimised places, returns the relocalised pose.
/// A relocalised frame that was not fused moves with its matched place.
SE3 LoopClosure::corrected(const PosedFrame& frame) const {
  const auto& [timestamp_ns, T_odometry_camera, relocalisations] = frame;
  if (optimised_.empty()) return odometry_.T_relocalised_camera(T_odometry_camera, relocalisations);
  if (relocalisations > places_[place_before(timestamp_ns)].relocalisations && is_accepted(relocalisations)) {
    const Relocalisation& found = odometry_.relocalisation(relocalisations);
    return optimised_[found.known] * found.T_known_camera *
           (found.T_odometry_camera.inverse() * T_odometry_camera);
  }
  const auto moved_with = [&](std::size_t place) {
    return optimised_[place] * (places_[place].T_world_camera.inverse() * frame.T_odometry_camera);
  };
  const auto after = std::ranges::lower_bound(places_, timestamp_ns, {}, &Place::timestamp_ns);
  if (after == places_.begin()) return moved_with(0);
  const auto before = static_cast<std::size_t>(after - places_.begin()) - 1;
  if (after == places_.end()) return moved_with(before);
  const double fraction = static_cast<double>(timestamp_ns - places_[before].timestamp_ns) /
                          static_cast<double>(after->timestamp_ns - places_[before].timestamp_ns);
  return interpolate(moved_with(before), moved_with(before + 1), fraction);
}

Trajectory LoopClosure::corrected_trajectory() const {
  Trajectory poses;
  poses.reserve(poses_.size());
  for (const PosedFrame& frame : poses_) poses.push_back({frame.timestamp_ns, corrected(frame)});
  return poses;
}

std::optional<filter::FilterState> LoopClosure::corrected_state(std::int64_t timestamp_ns) const {
  const auto found = std::ranges::lower_bound(fused_, timestamp_ns, {}, &FusedFrame::timestamp_ns);
  if (found == fused_.end() || found->timestamp_ns != timestamp_ns) return std::nullopt;
  const SE3 T_odometry_camera = found->state.T_world_imu * rig_.T_imu_camera;
  const std::size_t relocalisations = places_[place_before(timestamp_ns)].relocalisations;
  return filter::moved(found->state, corrected({timestamp_ns, T_odometry_camera, relocalisations}) *
                                         T_odometry_camera.inverse());
}

SE3 LoopClosure::corrected_pose_near(std::int64_t timestamp_ns) const {
  check(!fused_.empty(), "a frame was fused");
  auto nearest = std::ranges::lower_bound(fused_, timestamp_ns, {}, &FusedFrame::timestamp_ns);
  if (nearest == fused_.end() || (nearest != fused_.begin() && timestamp_ns - (nearest - 1)->timestamp_ns <
                                                                   nearest->timestamp_ns - timestamp_ns))
    --nearest;
  return corrected_state(nearest->timestamp_ns)->T_world_imu * rig_.T_imu_camera;
}

Result<Trajectory> LoopClosure::poses_with(std::vector<LoopCandidate> loops) const {
  LoopClosure other = *this;
  for (LoopCandidate& loop : loops) loop.accepted = true;
  std::ranges::copy_if(candidates_, std::back_inserter(loops), &LoopCandidate::by_tracker);
  other.candidates_ = std::move(loops);
  if (auto done = other.optimise(); !done) return tl::unexpected(done.error());
  return other.corrected_trajectory();
}

}  // namespace fusebench::loops
