// How the run of a job ended, and how an end without results is kept for tables.
#pragma once

#include <filesystem>
#include <string>

#include "core/base/error.hpp"
#include "eval/record/process/forked_job.hpp"
#include "eval/record/record.hpp"
#include "eval/run/run.hpp"
#include "eval/suites/engine/job_plan.hpp"

namespace fusebench::engine {

struct BatchOutcome {
  std::string recording;
  std::string variant;
  std::string group;
  std::string split;
  record::RunStatus status = record::RunStatus::failed;
  std::string reason;
  bool resumed = false;  ///< was there already
  bool skipped = false;  ///< an optional job whose recording nothing here can open; not a failure, and no row
  std::filesystem::path folder;  ///< empty if nothing is there
};

/// The outcome of a job that has none yet: failed, with a reason.
[[nodiscard]] BatchOutcome outcome_without_results(const BatchJob& job, std::string reason);

/// A job whose recording could not even be opened: a record under
/// <out>/<recording>/<variant>/not-started-<hash8 of the configuration>/, so that tables show it. Error io.
[[nodiscard]] Result<BatchOutcome> record_not_started(const BatchJob& job, std::string reason);
[[nodiscard]] bool was_not_started(const BatchJob& job);  ///< there is such a record
/// Takes that record away, if there is one: the job has started.
void forget_not_started(const BatchJob& job);

/// Whether the run is there, ok or lost and whole, with the files that are to be kept of it, and with its
/// profile if one is requested.
[[nodiscard]] bool is_finished(const run::PreparedRun& run, const run::RecordHead& head);

/// A run whose process left no results: a record in the run's place that says why, with what the process
/// cost, and a log that ends with what it printed. A finished run of an earlier time that is there stays.
/// Error io.
[[nodiscard]] Result<BatchOutcome> record_failed(const BatchJob& job, const run::PreparedRun& run,
                                                 const process::JobEnd& end);

/// The outcome of a run that is there.
[[nodiscard]] BatchOutcome outcome_of_finished(const BatchJob& job, const std::filesystem::path& folder,
                                               const run::RecordHead& head);

}  // namespace fusebench::engine
