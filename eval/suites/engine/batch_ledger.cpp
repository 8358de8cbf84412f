#include "eval/suites/engine/batch_ledger.hpp"

#include <fmt/format.h>

namespace fusebench::engine {

BatchLedger::BatchLedger(std::span<const BatchJob> jobs, const EngineOptions& options,
                         const EngineControl& control)
    : jobs_(jobs),
      options_(options),
      control_(control),
      outcomes_(jobs.size()),
      opened_(options.limits, control.stop) {
  state_.jobs = jobs.size();
}

bool BatchLedger::is_stopped() const { return control_.stop != nullptr && control_.stop->load(); }

Result<std::optional<run::PreparedRun>> BatchLedger::unfinished_run(std::size_t index) {
  const BatchJob& job = jobs_[index];
  const Result<recording::Recording>& recording = opened_.of(job.spec);
  if (!recording) {
    if (is_stopped()) return std::nullopt;  // it may have been the opening that was
    if (auto ended = end_unopened(index, recording.error()); !ended) return tl::unexpected(ended.error());
    return std::nullopt;
  }
  // Two identities of this plan may begin with the same digits before either has a record.
  run::PreparedRun run = run::place_run(job.spec, *recording, places_);
  places_.emplace(run.folder, run.run_id);
  if (end_if_finished(index, run)) return std::nullopt;
  return run;
}

Result<void> BatchLedger::end_unopened(std::size_t index, const Error& error) {
  const BatchJob& job = jobs_[index];
  if (job.optional && error.code == ErrorCode::configuration) {
    BatchOutcome outcome = outcome_without_results(job, error.message);
    outcome.skipped = true;
    end(index, std::move(outcome));
    return {};
  }
  if (options_.only_failed && !was_not_started(job)) {
    end_not_among_failed(index);
    return {};
  }
  auto outcome = record_not_started(job, error.message);
  if (!outcome) return tl::unexpected(outcome.error());
  end(index, std::move(*outcome));
  return {};
}

bool BatchLedger::end_if_finished(std::size_t index, const run::PreparedRun& run) {
  const BatchJob& job = jobs_[index];
  const auto head = run::record_head(run.folder);
  const bool is_ours = head && head->run_id == run.run_id;
  if (options_.only_failed) {
    const bool is_damaged = head && head->state != run_files::RunState::whole;
    const bool has_failed =
        (is_ours && head->status == record::RunStatus::failed) || is_damaged || was_not_started(job);
    if (!has_failed) {
      end_not_among_failed(index);
      return true;
    }
  }
  if (options_.repeat_finished || !is_ours || !is_finished(run, *head)) return false;
  forget_not_started(job);
  BatchOutcome outcome = outcome_of_finished(job, run.folder, *head);
  outcome.resumed = true;
  end(index, std::move(outcome));
  return true;
}

void BatchLedger::end_not_among_failed(std::size_t index) {
  BatchOutcome outcome = outcome_without_results(jobs_[index], "not among the failed runs");
  outcome.resumed = true;
  outcome.skipped = true;
  end(index, std::move(outcome));
}

void BatchLedger::end_with_record(std::size_t index, const std::filesystem::path& folder,
                                  const run::RecordHead& head) {
  end(index, outcome_of_finished(jobs_[index], folder, head));
}

Result<void> BatchLedger::end_failed(std::size_t index, const run::PreparedRun& run,
                                     const process::JobEnd& end) {
  auto outcome = record_failed(jobs_[index], run, end);
  if (!outcome) return tl::unexpected(outcome.error());
  this->end(index, std::move(*outcome));
  return {};
}

void BatchLedger::end(std::size_t index, BatchOutcome outcome) {
  ++state_.ended;
  if (!outcome.skipped && outcome.status != record::RunStatus::ok) ++state_.failed;
  if (outcome.resumed) ++state_.resumed;
  outcomes_[index] = std::move(outcome);
  if (control_.finished) control_.finished(index, outcomes_[index]);
}

void BatchLedger::report(std::vector<std::string> running, double share_running) {
  if (!control_.progress) return;
  state_.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  state_.running = std::move(running);
  state_.share_running = share_running;
  control_.progress(state_);
}

std::string BatchLedger::finished_and_kept() const {
  return fmt::format("{} of {} runs are finished and kept", state_.ended, jobs_.size());
}

Error BatchLedger::stopped_by_user() const {
  return {ErrorCode::run_failed, fmt::format("stopped by the user; {}", finished_and_kept()),
          "the same command goes on where it ended"};
}

Error BatchLedger::given_up(Error cause) const {
  cause.message += "; " + finished_and_kept();
  cause.hint = "the same command goes on where it ended, once the cause is gone";
  return cause;
}

}  // namespace fusebench::engine
