// Evaluates the output of other systems as runs: output that is imported, and external programs that are run.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "datasets/open_recording.hpp"
#include "eval/record/external/system_trajectory.hpp"
#include "eval/record/record.hpp"
#include "eval/run/run_control.hpp"
#include "eval/run/run_placement.hpp"

namespace fusebench::run {

struct ImportSpec {
  std::string name;                       ///< of the other system: the run's variant
  external::SystemTrajectory trajectory;  ///< its poses of the colour camera
  std::filesystem::path mesh;             ///< PLY or OBJ, in the frame of these poses; may be empty
  double mesh_unit_m = 1;
  std::filesystem::path recording;
  datasets::OpenOptions open;
  std::optional<FrameWindow> frames;
  std::string imu = "not said";  ///< the IMU that it used: "none", "recorded" or "synthetic IMU"
  int threads = 1;
  std::filesystem::path out;
};

struct ImportedRun {
  record::RunRecord record;
  std::filesystem::path folder;       ///< <out>/<recording>/<name>/<hash8 of the files and the recording>
  std::vector<std::string> warnings;  ///< of reading the trajectory
};

/// Evaluates it as a run of this program, and writes record.json, trajectory.tum, truth.tum, mesh.ply and
/// log.txt. A pose belongs to the frame whose stamp is nearest, within 0.02 s; a frame without one counts as
/// lost. Poses without stamps (KITTI) must be as many as the frames.
///
/// Errors: usage for a name that is a variant of this program or not the name of a folder, or under
/// which other files are imported for the same frames, IMU and kind of poses; those of open_recording,
/// external::read_system_trajectory() and read_foreign_mesh(); io.
[[nodiscard]] Result<ImportedRun> import_run(const ImportSpec& spec);

/// Exports the recording, runs the program, and evaluates its output as an imported run; the
/// folder gets record.json, trajectory.tum, truth.tum, mesh.ply and log.txt. A
/// program that crashes, hangs or writes unusable output gives a record with status failed and the reason.
/// Errors: as execute_run().
[[nodiscard]] Result<record::RunRecord> execute_program_run(const PreparedRun& run,
                                                            const RunControl& control);

}  // namespace fusebench::run
