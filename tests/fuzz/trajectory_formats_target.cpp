// Trajectories of any format: recognised, or named.
#include <cmath>
#include <optional>

#include "eval/metrics/trajectory_files/trajectory_formats.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/properties.hpp"
#include "tests/fuzz/targets.hpp"

namespace fusebench::fuzz {

using namespace trajectory;
using namespace trajectory_files;

namespace {

void check_read(const MemoryFile& file, std::optional<TrajectoryFormat> format, Duplicates duplicates) {
  std::vector<std::string> warnings;
  const auto loaded = load_trajectory(file.path(), {format, {}, duplicates}, warnings);
  if (!loaded) {
    check_error(loaded.error(), file.path());
    return;
  }
  check(!format || loaded->format == *format || loaded->format_source.starts_with("names"),
        "a given format is the one that is read, unless the file names its columns");
  check(!loaded->poses.empty(), "a trajectory has poses");
  const bool with_covariances = loaded->format == TrajectoryFormat::openvins;
  check(loaded->covariances.size() == (with_covariances ? loaded->poses.size() : 0),
        "a covariance belongs to a pose");
  for (std::size_t i = 0; i < loaded->poses.size(); ++i) {
    const StampedPose& pose = loaded->poses[i];
    check(loaded->has_stamps() || loaded->has_numbers() || pose.timestamp_ns == static_cast<std::int64_t>(i),
          "poses without stamps go by their number");
    check(!loaded->has_numbers() || i == 0 || pose.timestamp_ns > loaded->poses[i - 1].timestamp_ns,
          "numbers of frames rise");
    check(pose.T_world_camera.translation.allFinite(), "positions are finite");
    check(std::abs(pose.T_world_camera.rotation.norm() - 1) < 1e-12, "quaternions have unit length");
  }
}

}  // namespace

void trajectory_formats(std::string_view bytes) {
  static const MemoryFile file("trajectory.txt");
  file.write(bytes);
  for (const std::optional<TrajectoryFormat> format :
       {std::optional<TrajectoryFormat>(), std::optional(TrajectoryFormat::tum),
        std::optional(TrajectoryFormat::kitti), std::optional(TrajectoryFormat::euroc),
        std::optional(TrajectoryFormat::log), std::optional(TrajectoryFormat::openvins)}) {
    for (const auto duplicates : {Duplicates::none, Duplicates::rare_last, Duplicates::rare_kept}) {
      check_read(file, format, duplicates);
    }
  }
}

}  // namespace fusebench::fuzz
