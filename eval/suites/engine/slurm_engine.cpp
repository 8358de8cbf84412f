#include "eval/suites/engine/slurm_engine.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <optional>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

#include "eval/record/process/forked_job.hpp"
#include "eval/record/process_meter.hpp"
#include "eval/suites/engine/batch_ledger.hpp"
#include "eval/suites/engine/plan_preview.hpp"
#include "eval/suites/engine/run_claim.hpp"
#include "eval/suites/engine/slurm_commands.hpp"

namespace fusebench::engine {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kMostAttempts = 3;
constexpr std::size_t kMostTasks = 1000;  // of an array: Slurm's default limit
constexpr double kQueueEvery_s = 2;
constexpr double kVanished_s = 6;  // out of the queue, and results that a network file system shows late
constexpr double kLongestLook_s = 5;
constexpr std::chrono::milliseconds kQueueInterval(200);

double since(Clock::time_point time) { return std::chrono::duration<double>(Clock::now() - time).count(); }

/// A run, as far as its results tell.
struct Awaited {
  fs::path folder;
  std::string run_id;
  std::size_t frames = 0;
  /// Of a record of an earlier time that is made again: it failed, or lacks files that are requested.
  std::optional<fs::file_time_type> written_before;
  int attempts = 0;
};

/// Some runs in one task of an array.
struct Chunk {
  std::vector<std::size_t> jobs;  ///< those that are missing
  std::string task;               ///< "job_task" in the queue
  fs::path alive;                 ///< its heartbeats
  std::string last_sign;
  Clock::time_point last_change = Clock::now();
  std::optional<Clock::time_point> unseen_since;  ///< in answers of the queue
  std::string node;
};

class SlurmEngine {
 public:
  SlurmEngine(std::span<const BatchJob> jobs, const EngineOptions& options, const SlurmOptions& slurm,
              const SlurmSite& site, const EngineControl& control)
      : jobs_(jobs),
        options_(options),
        slurm_(slurm),
        site_(site),
        ledger_(jobs, options, control),
        queue_(slurm.command_limit_s) {
    name_ = fmt::format("fusebench-{}-{}-{}", site.invocation.stem().string(), record::host_name(), getpid());
    folder_ = fs::absolute(engine_folder(jobs.front().spec.out) / "slurm" / name_);
  }

  Result<std::vector<BatchOutcome>> run() {
    auto missing = what_is_missing();
    if (!missing) return tl::unexpected(missing.error());
    if (missing->empty()) return ledger_.take_outcomes();
    if (auto submitted = submit(chunks_of(*missing)); !submitted) {
      std::error_code ignored;
      fs::remove_all(folder_, ignored);
      fs::remove(folder_.parent_path(), ignored);  // if it holds nothing else
      return tl::unexpected(submitted.error());
    }
    if (slurm_.submit_only) return ledger_.take_outcomes();
    while (!chunks_.empty() || !to_submit_.empty()) {
      if (ledger_.is_stopped()) {
        queue_.cancel_all(name_);
        return tl::unexpected(ledger_.stopped_by_user());
      }
      look_at_results();
      if (since(last_queue_) > kQueueEvery_s) {
        look_at_queue();
        if (auto again = submit_again(); !again) return tl::unexpected(again.error());
        last_queue_ = Clock::now();
      }
      tell_progress();
      std::this_thread::sleep_for(kQueueInterval);
    }
    queue_.cancel_all(name_);  // what still runs was done by others
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
    return ledger_.take_outcomes();
  }

 private:
  /// The jobs that are to be run; the others have ended.
  Result<std::vector<std::size_t>> what_is_missing() {
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < jobs_.size(); ++i) {
      const auto run = ledger_.unfinished_run(i);
      if (!run) return tl::unexpected(run.error());
      if (!*run) continue;
      Awaited awaited{(*run)->folder, (*run)->run_id, (*run)->recording.frames.size(), {}, 0};
      std::error_code no_record;
      const auto written = fs::last_write_time(awaited.folder / "record.json", no_record);
      if (!no_record) awaited.written_before = written;
      // A task of an earlier array may have written it since we looked.
      if (ledger_.end_if_finished(i, **run)) continue;
      awaited_.emplace(i, std::move(awaited));
      missing.push_back(i);
    }
    return missing;
  }

  [[nodiscard]] std::vector<Chunk> chunks_of(const std::vector<std::size_t>& missing) const {
    constexpr double kTarget_s = 60;
    constexpr std::size_t kFewest = 8;  // chunks, so that several nodes have something to do
    std::size_t size = slurm_.chunk;
    if (size == 0) {
      double work_s = 0;
      for (const std::size_t index : missing)
        work_s += kGuessPerFrame_s * static_cast<double>(awaited_.at(index).frames);
      const double runs = static_cast<double>(missing.size());
      size = static_cast<std::size_t>(std::clamp(kTarget_s * runs / std::max(work_s, 1e-3), 1.0, 100.0));
      size = std::clamp<std::size_t>(missing.size() / kFewest, 1, size);
    }
    std::vector<Chunk> chunks;
    for (std::size_t begin = 0; begin < missing.size(); begin += size) {
      Chunk chunk;
      const auto from = missing.begin() + static_cast<std::ptrdiff_t>(begin);
      chunk.jobs.assign(from, from + static_cast<std::ptrdiff_t>(std::min(size, missing.size() - begin)));
      chunks.push_back(std::move(chunk));
    }
    return chunks;
  }

  Result<void> submit(std::vector<Chunk> chunks) {
    for (std::size_t begin = 0; begin < chunks.size(); begin += kMostTasks) {
      const std::size_t count = std::min(kMostTasks, chunks.size() - begin);
      if (auto done = submit_array(std::span(chunks).subspan(begin, count)); !done) return done;
    }
    return {};
  }

  Result<void> submit_array(std::span<Chunk> chunks) {
    const fs::path part = folder_ / fmt::format("{}", arrays_++);
    std::vector<std::vector<std::size_t>> tasks;
    for (const Chunk& chunk : chunks) tasks.push_back(chunk.jobs);
    if (auto written = write_task_files(part, jobs_, tasks, site_, slurm_.at_once); !written) return written;
    std::size_t largest = 0;
    for (const Chunk& chunk : chunks) largest = std::max(largest, chunk.jobs.size());
    // A run that takes too long is ended by its own limit, and says so; Slurm's is for what hangs beyond
    // that.
    constexpr double kMargin_s = 900;
    const double limit_s = options_.limits.time_s * static_cast<double>(largest);
    const double time_s = limit_s > 0 ? 1.1 * limit_s + kMargin_s : 0;
    const auto job = queue_.submit({name_,
                                    part / kTaskScript,
                                    part / kTaskLogs,
                                    chunks.size(),
                                    slurm_.cpus,
                                    time_s,
                                    {excluded_.begin(), excluded_.end()},
                                    slurm_.arguments});
    // A controller that is silent from the start is the user's to look at; later it is waited for.
    const bool must_be_known = arrays_ == 1 || slurm_.submit_only;
    if (!job && (must_be_known || job.error().code == ErrorCode::usage)) {
      queue_.cancel_all(name_);
      return tl::unexpected(job.error());
    }
    for (std::size_t task = 0; task < chunks.size(); ++task) {
      Chunk& chunk = chunks[task];
      // Where nobody answered the array may be in the queue or not: it counts as vanished if nothing comes.
      chunk.task = job ? fmt::format("{}_{}", *job, task) : "";
      chunk.alive = sign_of_life(part, task);
      if (job) {
        for (const std::size_t index : chunk.jobs) ++awaited_.at(index).attempts;
      }
      chunks_.push_back(std::move(chunk));
    }
    return {};
  }

  /// A record of before does not count.
  [[nodiscard]] std::optional<run::RecordHead> result_of(const Awaited& awaited) const {
    // Listing a folder makes a network file system look again for what was not there the last time.
    std::error_code unlisted;
    static_cast<void>(fs::directory_iterator(awaited.folder.parent_path(), unlisted));
    auto head = run::record_head(awaited.folder);
    // Where a network file system shows the record before the other files, they come a moment later.
    if (!head || head->run_id != awaited.run_id || head->state != run_files::RunState::whole)
      return std::nullopt;
    std::error_code ignored;
    if (awaited.written_before &&
        fs::last_write_time(awaited.folder / "record.json", ignored) == *awaited.written_before)
      return std::nullopt;
    return head;
  }

  void take_results(Chunk& chunk) {
    std::erase_if(chunk.jobs, [&](std::size_t index) {
      const Awaited& awaited = awaited_.at(index);
      const auto head = result_of(awaited);
      if (head) ledger_.end_with_record(index, awaited.folder, *head);
      return head.has_value();
    });
  }

  void look_at_results() {
    // A look at thousands of folders on a network takes its time; the looks stay a tenth of ours.
    if (since(last_look_) < std::min(10 * look_s_, kLongestLook_s)) return;
    const auto start = Clock::now();
    for (Chunk& chunk : chunks_) {
      take_results(chunk);
      std::string sign = text_if_there(chunk.alive);
      if (sign != chunk.last_sign) {
        chunk.last_sign = std::move(sign);
        chunk.last_change = Clock::now();
      }
    }
    std::erase_if(chunks_, [](const Chunk& chunk) { return chunk.jobs.empty(); });
    look_s_ = since(start);
    last_look_ = Clock::now();
  }

  void look_at_queue() {
    const auto tasks = queue_.tasks(name_);
    if (!tasks) return;  // nobody answered: that says nothing, and results come all the same
    std::vector<std::string> stuck;
    for (Chunk& chunk : chunks_) {
      const auto found = tasks->find(chunk.task);
      if (found == tasks->end()) {
        if (!chunk.unseen_since) chunk.unseen_since = Clock::now();
        continue;
      }
      chunk.unseen_since.reset();
      const bool was_running = !chunk.node.empty();
      // Nodes that are being powered up and tasks that are suspended are silent for a reason.
      chunk.node = found->second.state == "RUNNING" ? found->second.node : "";
      if (chunk.node.empty() || !was_running) chunk.last_change = Clock::now();
      if (since(chunk.last_change) < slurm_.silence_s) continue;
      stuck.push_back(chunk.task);
      if (!chunk.node.empty()) excluded_.insert(chunk.node);
      chunk.unseen_since = Clock::now() - std::chrono::hours(1);  // at once
    }
    queue_.cancel(stuck);
    give_up_vanished();
    look_at_nodes();
  }

  /// A result may come a moment after its task has left the queue, on a network file system.
  void give_up_vanished() {
    for (Chunk& chunk : chunks_) {
      if (!chunk.unseen_since || since(*chunk.unseen_since) < kVanished_s) continue;
      take_results(chunk);
      std::vector<std::size_t> again;
      for (const std::size_t index : chunk.jobs) {
        if (awaited_.at(index).attempts < kMostAttempts) {
          again.push_back(index);
        } else {
          give_up(index, chunk);
        }
      }
      chunk.jobs.clear();
      if (!again.empty()) {
        Chunk next;
        next.jobs = std::move(again);
        to_submit_.push_back(std::move(next));
      }
    }
    std::erase_if(chunks_, [](const Chunk& chunk) { return chunk.jobs.empty(); });
  }

  void give_up(std::size_t index, const Chunk& chunk) {
    process::JobEnd none;
    none.reason = fmt::format("its Slurm task ended without a result {} times{}", awaited_.at(index).attempts,
                              chunk.node.empty() ? "" : ", the last time on node " + chunk.node);
    none.output = log_of(chunk);
    const auto run = run::prepare_run(jobs_[index].spec);
    auto outcome =
        run ? record_failed(jobs_[index], *run, none) : record_not_started(jobs_[index], none.reason);
    ledger_.end(index, outcome ? std::move(*outcome) : outcome_without_results(jobs_[index], none.reason));
  }

  [[nodiscard]] static std::string log_of(const Chunk& chunk) {
    return text_if_there(chunk.alive.parent_path() / kTaskLogs / (chunk.task + ".txt"));
  }

  /// Nodes that came back are used again; and if all are excluded, none is, or nothing would ever start.
  void look_at_nodes() {
    if (excluded_.empty()) return;
    const auto nodes = queue_.nodes();
    if (!nodes) return;
    std::erase_if(excluded_, [&](const std::string& name) {
      const auto found = nodes->find(name);
      return found == nodes->end() || found->second == "idle";
    });
    if (excluded_.size() >= nodes->size()) excluded_.clear();
  }

  Result<void> submit_again() {
    if (to_submit_.empty()) return {};
    return submit(std::exchange(to_submit_, {}));
  }

  void tell_progress() {
    std::vector<std::string> running;
    for (const Chunk& chunk : chunks_) {
      if (!chunk.node.empty()) running.push_back(fmt::format("{} on {}", chunk.task, chunk.node));
    }
    ledger_.report(std::move(running), 0);
  }

  std::span<const BatchJob> jobs_;
  EngineOptions options_;
  SlurmOptions slurm_;
  SlurmSite site_;
  BatchLedger ledger_;
  SlurmQueue queue_;
  std::string name_;
  fs::path folder_;  // of task files, scripts, heartbeats and logs
  std::map<std::size_t, Awaited> awaited_;
  std::vector<Chunk> chunks_;     // in the queue
  std::vector<Chunk> to_submit_;  // again
  std::set<std::string> excluded_;
  std::size_t arrays_ = 0;
  double look_s_ = 0;
  Clock::time_point last_look_ = Clock::now() - std::chrono::hours(1);
  Clock::time_point last_queue_ = Clock::now();
};

}  // namespace

Result<void> check_slurm(const SlurmOptions& slurm) { return SlurmQueue(slurm.command_limit_s).check(); }

Result<std::vector<BatchOutcome>> run_on_slurm(std::span<const BatchJob> jobs, const EngineOptions& options,
                                               const SlurmOptions& slurm, const SlurmSite& site,
                                               const EngineControl& control) {
  if (jobs.empty()) return std::vector<BatchOutcome>{};
  return SlurmEngine(jobs, options, slurm, site, control).run();
}

}  // namespace fusebench::engine
