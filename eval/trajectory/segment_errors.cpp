#include "eval/trajectory/segment_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "eval/trajectory/euler_angles.hpp"

namespace fusebench {

SegmentErrors segment_errors(const TrajectoryPair& pair, const IndexPairs& segments, double length_m,
                             double scale) {
  SegmentErrors errors;
  errors.length_m = length_m;
  for (const auto& [i, j] : segments) {
    const SE3& reference_end = pair.reference[j].T_world_camera;
    const SE3& estimate_end = pair.estimate[j].T_world_camera;
    const SE3 reference_motion = pair.reference[i].T_world_camera.inverse() * reference_end;
    SE3 estimate_motion = pair.estimate[i].T_world_camera.inverse() * estimate_end;
    estimate_motion.translation *= scale;
    const SE3 error = reference_motion.inverse() * estimate_motion;
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

Result<KittiErrors> kitti_errors(const TrajectoryPair& pair) {
  KittiErrors sum;
  for (const double length_m : {100.0, 200.0, 300.0, 400.0, 500.0, 600.0, 700.0, 800.0}) {
    const SegmentErrors errors = segment_errors(pair, kitti_segments(pair.reference, length_m), length_m);
    for (std::size_t k = 0; k < errors.translation_m.size(); ++k) {
      sum.translation += errors.translation_m[k] / length_m;
      sum.rotation_rad_per_m += errors.rotation_rad[k] / length_m;
      ++sum.segments;
    }
  }
  if (sum.segments == 0) {
    return fail(
        ErrorCode::data_corrupt,
        fmt::format("the reference's path of {:.1f} m is shorter than KITTI's shortest segment (100 m)",
                    path_lengths(pair.reference).back()),
        "use `fusebench eval rpe --delta D --delta_unit m` for shorter recordings");
  }
  sum.translation /= static_cast<double>(sum.segments);
  sum.rotation_rad_per_m /= static_cast<double>(sum.segments);
  return sum;
}

}  // namespace fusebench
