// A program of somebody else's, run to its end within limits.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/base/error.hpp"

namespace fusebench::process {

/// 0: no limit.
struct ProgramLimits {
  double time_s = 0;               ///< from start to end
  std::uint64_t memory_bytes = 0;  ///< of the data of each of its processes
};

struct ProgramEnd {
  bool succeeded = false;  ///< exit code 0
  std::string how;         ///< "exit code 3", "signal 9 (Killed)", "killed after 60 s"
  std::string output;      ///< the end of what it printed, standard error and output together
  double cpu_s = 0;        ///< user and system, of it and of the children that it waited for
  double wall_s = 0;
  std::uint64_t peak_rss_bytes = 0;  ///< of its largest process
};

/// Runs command[0] (looked for in PATH) in a process group of its own, which is killed at a limit, when
/// `go_on` (asked ten times a second) says no, and in any case when the program has ended: nothing of it
/// stays. The program dies with this process. Errors: run_failed if it cannot be started, or was stopped by
/// `go_on`; io.
[[nodiscard]] Result<ProgramEnd> run_program(const std::vector<std::string>& command,
                                             const std::filesystem::path& working_folder,
                                             const ProgramLimits& limits, const std::function<bool()>& go_on);

}  // namespace fusebench::process
