// The poses of another system, in any file that one writes, for the frames of a recording.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "datasets/recording/recording.hpp"
#include "eval/metrics/trajectory_files/trajectory_formats.hpp"
#include "eval/record/external/frame_poses.hpp"

namespace fusebench::external {

/// Where a system leaves its poses, and what they are.
struct SystemTrajectory {
  std::filesystem::path file;  ///< of a program: below {output}
  /// Nothing: the first row tells it, or a name that ends in ".sens" (poses of a .sens file, by the stamps of
  /// colour).
  std::optional<trajectory_files::TrajectoryFormat> format;
  double unit_m = 1;
  bool world_to_camera = false;  ///< the inverse of the pose of the camera
  bool online = false;           ///< poses as they were when each frame came; else those of the end
};

/// The poses that belong to frames, in metres, camera to world. Of stamps that are repeated a few times the
/// last pose counts. Warnings say what was repaired, and that poses extend over less than a hundredth of the
/// truth, as those in another unit do. Errors: those of trajectory_files::load_trajectory(),
/// image_logs::read_sens_trajectory() and poses_of_frames(); data_corrupt (poses that extend over more than a
/// hundred times the ground truth).
[[nodiscard]] Result<FramePoses> read_system_trajectory(const SystemTrajectory& trajectory,
                                                        const recording::Recording& recording,
                                                        std::vector<std::string>& warnings);

}  // namespace fusebench::external
