// One run of an external program over one recording: export, command, and what it left.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "datasets/recording/recording.hpp"
#include "eval/record/external/external_program.hpp"
#include "eval/record/external/frame_poses.hpp"
#include "eval/record/process/program_run.hpp"

namespace fusebench::external {

struct ProgramResults {
  std::string reason;  ///< why there are none; empty if there are
  FramePoses frames;
  Mesh mesh;                       ///< empty if it has none
  process::ProgramEnd end;         ///< what it cost, and the end of what it printed
  std::vector<std::string> notes;  ///< of the export and of reading what it left
};

/// Where a run of a program is.
struct ProgramPlace {
  std::filesystem::path recording_folder;  ///< for programs that read the recording itself
  std::filesystem::path work_folder;       ///< exists, empty; the export and the output go there
  int threads = 1;
  int seed = 1;
};

/// What the program does wrong (it dies, hangs, leaves no trajectory, half a one, or one that cannot be read
/// or is of another scale than the ground truth) is a reason in the results that names the file and line.
/// Errors: those of the export, io, and run_failed if it was stopped.
[[nodiscard]] Result<ProgramResults> run_external_program(const ExternalProgram& program,
                                                          const recording::Recording& recording,
                                                          const ProgramPlace& place,
                                                          const std::function<bool()>& go_on);

}  // namespace fusebench::external
