#include "eval/suites/engine/local_engine.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <iterator>
#include <list>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/io/abandoned.hpp"
#include "eval/record/process/forked_job.hpp"
#include "eval/record/process/machine_memory.hpp"
#include "eval/suites/engine/batch_ledger.hpp"
#include "eval/suites/engine/run_claim.hpp"

namespace fusebench::engine {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLookAround(100);
constexpr std::chrono::milliseconds kWaitForOthers(500);
constexpr std::chrono::milliseconds kGrace(500);  // for runs that are asked to stop

struct RunningJob {
  RunningJob(std::size_t of, run::PreparedRun prepared, std::optional<RunClaim> held,
             process::ForkedJob forked)
      : index(of), run(std::move(prepared)), claim(std::move(held)), process(std::move(forked)) {}
  std::size_t index;
  run::PreparedRun run;
  std::optional<RunClaim> claim;
  process::ForkedJob process;
};

class Engine {
 public:
  Engine(std::span<const BatchJob> jobs, const EngineOptions& options, const EngineControl& control)
      : jobs_(jobs), options_(options), control_(control), ledger_(jobs, options, control) {
    for (std::size_t i = 0; i < jobs.size(); ++i) waiting_.push_back(i);
  }

  [[nodiscard]] Result<std::vector<BatchOutcome>> run() {
    if (!jobs_.empty()) remove_free_claims(jobs_.front().spec.out);
    while (!waiting_.empty() || !running_.empty()) {
      if (ledger_.is_stopped()) return stop_all();
      if (!fatal_ && has_room() && Clock::now() >= next_try_) {
        const bool started = start_next();
        if (started && has_room()) continue;
        if (!started) next_try_ = Clock::now() + kWaitForOthers;
      }
      if (fatal_ && running_.empty()) return tl::unexpected(ledger_.given_up(*fatal_));
      listen();
      take_ended();
      tell_progress();
    }
    if (fatal_) return tl::unexpected(ledger_.given_up(*fatal_));
    return ledger_.take_outcomes();
  }

 private:
  [[nodiscard]] bool has_room() const {
    if (waiting_.empty() || running_.size() >= static_cast<std::size_t>(options_.at_once)) return false;
    if (running_.empty()) return true;
    // What running jobs will still grow to is not to be had.
    std::uint64_t promised = expected_bytes_;
    for (const RunningJob& job : running_) {
      const std::uint64_t resident = job.process.resident_bytes();
      promised += expected_bytes_ > resident ? expected_bytes_ - resident : 0;
    }
    return promised < process::available_memory_bytes();
  }

  /// False if no job that waits can be started now: another engine has them.
  bool start_next() {
    for (std::size_t tries = waiting_.size(); tries > 0 && !fatal_; --tries) {
      const std::size_t index = waiting_.front();
      waiting_.pop_front();
      if (!start(index)) {
        waiting_.push_back(index);  // somebody else is at it: we look again later
        continue;
      }
      return true;
    }
    return false;
  }

  /// False if another engine is at it.
  bool start(std::size_t index) {
    const BatchJob& job = jobs_[index];
    auto unfinished = ledger_.unfinished_run(index);
    if (!unfinished) fatal_ = unfinished.error();
    if (!unfinished || !*unfinished) return true;
    run::PreparedRun run = std::move(**unfinished);
    auto claim = RunClaim::take(job.spec.out, claim_name(run.run_id, run.spec.repetition));
    if (!claim) {
      fatal_ = claim.error();
      return true;
    }
    if (!*claim) return false;
    if (ledger_.end_if_finished(index, run)) return true;  // by whoever had the claim just now
    prepare_place(job, run);
    auto process = process::ForkedJob::start(
        [&](const process::JobReporter& reporter) { work(run, reporter); },
        {options_.limits.time_s, options_.limits.stall_s, options_.limits.memory_bytes}, run.folder);
    if (!process) {
      fatal_ = process.error();
      return true;
    }
    running_.emplace_back(index, std::move(run), std::move(*claim), std::move(*process));
    return true;
  }

  /// In the child.
  void work(const run::PreparedRun& run, const process::JobReporter& reporter) const {
    const auto record = run::execute_run(
        run, {[&](std::size_t frame, std::size_t total) { reporter.progress(frame, total); }, control_.stop});
    if (record) {
      reporter.finished(record::to_string(record->status));
    } else {
      reporter.failed(record.error());
    }
  }

  void prepare_place(const BatchJob& job, const run::PreparedRun& run) {
    forget_not_started(job);
    // Once a folder: it may hold thousands of runs.
    if (tidied_.insert(run.folder.parent_path()).second) io::remove_abandoned(run.folder.parent_path());
  }

  /// Until a job has written something, or it is time to look at clocks and at Ctrl-C.
  void listen() const {
    std::vector<pollfd> descriptors;
    for (const RunningJob& job : running_) descriptors.push_back({job.process.descriptor(), POLLIN, 0});
    ::poll(descriptors.data(), descriptors.size(), static_cast<int>(kLookAround.count()));
  }

  void take_ended() {
    for (auto job = running_.begin(); job != running_.end();) {
      const auto end = job->process.poll();
      if (end) {
        expected_bytes_ = std::max(expected_bytes_, end->peak_rss_bytes);
        take_end(*job, *end);
      }
      job = end ? running_.erase(job) : std::next(job);
    }
  }

  void take_end(const RunningJob& job, const process::JobEnd& end) {
    // A run that cannot write its results says nothing of itself, but of the disk.
    const bool disk = end.error && end.error->code == ErrorCode::io;
    if (disk && !fatal_) fatal_ = end.error;
    if (disk || (ledger_.is_stopped() && !end.finished)) return;
    if (end.finished) {
      const auto head = run::record_head(job.run.folder);
      if (head && head->run_id == job.run.run_id) {
        ledger_.end_with_record(job.index, job.run.folder, *head);
        return;
      }
    }
    const auto ended = ledger_.end_failed(job.index, job.run, end);
    if (!ended && !fatal_) fatal_ = ended.error();
  }

  void tell_progress() {
    std::vector<std::string> running;
    double share_running = 0;
    for (const RunningJob& job : running_) {
      const std::size_t total = job.process.total();
      if (total > 0) share_running += static_cast<double>(job.process.done()) / static_cast<double>(total);
      running.push_back(fmt::format("{} {}/{}", to_string(jobs_[job.index]), job.process.done(), total));
    }
    ledger_.report(std::move(running), share_running);
  }

  /// All are asked at once, so that it takes no longer than the slowest.
  Result<std::vector<BatchOutcome>> stop_all() {
    std::set<fs::path> places;
    for (const RunningJob& job : running_) places.insert(job.run.folder.parent_path());
    for (RunningJob& job : running_) job.process.interrupt();
    const auto until = Clock::now() + kGrace;
    while (!running_.empty() && Clock::now() < until) {
      listen();
      take_ended();
    }
    running_.clear();  // kills what would not stop
    for (const fs::path& place : places) {
      // Those that several runs were about to use, none of them could remove.
      std::error_code ignored;
      fs::remove(place, ignored);
      fs::remove(place.parent_path(), ignored);
    }
    return tl::unexpected(ledger_.stopped_by_user());
  }

  std::span<const BatchJob> jobs_;
  EngineOptions options_;
  const EngineControl& control_;
  BatchLedger ledger_;
  std::deque<std::size_t> waiting_;
  std::list<RunningJob> running_;
  std::set<fs::path> tidied_;
  std::optional<Error> fatal_;
  std::uint64_t expected_bytes_ = 300'000'000;  // of a run, until one has ended that needed more
  Clock::time_point next_try_ = Clock::now();
};

}  // namespace

Result<std::vector<BatchOutcome>> run_locally(std::span<const BatchJob> jobs, const EngineOptions& options,
                                              const EngineControl& control) {
  check(options.at_once >= 1, "at least one process at a time");
  return Engine(jobs, options, control).run();
}

}  // namespace fusebench::engine
