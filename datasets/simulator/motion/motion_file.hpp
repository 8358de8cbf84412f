// Motion along a recorded trajectory.
//
// Files that are read, by their columns and name:
//   TUM text         timestamp tx ty tz qx qy qz qw: colour camera (x right, y down, z forward) in a world
//                    with z up
//   *.gt.freiburg*   the same columns as ICL-NUIM publishes them: index instead of a time, left-handed with
//                    y up
//   13 columns       index and the 3x4 camera-to-world matrix (row-major) of the renderer that made
//                    ICL-NUIM: same axes
// ICL-NUIM has 30 frames a second.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "datasets/simulator/motion/motion.hpp"
#include "datasets/synthetic_imu/pose_spline.hpp"

namespace fusebench::simulator::motion {

/// Poses of a trajectory file in a world with z up, by path time (the first pose is at 0).
struct FilePath {
  Trajectory poses;       ///< T_world_camera
  double cutoff_hz = 12;  ///< higher frequencies of the poses are treated as noise
  std::vector<std::string> warnings;

  [[nodiscard]] double length_s() const {
    return seconds_between(poses.front().timestamp_ns, poses.back().timestamp_ns);
  }
};
/// Errors: data_missing; data_corrupt with file:line (a row, the order in time, a matrix that is no rotation;
/// fewer than four poses).
[[nodiscard]] Result<FilePath> read_file_path(const std::filesystem::path& file);

struct FileMotionOptions {
  double speed = 1;        ///< path seconds per second: 2 is twice as fast
  double skip_s = 0;       ///< skipped at the start of the path
  bool from_rest = false;  ///< hold the first pose, then start smoothly; otherwise start as the path does
  double rest_s = 1.0;     ///< as in MotionOptions
  double start_s = 1.0;
  bool in_place = false;  ///< poses are already in the scene's world and are not changed
};

/// Errors: configuration (speed, rest_s or start_s out of range).
[[nodiscard]] Result<void> check_file_motion(const FileMotionOptions& options);

struct FileMotion {
  synthetic_imu::PoseSpline camera;  ///< T_world_camera, world z up
  double shrunk = 1;       ///< scale factor of the positions that keeps the path in the box; 1: unchanged
  double heading_rad = 0;  ///< rotation about the vertical
};

/// Longest duration of a recording along the path, from its first frame on. The options must be in range.
[[nodiscard]] double longest_duration_s(const FilePath& path, const FileMotionOptions& options,
                                        double lead_s);

/// Unless in_place, moves the middle of the path's extent to the middle of the box, with the best rotation
/// about the vertical. Errors: configuration (an option out of range; a span longer than the path),
/// data_corrupt (the fit failed).
[[nodiscard]] Result<FileMotion> file_motion(const FilePath& path, const FileMotionOptions& options,
                                             const MotionSpan& span, const Eigen::AlignedBox3d& box,
                                             const HeadingTexture& texture = {});

}  // namespace fusebench::simulator::motion
