#include "core/loops/loop_closure.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/filter/pose_clones.hpp"

namespace fusebench::loops {

namespace {

DepthImage every_fourth(const DepthImage& depth_m) {
  DepthImage small(depth_m.width / kDepthStep, depth_m.height / kDepthStep);
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) small(x, y) = depth_m(kDepthStep * x, kDepthStep * y);
  }
  return small;
}

double seconds_between(const Place& earlier, const Place& later) {
  constexpr double kSeconds = 1e-9;
  return kSeconds * static_cast<double>(later.timestamp_ns - earlier.timestamp_ns);
}

/// Position errors of the tangent of pose_minus(), from the world to frame a.
Matrix6d position_in(const Matrix6d& covariance, const SE3& T_world_a) {
  Matrix6d turn = Matrix6d::Identity();
  turn.bottomRightCorner<3, 3>() = T_world_a.rotation_matrix().transpose();
  return turn * covariance * turn.transpose();
}

/// The covariance without what is negative in it.
Matrix6d not_negative(const Matrix6d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(0.5 * (covariance + covariance.transpose()));
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() *
         eigen.eigenvectors().transpose();
}

Matrix6d covariance_of(double rotation_sigma_rad, double position_sigma_m) {
  Vector6d sigmas;
  sigmas << Vector3d::Constant(rotation_sigma_rad), Vector3d::Constant(position_sigma_m);
  return sigmas.cwiseAbs2().asDiagonal();
}

}  // namespace

void LoopClosure::add_pose(std::int64_t timestamp_ns, const SE3& T_world_camera) {
  if (enabled()) poses_.push_back({timestamp_ns, T_world_camera});
}

void LoopClosure::add_fused(const RgbdFrame& frame, const filter::GaussianState& estimate, double blur_px) {
  if (!enabled()) return;
  const config::LoopsConfig& config = config_.loops;
  fused_.push_back({frame.timestamp_ns, estimate.mean});
  const SE3 T_world_camera = estimate.mean.T_world_imu * rig_.T_imu_camera;
  ++fused_since_place_;
  if (!places_.empty()) {
    const SE3 moved = places_.back().T_world_camera.inverse() * T_world_camera;
    const bool near =
        moved.translation.norm() < config.place_distance_m &&
        rotation_angle_rad(moved.rotation, Quaterniond::Identity()) < radians(config.place_angle_deg);
    if (near && fused_since_place_ < config.query_every) return;
  }
  fused_since_place_ = 0;
  Place place;
  place.timestamp_ns = frame.timestamp_ns;
  place.T_world_camera = T_world_camera;
  const Matrix6d to_camera = filter::pose_transport(T_world_camera, estimate.mean.T_world_imu);
  const filter::GaussianState in_first = filter::in_first_camera_world(estimate);
  place.covariance = to_camera * in_first.covariance.topLeftCorner<filter::kPoseSize, filter::kPoseSize>() *
                     to_camera.transpose();
  if (config_.terms.prior == config::Prior::imu)
    place.gravity_camera = T_world_camera.rotation.conjugate() * estimate.mean.gravity_direction_world;
  place.blur_px = blur_px;
  place.code = fern_code(frame.color, frame.depth_m);
  place.landmarks = relocalisation::landmarks_of(frame.grey, frame.depth_m, rig_.camera, config_);
  place.small_depth_m = every_fourth(frame.depth_m);
  places_.push_back(std::move(place));
  look_for_loops(places_.size() - 1);
}

/// Among the places that were left long ago: the most similar ones, until one is verified.
void LoopClosure::look_for_loops(std::size_t query) {
  const config::LoopsConfig& config = config_.loops;
  std::vector<std::pair<double, std::size_t>> similar;
  for (std::size_t known = 0; known < query; ++known) {
    if (seconds_between(places_[known], places_[query]) < config.least_age_s) break;
    const double different = dissimilarity(places_[known].code, places_[query].code);
    if (different <= config.max_dissimilarity) similar.emplace_back(different, known);
  }
  std::ranges::sort(similar);
  similar.resize(std::min(similar.size(), static_cast<std::size_t>(config.max_candidates)));
  for (const auto& [different, known] : similar) {
    LoopCandidate candidate{known, query, different, {}, 0, false, {}};
    candidate.pair = verify_pair(places_[known], places_[query], rig_.camera, config_);
    const bool same = candidate.pair.same;
    if (!same) candidate.verdict = candidate.pair.reason;
    candidates_.push_back(std::move(candidate));
    if (same) break;
  }
}

/// What the filter says of the motion from a to b, with the drift that came on in between.
GraphEdge LoopClosure::path_edge(std::size_t a, std::size_t b) const {
  const Place& from = places_[a];
  const Place& to = places_[b];
  const Matrix6d carried = filter::pose_transport(to.T_world_camera, from.T_world_camera);
  const Matrix6d drift = not_negative(to.covariance - carried * from.covariance * carried.transpose());
  const double factor = config_.loops.drift_factor * config_.loops.drift_factor;
  GraphEdge edge{a, b, from.T_world_camera.inverse() * to.T_world_camera, Matrix6d::Zero(), false};
  edge.covariance = factor * position_in(drift, from.T_world_camera) +
                    covariance_of(config_.loops.path_rotation_sigma_rad, config_.loops.path_position_sigma_m);
  return edge;
}

GraphEdge LoopClosure::loop_edge(const LoopCandidate& candidate) const {
  return {candidate.known, candidate.query, candidate.pair.T_known_query,
          candidate.pair.covariance +
              covariance_of(config_.loops.loop_rotation_sigma_rad, config_.loops.loop_position_sigma_m),
          true};
}

double LoopClosure::chi2_of(const LoopCandidate& candidate) const {
  const GraphEdge path = path_edge(candidate.known, candidate.query);
  GraphEdge both = loop_edge(candidate);
  both.covariance += path.covariance;
  const Vector6d error = pose_minus(path.T_a_b, both.T_a_b);
  return error.dot(both.covariance.ldlt().solve(error));
}

/// By way of the motion between their places, which are near in time.
bool LoopClosure::agree(const LoopCandidate& a, const LoopCandidate& b) const {
  const auto apart_s = [&](std::size_t i, std::size_t j) {
    return std::abs(seconds_between(places_[i], places_[j]));
  };
  if (apart_s(a.query, b.query) > config_.loops.agreeing_within_s || a.query == b.query) return false;
  const SE3 T_known = places_[a.known].T_world_camera.inverse() * places_[b.known].T_world_camera;
  const SE3 T_query = places_[a.query].T_world_camera.inverse() * places_[b.query].T_world_camera;
  GraphEdge both = loop_edge(a);
  both.covariance += loop_edge(b).covariance;
  const auto path = [&](std::size_t i, std::size_t j) { return path_edge(std::min(i, j), std::max(i, j)); };
  if (a.known != b.known) both.covariance += path(a.known, b.known).covariance;
  both.covariance += path(a.query, b.query).covariance;
  const Vector6d error = pose_minus(T_known * b.pair.T_known_query * T_query.inverse(), both.T_a_b);
  return error.dot(both.covariance.ldlt().solve(error)) <= config_.loops.agreeing_chi2;
}

void LoopClosure::decide() {
  std::vector<LoopCandidate*> pending;
  for (LoopCandidate& candidate : candidates_) {
    if (!candidate.pair.same) continue;
    candidate.chi2 = chi2_of(candidate);
    candidate.accepted = candidate.chi2 <= config_.loops.max_chi2;
    if (candidate.accepted) {
      candidate.verdict = "agrees with the poses within their drift";
    } else {
      pending.push_back(&candidate);
    }
  }
  for (LoopCandidate* const candidate : pending) {
    const bool supported = std::ranges::any_of(candidates_, [&](const LoopCandidate& other) {
      return &other != candidate && other.pair.same && agree(*candidate, other);
    });
    candidate->accepted = supported;
    candidate->verdict = supported ? "agrees with another loop near to it"
                                   : "neither agrees with the poses nor with another loop";
  }
}

/// Edges that do not fit go, the worst one first.
Result<void> LoopClosure::optimise() {
  PoseGraph graph;
  // The errors of gravity (bias and scale of the accelerometer, its rotation against the camera) are common
  // to all places: together they tell as much as one.
  graph.gravity_sigma_rad =
      radians(config_.loops.gravity_sigma_deg) * std::sqrt(static_cast<double>(places_.size()));
  for (std::size_t i = 0; i < places_.size(); ++i) {
    graph.T_world_camera.push_back(places_[i].T_world_camera);
    graph.gravity_camera.push_back(places_[i].gravity_camera);
    if (i > 0) graph.edges.push_back(path_edge(i - 1, i));
  }
  const std::size_t first_loop = graph.edges.size();
  std::vector<LoopCandidate*> of_edges;
  for (LoopCandidate& candidate : candidates_) {
    if (!candidate.accepted) continue;
    graph.edges.push_back(loop_edge(candidate));
    of_edges.push_back(&candidate);
  }
  const double worst_allowed =
      filter::kPoseSize * config_.loops.worst_edge_sigmas * config_.loops.worst_edge_sigmas;
  for (int dropped = 0; !of_edges.empty(); ++dropped) {
    auto poses = optimised_poses(graph);
    if (!poses) return tl::unexpected(poses.error());
    const auto residual = [&](const GraphEdge& edge) { return squared_residual(edge, *poses); };
    const auto loops = std::span(graph.edges).subspan(first_loop);
    const auto worst = std::ranges::max_element(loops, {}, residual);
    if (residual(*worst) <= worst_allowed || dropped == config_.loops.max_dropped_edges) {
      optimised_ = std::move(*poses);
      return {};
    }
    const std::ptrdiff_t place = worst - loops.begin();
    of_edges[static_cast<std::size_t>(place)]->accepted = false;
    of_edges[static_cast<std::size_t>(place)]->verdict =
        "does not fit the other edges after the optimisation";
    of_edges.erase(of_edges.begin() + place);
    graph.edges.erase(graph.edges.begin() + static_cast<std::ptrdiff_t>(first_loop) + place);
  }
  return {};
}

Result<bool> LoopClosure::close() {
  if (!enabled()) return false;
  decide();
  if (config_.loops.mode != config::LoopMode::final) return false;
  if (auto done = optimise(); !done) return tl::unexpected(done.error());
  return !optimised_.empty();
}

/// Moved with the places before and after it.
SE3 LoopClosure::corrected(std::int64_t timestamp_ns, const SE3& T_world_camera) const {
  const auto moved_with = [&](std::size_t place) {
    return optimised_[place] * (places_[place].T_world_camera.inverse() * T_world_camera);
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
  Trajectory corrected_poses = poses_;
  if (optimised_.empty()) return corrected_poses;
  for (StampedPose& pose : corrected_poses)
    pose.T_world_camera = corrected(pose.timestamp_ns, pose.T_world_camera);
  return corrected_poses;
}

std::optional<filter::FilterState> LoopClosure::corrected_state(std::int64_t timestamp_ns) const {
  const auto found = std::ranges::lower_bound(fused_, timestamp_ns, {}, &FusedFrame::timestamp_ns);
  if (found == fused_.end() || found->timestamp_ns != timestamp_ns) return std::nullopt;
  filter::FilterState state = found->state;
  if (optimised_.empty()) return state;
  const SE3 before = state.T_world_imu;
  state.T_world_imu = corrected(timestamp_ns, before * rig_.T_imu_camera) * rig_.T_imu_camera.inverse();
  const Quaterniond turn = state.T_world_imu.rotation * before.rotation.conjugate();
  state.velocity_world_mps = turn * state.velocity_world_mps;
  state.gravity_direction_world = (turn * state.gravity_direction_world).normalized();
  return state;
}

std::string LoopClosure::table() const {
  constexpr double kSeconds = 1e-9;
  std::string text;
  for (const LoopCandidate& c : candidates_) {
    const SE3& pose = c.pair.T_known_query;
    const Vector3d& t = pose.translation;
    const Quaterniond& q = pose.rotation;
    const auto sigma = [&](int first) {
      return c.pair.same ? std::sqrt(loop_edge(c).covariance.diagonal().segment<3>(first).mean()) : 0.0;
    };
    text += fmt::format("{:.6f},{:.6f},{:.6g},{:.6g},{:.6g},{:.8g},{:.8g},{:.8g},{:.8g},{:.3g},{:.3g},",
                        kSeconds * static_cast<double>(places_[c.query].timestamp_ns),
                        kSeconds * static_cast<double>(places_[c.known].timestamp_ns), t.x(), t.y(), t.z(),
                        q.x(), q.y(), q.z(), q.w(), sigma(0), sigma(3));
    text += fmt::format("{:.3f},{},{},{:.3f},{:.3f},{:.4g},{},\"{}\"\n", c.dissimilarity, c.pair.matches,
                        c.pair.inliers, c.pair.consistent_share, c.pair.violating_share, c.chi2,
                        c.accepted ? "accepted" : "refused", c.verdict);
  }
  return text;
}

}  // namespace fusebench::loops
