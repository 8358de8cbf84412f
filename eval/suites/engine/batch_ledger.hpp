// Which jobs of a batch are still to be run, and how the others ended: the same for every engine.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "eval/record/process/forked_job.hpp"
#include "eval/run/run_placement.hpp"
#include "eval/suites/engine/engine_options.hpp"
#include "eval/suites/engine/job_outcome.hpp"
#include "eval/suites/engine/job_plan.hpp"
#include "eval/suites/engine/opened_recordings.hpp"

namespace fusebench::engine {

/// Every job ends once, and its caller is told at once. Jobs are named by their index in the plan.
class BatchLedger {
 public:
  BatchLedger(std::span<const BatchJob> jobs, const EngineOptions& options, const EngineControl& control);

  [[nodiscard]] bool is_stopped() const;  ///< by the caller

  /// The job's run, in its place among the others of the plan. Nothing if the job has ended with that: its
  /// recording cannot be opened, its run is finished, or only failed runs are wanted. Error io.
  [[nodiscard]] Result<std::optional<run::PreparedRun>> unfinished_run(std::size_t index);

  /// Ends the job if its run is finished, or is not to be run. False if it is to be run.
  bool end_if_finished(std::size_t index, const run::PreparedRun& run);

  /// Ends the job with what its run wrote.
  void end_with_record(std::size_t index, const std::filesystem::path& folder, const run::RecordHead& head);

  /// Ends the job with a failed record in the run's place. Error io.
  [[nodiscard]] Result<void> end_failed(std::size_t index, const run::PreparedRun& run,
                                        const process::JobEnd& end);

  void end(std::size_t index, BatchOutcome outcome);

  /// running: a text for each job or task that runs; share_running: the sum of their shares done.
  void report(std::vector<std::string> running, double share_running);

  [[nodiscard]] Error stopped_by_user() const;
  /// The error that keeps the engine from going on, with what is finished.
  [[nodiscard]] Error given_up(Error cause) const;

  /// In the order of the jobs.
  [[nodiscard]] std::vector<BatchOutcome> take_outcomes() { return std::move(outcomes_); }

 private:
  [[nodiscard]] Result<void> end_unopened(std::size_t index, const Error& error);
  void end_not_among_failed(std::size_t index);
  [[nodiscard]] std::string finished_and_kept() const;

  std::span<const BatchJob> jobs_;
  EngineOptions options_;
  const EngineControl& control_;
  std::vector<BatchOutcome> outcomes_;
  OpenedRecordings opened_;
  run::TakenFolders places_;
  EngineState state_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace fusebench::engine
