#include "eval/record/external/system_trajectory.hpp"

#include <fmt/format.h>

#include <utility>

#include "core/base/trajectory/trajectory_extent.hpp"
#include "datasets/recording/image_logs/sens_log.hpp"

namespace fusebench::external {

namespace {

Result<trajectory_files::LoadedTrajectory> load(const SystemTrajectory& trajectory,
                                                std::vector<std::string>& warnings) {
  if (trajectory.format || trajectory.file.extension() != ".sens")
    return trajectory_files::load_trajectory(trajectory.file, {trajectory.format}, warnings);
  auto poses = image_logs::read_sens_trajectory(trajectory.file);
  if (!poses) return tl::unexpected(poses.error());
  return trajectory_files::LoadedTrajectory{trajectory_files::TrajectoryFormat::tum, std::move(*poses), {}};
}

/// Poses in another unit are mistaken for bad ones; a factor of a hundred is no bad tracking. Of poses that
/// are too near to each other it may be.
Result<void> check_scale(const Trajectory& poses, const recording::Recording& recording,
                         const std::string& file, std::vector<std::string>& warnings) {
  constexpr double kFactor = 100;
  const double is_m = trajectory::extent_m(poses);
  const double should_be_m = trajectory::extent_m(trajectory::within_time_of(recording.ground_truth, poses));
  if (!(should_be_m > 0)) return {};
  const std::string extents = fmt::format(
      "{}: the poses extend over {:.3g} m, and the ground truth over {:.3g} m", file, is_m, should_be_m);
  if (is_m > kFactor * should_be_m)
    return fail(ErrorCode::data_corrupt, extents + ": is the unit of the trajectory right (m or mm)?",
                "set `unit` in [trajectory] of the system, or pass `import --unit`");
  if (is_m > 0 && kFactor * is_m < should_be_m)
    warnings.push_back(extents + ": is the unit of the trajectory right (m or mm)?");
  return {};
}

}  // namespace

Result<FramePoses> read_system_trajectory(const SystemTrajectory& trajectory,
                                          const recording::Recording& recording,
                                          std::vector<std::string>& warnings) {
  auto loaded = load(trajectory, warnings);
  if (!loaded) return tl::unexpected(loaded.error());
  for (StampedPose& pose : loaded->poses) {
    pose.T_world_camera.translation *= trajectory.unit_m;
    if (trajectory.world_to_camera) pose.T_world_camera = pose.T_world_camera.inverse();
  }
  auto frames = poses_of_frames(std::move(*loaded), recording);
  if (!frames)
    return fail(frames.error().code, fmt::format("{}: {}", trajectory.file.string(), frames.error().message),
                frames.error().hint);
  if (auto checked = check_scale(frames->poses, recording, trajectory.file.string(), warnings); !checked)
    return tl::unexpected(checked.error());
  return frames;
}

}  // namespace fusebench::external
