// A system that is another program: what it is given, how it is called, and where its results are. One TOML
// file each (configs/systems).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "datasets/recording/exports/export_recording.hpp"
#include "eval/record/external/system_trajectory.hpp"
#include "eval/record/process/program_run.hpp"

namespace fusebench::external {

/// Where it leaves its mesh or cloud of points, below {output}; empty: it has none.
struct ProgramMesh {
  std::string file;
  double unit_m = 1;
};

///     name = "open3d"            # the row in tables; letters, digits, '-', '_', '+' and '.'
///     sentence = "what it is"
///     export = "open3d"          # format of what it reads (docs/exports.md); "none": the recording itself
///     command = ["python3", "{folder}/run.py", "{recording}", "{output}"]
///     version = ["program", "--version"]   # its first line is recorded; fails where it is not installed
///     imu = "none"               # or "recorded": what it uses
///     deterministic = false      # then the same recording gives the same results
///     repetitions = 5            # of each run; at least 5 for what is not deterministic
///     [limits]
///     time_s = 3600
///     memory_mb = 8000
///     [trajectory]
///     file = "trajectory.txt"
///     format = "tum"             # tum, kitti, euroc, openvins or log; recognised if missing, as NAME.sens
///     is unit = "m"                 # or "mm" pose = "camera_to_world"   # or "world_to_camera" online =
///     false [mesh]                     # may be missing file = "mesh.ply" unit = "m"
///
/// In arguments of the command {recording} is the export (or the recording), {calibration} the file of it
/// that holds the camera, {output} a new folder, {threads} and {seed} numbers, {folder} that of the TOML
/// file. The working folder is {output}.
struct ExternalProgram {
  std::string name;
  std::string sentence;
  std::optional<exports::ExportFormat> input;  ///< nothing: the recording itself
  std::vector<std::string> command;
  std::string imu = "none";
  bool deterministic = false;
  int repetitions = 1;
  process::ProgramLimits limits{3600, 0};
  SystemTrajectory trajectory;
  ProgramMesh mesh;
  std::filesystem::path file;  ///< that all of this is from; absolute
  std::string definition;      ///< its text
  std::vector<std::string> version_command;
  // What find_installed() finds:
  std::string version;  ///< what it says of itself; empty if it cannot be asked
  std::string absent;   ///< why it cannot run here; empty if it can
  /// 32 hex digits of the definition, of the files of the program (files_of_command()) and of its version.
  std::string identity;

  [[nodiscard]] std::filesystem::path folder() const { return file.parent_path(); }
};

/// The definition; starts nothing. Errors name file:line: data_missing; configuration (unknown or missing
/// keys, wrong types or values, a name that is a variant of this program, {placeholders} that there are not).
[[nodiscard]] Result<ExternalProgram> read_external_program(const std::filesystem::path& file);

/// Looks for the program of a definition on this machine and asks it for its version. Errors: of reading
/// the files that it consists of.
[[nodiscard]] Result<void> find_installed(ExternalProgram& program);

}  // namespace fusebench::external
