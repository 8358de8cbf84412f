#include "eval/metrics/trajectory_error/trajectory_error.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <utility>

#include "eval/metrics/trajectory_error/euler_angles.hpp"

namespace fusebench::trajectory_error {

namespace {

std::vector<SE3> poses_of(const Trajectory& trajectory) {
  std::vector<SE3> poses;
  poses.reserve(trajectory.size());
  for (const StampedPose& pose : trajectory) poses.push_back(pose.T_world_camera);
  return poses;
}

/// The same stamps with other poses.
Trajectory with_poses(Trajectory trajectory, const std::vector<SE3>& poses) {
  for (std::size_t i = 0; i < trajectory.size(); ++i) trajectory[i].T_world_camera = poses[i];
  return trajectory;
}

/// Position without the component across the plane, and of the orientation the turn within it: the angle
/// about the normal of Euler angles about fixed axes x, y, z.
SE3 projected(const SE3& pose, Plane plane) {
  if (plane == Plane::none) return pose;
  const int normal = plane == Plane::xy ? 2 : plane == Plane::xz ? 1 : 0;
  const Vector3d angles = roll_pitch_yaw_rad(pose.rotation_matrix());
  SE3 flat{so3_exp(angles[normal] * Vector3d::Unit(normal)), pose.translation};
  flat.translation[normal] = 0;
  return flat;
}

/// Both sides as they are compared, and what they have in common. Positions are relative to the image of the
/// alignment: those far from the origin keep the digits that they are given with.
struct Compared {
  std::vector<SE3> reference;
  std::vector<SE3> estimate;
  TrajectoryError error;
};

Result<Compared> compared(const trajectory_files::TrajectoryPair& pair, const AlignmentRequest& request,
                          Plane plane, bool keep_poses) {
  Compared result{poses_of(pair.reference), poses_of(pair.estimate), {}};
  const Result<Similarity> alignment = align(result.reference, result.estimate, request);
  if (!alignment) return tl::unexpected(alignment.error());
  if (keep_poses) {
    result.error.compared = {pair.reference, pair.estimate};
    for (StampedPose& pose : result.error.compared.reference)
      pose.T_world_camera = projected(pose.T_world_camera, plane);
    for (StampedPose& pose : result.error.compared.estimate)
      pose.T_world_camera = projected(*alignment * pose.T_world_camera, plane);
  }
  for (SE3& pose : result.reference)
    pose = projected({pose.rotation, pose.translation - alignment->image}, plane);
  for (SE3& pose : result.estimate) pose = projected(alignment->from_image(pose), plane);
  result.error.alignment_mode = request.mode;
  result.error.alignment = *alignment;
  result.error.pairs = pair.size();
  result.error.possible = pair.possible;
  result.error.coverage = pair.coverage();
  return result;
}

std::string described(const RelativeOptions& options) {
  return fmt::format("delta = {} {}, {} motions", options.delta.value, to_string(options.delta.unit),
                     options.selection == MotionSelection::all ? "all" : "consecutive");
}

tl::unexpected<Error> without_errors(std::size_t poses, const RelativeOptions& options, std::size_t motions) {
  if (motions == 0) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("no motion of {} poses fits ({})", poses, described(options)),
                "a smaller delta, or a larger --delta_tol with --all_pairs, finds more");
  }
  return fail(
      ErrorCode::data_corrupt,
      fmt::format("the reference does not move in any of {} motions ({})", motions, described(options)),
      "ratios need a reference that moves: compare trans_part");
}

std::optional<double> error_of_motion(PoseRelation relation, const Compared& sides, std::size_t i,
                                      std::size_t j) {
  return relative_error(relation, Motion{sides.reference[i], sides.reference[j]},
                        Motion{sides.estimate[i], sides.estimate[j]});
}

Result<TrajectoryError> errors_of_motions(Compared sides, const trajectory_files::TrajectoryPair& pair,
                                          const RelativeOptions& options, const IndexPairs& motions) {
  TrajectoryError result = std::move(sides.error);
  result.relation = options.relation;
  result.errors.reserve(motions.size());
  result.at_ns.reserve(motions.size());
  if (options.keep_poses) result.at.reserve(motions.size());
  for (const auto& [i, j] : motions) {
    const auto error = error_of_motion(options.relation, sides, i, j);
    if (!error) continue;
    result.errors.push_back(*error);
    result.at_ns.push_back(pair.estimate[j].timestamp_ns);
    if (options.keep_poses) result.at.push_back(j);
  }
  if (result.errors.empty()) return without_errors(pair.size(), options, motions.size());
  result.stats = metrics::statistics(result.errors);
  return result;
}

/// Turns of about delta between any two poses, without a list of them.
Result<TrajectoryError> errors_of_turns(Compared sides, Trajectory selecting, const RelativeOptions& options,
                                        std::size_t turns) {
  TrajectoryError result = std::move(sides.error);
  result.relation = options.relation;
  const auto both = std::make_shared<const Compared>(std::move(sides));
  const auto turning = std::make_shared<const Trajectory>(std::move(selecting));
  result.streamed = [both, turning, options](const ValueVisitor& visit) {
    visit_turns(*turning, options.delta, options.tolerance, options.listing.most_compared,
                [&](std::size_t i, std::size_t j) {
                  if (const auto error = error_of_motion(options.relation, *both, i, j)) visit(*error);
                });
  };
  result.stats = streamed_statistics(result.streamed);
  if (result.stats.count == 0) return without_errors(turning->size(), options, turns);
  return result;
}

/// How many turns there are, where all pairs of poses could be more than are listed; 0 elsewhere.
Result<std::size_t> count_turns(const Trajectory& selecting, const RelativeOptions& options) {
  const std::size_t poses = selecting.size();
  const bool few = poses < 2 || (poses - 1) / 2 < options.listing.most / poses;
  if (options.selection != MotionSelection::all || !is_angle(options.delta.unit) || few) return 0;
  std::size_t turns = 0;
  const std::size_t compared =
      visit_turns(selecting, options.delta, options.tolerance, options.listing.most_compared,
                  [&](std::size_t, std::size_t) { ++turns; });
  if (auto usual = check_compared(options.listing, compared); !usual) return tl::unexpected(usual.error());
  return turns;
}

}  // namespace

std::string_view to_string(Plane plane) {
  switch (plane) {
    case Plane::none:
      return "none";
    case Plane::xy:
      return "xy";
    case Plane::xz:
      return "xz";
    case Plane::yz:
      return "yz";
  }
  return "";
}

Result<Similarity> align(const trajectory_files::TrajectoryPair& pair, const AlignmentRequest& request) {
  return align(poses_of(pair.reference), poses_of(pair.estimate), request);
}

Result<TrajectoryError> absolute_error(const trajectory_files::TrajectoryPair& pair,
                                       const AbsoluteOptions& options) {
  if (options.relation == PoseRelation::distance_error_ratio) {
    return fail(ErrorCode::usage, fmt::format("{} is a relation of motions", to_string(options.relation)),
                "use it with `fusebench eval rpe`");
  }
  Result<Compared> sides = compared(pair, options.alignment, options.plane, options.keep_poses);
  if (!sides) return tl::unexpected(sides.error());
  TrajectoryError result = std::move(sides->error);
  result.relation = options.relation;
  for (std::size_t i = 0; i < pair.size(); ++i) {
    result.errors.push_back(absolute_error(options.relation, sides->reference[i], sides->estimate[i]));
    result.at_ns.push_back(pair.estimate[i].timestamp_ns);
    if (options.keep_poses) result.at.push_back(i);
  }
  result.stats = metrics::statistics(result.errors);
  return result;
}

Result<TrajectoryError> relative_error(const trajectory_files::TrajectoryPair& pair,
                                       const RelativeOptions& options) {
  if (const auto sensible = check_delta(options.delta); !sensible) return tl::unexpected(sensible.error());
  // Lengths of the estimate are those of the aligned one: a scale is part of the alignment.
  Result<Compared> sides = compared(pair, options.alignment, options.plane, options.keep_poses);
  if (!sides) return tl::unexpected(sides.error());
  Trajectory selecting = options.from_reference ? with_poses(pair.reference, sides->reference)
                                                : with_poses(pair.estimate, sides->estimate);
  const Result<std::size_t> turns = count_turns(selecting, options);
  if (!turns) return tl::unexpected(turns.error());
  if (auto listed = check_listing(options.listing, *turns); !listed) return tl::unexpected(listed.error());
  if (*turns > options.listing.most)
    return errors_of_turns(std::move(*sides), std::move(selecting), options, *turns);
  const IndexPairs motions = options.selection == MotionSelection::all
                                 ? all_motions(selecting, options.delta, options.tolerance)
                                 : consecutive_motions(selecting, options.delta);
  return errors_of_motions(std::move(*sides), pair, options, motions);
}

Result<TrajectoryError> relative_error(const trajectory_files::TrajectoryPair& pair,
                                       const RelativeOptions& options, const IndexPairs& motions) {
  Result<Compared> sides = compared(pair, options.alignment, options.plane, options.keep_poses);
  if (!sides) return tl::unexpected(sides.error());
  return errors_of_motions(std::move(*sides), pair, options, motions);
}

Trajectory downsampled(const Trajectory& trajectory, std::size_t count) {
  if (count >= trajectory.size() || count == 0) return trajectory;
  Trajectory kept;
  const double step =
      count > 1 ? static_cast<double>(trajectory.size() - 1) / static_cast<double>(count - 1) : 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const bool last = count > 1 && k + 1 == count;
    kept.push_back(last ? trajectory.back()
                        : trajectory[static_cast<std::size_t>(static_cast<double>(k) * step)]);
  }
  return kept;
}

Trajectory moved_only(const Trajectory& trajectory, double distance_m, double angle_rad) {
  Trajectory kept;
  double path_m = 0;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const SE3& pose = trajectory[i].T_world_camera;
    if (i > 0) path_m += (pose.translation - trajectory[i - 1].T_world_camera.translation).norm();
    const bool moved = kept.empty() || path_m >= distance_m ||
                       rotation_angle_rad(kept.back().T_world_camera.rotation, pose.rotation) >= angle_rad;
    if (!moved) continue;
    kept.push_back(trajectory[i]);
    path_m = 0;
  }
  return kept;
}

}  // namespace fusebench::trajectory_error
