#include "eval/metrics/trajectory_error/segment_errors.hpp"

#include <algorithm>
#include <cmath>

#include "eval/metrics/trajectory_error/euler_angles.hpp"
#include "eval/metrics/trajectory_error/pose_relation.hpp"

namespace fusebench::trajectory_error {

SegmentErrors segment_errors(const trajectory_files::TrajectoryPair& pair, const IndexPairs& segments,
                             double length_m, double scale) {
  SegmentErrors errors;
  errors.length_m = length_m;
  const std::vector<double> path = path_lengths(pair.reference);
  for (const auto& [i, j] : segments) {
    const SE3& estimate_end = pair.estimate[j].T_world_camera;
    const SE3 reference_motion =
        motion_between(pair.reference[i].T_world_camera, pair.reference[j].T_world_camera);
    SE3 estimate_motion = motion_between(pair.estimate[i].T_world_camera, estimate_end);
    estimate_motion.translation *= scale;
    const SE3 error = reference_motion.inverse() * estimate_motion;
    errors.path_m.push_back(path[j] - path[i]);
    errors.translation_m.push_back(error.translation.norm());
    errors.rotation_rad.push_back(so3_log(error.rotation).norm());
    const Vector3d angles = roll_pitch_yaw_rad(
        (estimate_end.rotation * error.rotation * estimate_end.rotation.conjugate()).toRotationMatrix());
    errors.yaw_rad.push_back(std::abs(angles.z()));
    errors.gravity_rad.push_back(angles.head<2>().norm());
  }
  return errors;
}

std::vector<double> rpg_lengths(const Trajectory& reference) {
  const std::vector<double> path = path_lengths(reference);
  std::vector<double> lengths;
  for (const double share : {0.1, 0.2, 0.3, 0.4, 0.5})
    lengths.push_back(path.empty() ? 0.0 : std::floor(100.0 * share * path.back()) / 100.0);
  return lengths;
}

IndexPairs kitti_segments(const Trajectory& reference, double length_m) {
  constexpr std::size_t kStep = 10;
  const std::vector<double> path = path_lengths(reference);
  IndexPairs segments;
  for (std::size_t i = 0; i < path.size(); i += kStep) {
    const auto end = std::ranges::upper_bound(path, path[i] + length_m);
    if (end == path.end()) break;
    segments.emplace_back(i, static_cast<std::size_t>(end - path.begin()));
  }
  return segments;
}

IndexPairs eth3d_segments(const Trajectory& reference, double length_m) {
  constexpr double kTolerance_m = 0.025;
  const std::vector<double> path = path_lengths(reference);
  IndexPairs segments;
  std::size_t j = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double wanted = path[i] + length_m;
    while (j + 1 < path.size() && std::abs(path[j + 1] - wanted) < std::abs(path[j] - wanted)) ++j;
    if (j + 1 >= path.size()) break;
    if (i != j && std::abs(path[j] - wanted) <= kTolerance_m) segments.emplace_back(i, j);
  }
  return segments;
}

}  // namespace fusebench::trajectory_error
