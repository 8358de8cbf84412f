// Trajectories as people keep them: TUM, KITTI, EuRoC and other files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "core/io/text_table.hpp"
#include "core/trajectory/trajectory_rows.hpp"

namespace fusebench::trajectory_files {

enum class TrajectoryFormat {
  tum,       ///< "timestamp tx ty tz qx qy qz qw", seconds and metres
  kitti,     ///< the upper 3x4 of a pose, row by row; no stamps, poses go by their number
  euroc,     ///< "timestamp[ns],px,py,pz,qw,qx,qy,qz", with or without velocity and biases (data.csv)
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

struct LoadedTrajectory {
  TrajectoryFormat format = TrajectoryFormat::tum;
  Trajectory poses;  ///< without stamps, the number of a pose is its stamp in nanoseconds
  std::vector<PoseCovariance> covariances = {};  ///< one a pose with openvins; else none
  [[nodiscard]] bool has_stamps() const { return format != TrajectoryFormat::kitti && !has_numbers(); }
  /// Each pose says the number of its frame.
  [[nodiscard]] bool has_numbers() const { return format == TrajectoryFormat::log; }
};

/// "s", "ms", "us" or "ns". Error usage for another name.
[[nodiscard]] Result<io::TimeUnit> parse_stamp_unit(std::string_view text);

/// The upper 3x4 of each pose, row by row, a pose a line; numbers with their shortest round trip.
[[nodiscard]] std::string kitti_text(const Trajectory& trajectory);

/// How a file is read; what is not given is recognised.
struct TrajectoryReading {
  std::optional<TrajectoryFormat> format = {};
  std::optional<io::TimeUnit> stamp_unit = {};  ///< of tum and openvins; euroc counts nanoseconds
  trajectory::Duplicates duplicates = trajectory::Duplicates::rare_last;
};

/// Reads a trajectory. Without a format, the first row's columns tell it; what cannot be read twice (a pipe)
/// is taken for TUM text in seconds. Stamps that can only be milli-, micro- or nanoseconds since 1970 (the
/// first one is above 1e11, 1e14 or 1e17) are read as such, with a warning. Rotations are made unit and
/// orthonormal; warnings say how far off they were, and what ordered() did.
///
/// Errors name file:line: data_missing; data_corrupt for a row that is no pose, a matrix that is no rotation
/// to a hundredth, a row of euroc without commas, those of ordered(), columns that fit no format, or
/// (openvins) time that does not increase or a variance below zero.
[[nodiscard]] Result<LoadedTrajectory> load_trajectory(const std::filesystem::path& file,
                                                       const TrajectoryReading& reading,
                                                       std::vector<std::string>& warnings);

}  // namespace fusebench::trajectory_files
