#include "core/estimator/places/loops/loop_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/solvers.hpp"
#include "core/config/groups/loops_config.hpp"
#include "core/estimator/filter/pose_clones.hpp"

namespace fusebench::loops {

namespace {

constexpr std::string_view kContradicts = "contradicts the poses, whatever supports it";

/// Derivative of the edge's tangent by the instants of its two places (per second).
std::array<Vector6d, 2> motion_of_edge(const Place& known, const Place& query, const SE3& T_known_query) {
  std::array<Vector6d, 2> motion;
  motion[0] << T_known_query.rotation.conjugate() * known.angular_velocity_camera_radps,
      known.velocity_camera_mps + known.angular_velocity_camera_radps.cross(T_known_query.translation);
  motion[1] << query.angular_velocity_camera_radps, T_known_query.rotation * query.velocity_camera_mps;
  return motion;
}

double chi2_of(std::span<const Place> places, const LoopCandidate& candidate,
               const config::LoopsConfig& config) {
  const GraphEdge path = path_edge(places, candidate.known, candidate.query, config);
  GraphEdge both = loop_edge(places, candidate, config);
  both.covariance += path.covariance;
  const Vector6d error = pose_minus(path.T_a_b, both.T_a_b);
  return error.dot(both.covariance.ldlt().solve(error));
}

/// True if two candidates agree, given the motion between their places, which are close in time.
bool agree(std::span<const Place> places, const LoopCandidate& a, const LoopCandidate& b,
           const config::LoopsConfig& config) {
  const double apart_s =
      std::abs(seconds_between(places[a.query].timestamp_ns, places[b.query].timestamp_ns));
  if (apart_s > config.agreeing_within_s || a.query == b.query) return false;
  const SE3 T_known = places[a.known].T_world_camera.inverse() * places[b.known].T_world_camera;
  const SE3 T_query = places[a.query].T_world_camera.inverse() * places[b.query].T_world_camera;
  GraphEdge both = loop_edge(places, a, config);
  both.covariance += loop_edge(places, b, config).covariance;
  const auto path = [&](std::size_t i, std::size_t j) {
    return path_edge(places, std::min(i, j), std::max(i, j), config);
  };
  if (a.known != b.known) both.covariance += path(a.known, b.known).covariance;
  both.covariance += path(a.query, b.query).covariance;
  const Vector6d error = pose_minus(T_known * b.pair.T_known_query * T_query.inverse(), both.T_a_b);
  return error.dot(both.covariance.ldlt().solve(error)) <= config.agreeing_chi2;
}

enum class Verdict { decided, needs_support };

Verdict decide_alone(LoopCandidate& candidate, const config::LoopsConfig& config) {
  if (candidate.by_tracker()) {
    candidate.accepted = candidate.chi2 <= config.max_supported_chi2;
    candidate.verdict = candidate.accepted ? kFoundItself : kContradicts;
    return Verdict::decided;
  }
  candidate.accepted = candidate.chi2 <= config.max_chi2;
  if (candidate.accepted) {
    candidate.verdict = "agrees with the poses within their drift";
    return Verdict::decided;
  }
  if (candidate.chi2 <= config.max_supported_chi2) return Verdict::needs_support;
  candidate.verdict = kContradicts;
  return Verdict::decided;
}

}  // namespace

Matrix6d covariance_by_axis(double rotation_sigma_rad, double position_sigma_m) {
  Vector6d sigmas;
  sigmas << Vector3d::Constant(rotation_sigma_rad), Vector3d::Constant(position_sigma_m);
  return sigmas.cwiseAbs2().asDiagonal();
}

Matrix6d not_negative(const Matrix6d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(Matrix6d(0.5 * (covariance + covariance.transpose())));
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() *
         eigen.eigenvectors().transpose();
}

/// Inflates the drift of tracking, which the filter underestimates; that of dead reckoning is realistic.
GraphEdge path_edge(std::span<const Place> places, std::size_t a, std::size_t b,
                    const config::LoopsConfig& config) {
  const Place& from = places[a];
  const Place& to = places[b];
  const Matrix6d carried = filter::pose_transport(to.T_world_camera, from.T_world_camera);
  const auto added = [&](const Matrix6d Place::*covariance) {
    return not_negative(to.*covariance - carried * (from.*covariance) * carried.transpose());
  };
  GraphEdge edge{a, b, from.T_world_camera.inverse() * to.T_world_camera, Matrix6d::Zero(), false};
  const Quaterniond R_from_world = from.T_world_camera.rotation.conjugate();
  edge.covariance =
      config.drift_factor * config.drift_factor * with_position_in(R_from_world, added(&Place::covariance)) +
      with_position_in(R_from_world, added(&Place::lost_covariance)) +
      covariance_by_axis(config.path_rotation_sigma_rad, config.path_position_sigma_m);
  return edge;
}

/// The instants of a place's images are uncertain, which gives an error along its motion.
GraphEdge loop_edge(std::span<const Place> places, const LoopCandidate& candidate,
                    const config::LoopsConfig& config) {
  GraphEdge edge{candidate.known, candidate.query, candidate.pair.T_known_query, candidate.pair.covariance,
                 !candidate.by_tracker()};
  edge.covariance += covariance_by_axis(config.loop_rotation_sigma_rad, config.loop_position_sigma_m);
  for (const Vector6d& motion :
       motion_of_edge(places[candidate.known], places[candidate.query], edge.T_a_b)) {
    edge.covariance += config.timing_sigma_s * config.timing_sigma_s * motion * motion.transpose();
  }
  return edge;
}

void decide(std::span<const Place> places, const config::LoopsConfig& config,
            std::vector<LoopCandidate>& candidates) {
  std::vector<LoopCandidate*> pending;
  for (LoopCandidate& candidate : candidates) {
    if (!candidate.pair.same) continue;
    candidate.chi2 = chi2_of(places, candidate, config);
    if (decide_alone(candidate, config) == Verdict::needs_support) pending.push_back(&candidate);
  }
  for (LoopCandidate* const candidate : pending) {
    const bool supported = std::ranges::any_of(candidates, [&](const LoopCandidate& other) {
      return &other != candidate && other.pair.same && other.evidence != LoopEvidence::tracker_alone &&
             other.chi2 <= config.max_supported_chi2 && agree(places, *candidate, other, config);
    });
    candidate->accepted = supported;
    candidate->verdict = supported ? "agrees with another loop near to it"
                                   : "neither agrees with the poses nor with another loop";
  }
}

}  // namespace fusebench::loops
