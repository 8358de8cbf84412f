// A task of a Slurm array: the files that tell it its runs, and what a node does with them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/suites/engine/engine_options.hpp"
#include "eval/suites/engine/job_plan.hpp"

namespace fusebench::engine {

/// How tasks find their work: kept beside the runs, see Invocation.
struct SlurmSite {
  std::filesystem::path invocation;  ///< its file
  std::filesystem::path program;     ///< on the shared file system, or installed on every node
};

/// In the folder of an array.
inline constexpr const char* kTaskScript = "task.sh";  ///< what a node runs
inline constexpr const char* kTaskLogs = "logs";       ///< what the tasks print
/// The file that a running task changes every second.
[[nodiscard]] std::filesystem::path sign_of_life(const std::filesystem::path& folder, std::size_t task);

/// Writes the array's folder: the task file with the numbers of each task's jobs in the plan, a line a task,
/// and the script. Error io.
[[nodiscard]] Result<void> write_task_files(const std::filesystem::path& folder,
                                            std::span<const BatchJob> jobs,
                                            std::span<const std::vector<std::size_t>> tasks,
                                            const SlurmSite& site, int at_once);

/// The content of a file, empty if it is not there or cannot be read.
[[nodiscard]] std::string text_if_there(const std::filesystem::path& file);

/// In a task: runs the jobs of one line of the task file, and writes heartbeats beside it. Errors:
/// data_missing, data_corrupt (the task file); those of run_locally().
[[nodiscard]] Result<void> run_slurm_task(std::span<const BatchJob> jobs, const EngineOptions& options,
                                          const std::filesystem::path& task_file, std::size_t task,
                                          const EngineControl& control = {});

}  // namespace fusebench::engine
