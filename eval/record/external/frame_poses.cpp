#include "eval/record/external/frame_poses.hpp"

#include <fmt/format.h>

#include "core/base/trajectory/association.hpp"
#include "eval/metrics/trajectory_files/stamps.hpp"

namespace fusebench::external {

namespace {

constexpr std::int64_t kSameFrame_ns = 20'000'000;

/// Poses without stamps get those of the frames.
Result<Trajectory> stamped(trajectory_files::LoadedTrajectory loaded, const recording::Recording& recording) {
  if (loaded.has_stamps()) return std::move(loaded.poses);
  const std::size_t frames = recording.frames.size();
  if (!loaded.has_numbers() && loaded.poses.size() != frames) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("{} poses without stamps for {} frames", loaded.poses.size(), frames),
                "a trajectory with stamps (TUM) may have gaps");
  }
  for (StampedPose& pose : loaded.poses) {
    const auto number = static_cast<std::size_t>(pose.timestamp_ns);
    if (number >= frames) {
      return fail(
          ErrorCode::data_corrupt,
          fmt::format("a pose of frame {}, and the recording has frames 0 to {}", number, frames - 1));
    }
    pose.timestamp_ns = recording.frames[number].timestamp_ns;
  }
  return std::move(loaded.poses);
}

}  // namespace

Result<FramePoses> poses_of_frames(trajectory_files::LoadedTrajectory loaded,
                                   const recording::Recording& recording) {
  const auto poses = stamped(std::move(loaded), recording);
  if (!poses) return tl::unexpected(poses.error());
  std::vector<std::int64_t> frames_ns;
  for (const recording::FrameEntry& frame : recording.frames) frames_ns.push_back(frame.timestamp_ns);
  FramePoses owned;
  for (const trajectory::AssociatedPair& pair :
       trajectory::associate(frames_ns, trajectory_files::stamps_of(*poses), kSameFrame_ns, 0)) {
    const recording::FrameEntry& frame = recording.frames[pair.first];
    const StampedPose& pose = (*poses)[pair.second];
    owned.poses.push_back(pose);
    // The frame's instant may differ from its stamp; the pose's differs as much.
    owned.stamps.emplace_back(pose.timestamp_ns, pose.timestamp_ns + frame.capture_ns - frame.timestamp_ns);
  }
  if (!owned.poses.empty()) return owned;
  if (poses->empty()) return fail(ErrorCode::data_corrupt, "the trajectory has no poses");
  return fail(
      ErrorCode::data_corrupt,
      fmt::format("none of {} poses ({:.3f} to {:.3f} s) belongs to one of {} frames ({:.3f} to {:.3f} s)",
                  poses->size(), trajectory_files::stamp_seconds(poses->front().timestamp_ns),
                  trajectory_files::stamp_seconds(poses->back().timestamp_ns), frames_ns.size(),
                  trajectory_files::stamp_seconds(frames_ns.front()),
                  trajectory_files::stamp_seconds(frames_ns.back())),
      "stamps must be those of the colour images, within 0.02 s");
}

}  // namespace fusebench::external
