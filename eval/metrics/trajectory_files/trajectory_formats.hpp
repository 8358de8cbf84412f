// Trajectories as people keep them: TUM, KITTI, EuRoC and other files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/io/text_table.hpp"
#include "core/base/trajectory/trajectory_rows.hpp"
#include "core/base/types.hpp"

namespace fusebench::trajectory_files {

enum class TrajectoryFormat {
  tum,       ///< "timestamp tx ty tz qx qy qz qw" and more columns, seconds and metres
  kitti,     ///< the upper 3x4 of a pose, or all 4x4, a pose a row (matrix_rows.hpp)
  euroc,     ///< "timestamp[ns],px,py,pz,qw,qx,qy,qz" and more columns, such as velocity and biases
  log,       ///< Redwood's and Open3D's: the number of a frame, then its 4x4 pose (log_trajectory.hpp)
  openvins,  ///< tum, then the upper triangles of the covariances of orientation and position (ov_eval)
};
[[nodiscard]] std::string_view to_string(TrajectoryFormat format);  ///< "tum", "kitti", ...
/// Error usage for another name.
[[nodiscard]] Result<TrajectoryFormat> parse_trajectory_format(std::string_view text);

/// What an estimator says of its own error, in OpenVINS' conventions.
struct PoseCovariance {
  Matrix3d orientation_rad2 = Matrix3d::Zero();  ///< of a rotation on the right, in the frame of the body
  Matrix3d position_m2 = Matrix3d::Zero();       ///< in the world of the estimate
};

/// By what the poses of a file are told apart.
enum class PoseKey {
  stamp,
  number,  ///< each pose has that of its frame, and there may be gaps
  order,   ///< poses are counted from 0 without gaps
};

struct LoadedTrajectory {
  TrajectoryFormat format = TrajectoryFormat::tum;
  Trajectory poses;  ///< without stamps, the number of a pose is its stamp in nanoseconds
  std::vector<PoseCovariance> covariances = {};  ///< one a pose with openvins; else none
  std::string format_source = {};                ///< "names in line 1", "as given", "by its columns"
  PoseKey key = PoseKey::stamp;
  [[nodiscard]] bool has_stamps() const { return key == PoseKey::stamp; }
  [[nodiscard]] bool has_numbers() const { return key == PoseKey::number; }
};

/// "s", "ms", "us" or "ns". Error usage for another name.
[[nodiscard]] Result<io::TimeUnit> parse_stamp_unit(std::string_view text);

/// The upper 3x4 of each pose, row by row, a pose a line; numbers with their shortest round trip.
[[nodiscard]] std::string kitti_text(const Trajectory& trajectory);

/// How a file is read; what is not given is recognised.
struct TrajectoryReading {
  std::optional<TrajectoryFormat> format = {};
  std::optional<io::TimeUnit> stamp_unit = {};
  trajectory::Duplicates duplicates = trajectory::Duplicates::rare_last;
  bool tum_without_commas = false;  ///< with euroc: rows without commas are recognised, as TUM text is
  bool unit_of_this_file = false;   ///< stamp_unit is not of several files, of which some may be in seconds
};

/// Reads a trajectory. A line of names before the rows, with or without '#', says which columns are which and
/// in which unit stamps count (trajectory::read_pose_head()). Without one the format is the given one, else
/// that of the first rows' columns. The unit of
/// stamps is the named one, else the given one, else that of the format (euroc: nanoseconds), else by the
/// size of the first stamp (trajectory::stamp_unit_of()). Rows of lost frames are left out
/// (trajectory::read_pose_rows()); so are their covariances. Rotations are made unit and orthonormal.
/// Warnings say what contradicts, what was guessed, left out and not used, how far off rotations were, and
/// what ordered() did.
///
/// Errors name file:line: data_missing; data_corrupt for a row that is no pose, a matrix that is no rotation
/// to a hundredth or whose last row is not 0 0 0 1, a row of euroc without commas, those of ordered() and
/// read_pose_head(), columns that fit no format, or (openvins) time that does not increase or a variance
/// below zero.
[[nodiscard]] Result<LoadedTrajectory> load_trajectory(const std::filesystem::path& file,
                                                       const TrajectoryReading& reading,
                                                       std::vector<std::string>& warnings);

}  // namespace fusebench::trajectory_files
