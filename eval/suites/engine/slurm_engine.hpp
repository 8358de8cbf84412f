// The runs of a plan on a Slurm cluster. A folder that all nodes share is all it needs: the results in it are
// the record, and the queue is asked only why one is missing.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/suites/engine/engine_options.hpp"
#include "eval/suites/engine/job_plan.hpp"
#include "eval/suites/engine/slurm_task.hpp"

namespace fusebench::engine {

struct SlurmOptions {
  std::size_t chunk = 0;               ///< runs of one task; 0: as many as take about a minute
  int at_once = 1;                     ///< runs at a time within a task
  int cpus = 1;                        ///< of each task
  double silence_s = 60;               ///< a running task that gives no sign for so long is given up
  double command_limit_s = 15;         ///< for an answer of Slurm
  std::vector<std::string> arguments;  ///< for sbatch: partition, account, ...
  bool submit_only = false;            ///< returns when everything is submitted
};

/// Before anything is written: errors usage where there is no Slurm, run_failed where no controller answers.
[[nodiscard]] Result<void> check_slurm(const SlurmOptions& slurm);

/// Submits what is not finished as arrays of tasks, follows the results, and submits again what a node that
/// died or was cut off, or a controller that forgot, took with it (three times at most; then the run is a row
/// with that reason). Outcomes as run_locally(); with submit_only, those of what is there already. A stop
/// cancels what is in the queue. Errors: those of run_locally(); usage where there is no Slurm or it refuses
/// the arrays, of which then no files are left.
[[nodiscard]] Result<std::vector<BatchOutcome>> run_on_slurm(std::span<const BatchJob> jobs,
                                                             const EngineOptions& options,
                                                             const SlurmOptions& slurm, const SlurmSite& site,
                                                             const EngineControl& control = {});

}  // namespace fusebench::engine
