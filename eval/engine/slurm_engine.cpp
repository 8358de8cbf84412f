#include "eval/engine/slurm_engine.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <system_error>
#include <thread>
#include <utility>

#include "core/config/config_access.hpp"
#include "core/io/fingerprint.hpp"
#include "eval/engine/opened_recordings.hpp"
#include "eval/engine/plan_preview.hpp"
#include "eval/engine/run_claim.hpp"
#include "eval/engine/slurm_queue.hpp"
#include "eval/process/forked_job.hpp"
#include "eval/record/build_info.hpp"
#include "eval/record/process_meter.hpp"
#include "eval/text/text_file.hpp"

namespace fusebench::engine {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kMostAttempts = 3;
constexpr std::size_t kMostTasks = 1000;  // of an array: Slurm's default limit
constexpr double kQueueEvery_s = 2;
constexpr double kVanished_s = 6;  // out of the queue, and results that a network file system shows late
constexpr double kLongestLook_s = 5;
constexpr std::chrono::milliseconds kLookAround(200);

double since(Clock::time_point time) { return std::chrono::duration<double>(Clock::now() - time).count(); }

/// A run, as far as its results tell.
struct Awaited {
  fs::path folder;
  std::string run_id;
  std::size_t frames = 0;
  /// Of a record of an earlier time that is made again: it failed, or lacks files that are asked for.
  std::optional<fs::file_time_type> written_before;
  int attempts = 0;
};

/// Some runs in one task of an array.
struct Chunk {
  std::vector<std::size_t> jobs;  ///< those that are missing
  std::string task;               ///< "job_task" in the queue
  fs::path alive;                 ///< where it gives signs of life
  std::string last_sign;
  Clock::time_point last_change = Clock::now();
  std::optional<Clock::time_point> unseen_since;  ///< in answers of the queue
  std::string node;
};

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// Numbers of jobs mean the same to whoever has this one.
std::string plan_digest(std::span<const BatchJob> jobs) {
  io::Fingerprint digest;
  digest.add(record::build_info().estimator);
  for (const BatchJob& job : jobs) {
    digest.add(to_string(job));
    digest.add(config::config_hash(job.spec.config.values));
  }
  return digest.hex();
}

std::string quoted(const fs::path& path) {
  std::string text = "'";
  for (const char c : path.string()) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

class SlurmEngine {
 public:
  SlurmEngine(std::span<const BatchJob> jobs, const EngineOptions& options, const SlurmOptions& slurm,
              const SlurmSite& site, const EngineControl& control)
      : jobs_(jobs),
        options_(options),
        slurm_(slurm),
        site_(site),
        control_(control),
        queue_(slurm.command_limit_s),
        outcomes_(jobs.size()) {
    name_ = fmt::format("fusebench-{}-{}-{}", site.invocation.stem().string(), record::host_name(), getpid());
    folder_ = fs::absolute(engine_folder(jobs.front().spec.out) / "slurm" / name_);
  }

  Result<std::vector<BatchOutcome>> run() {
    auto missing = what_is_missing();
    if (!missing) return tl::unexpected(missing.error());
    if (missing->empty()) return std::move(outcomes_);
    if (auto submitted = submit(chunks_of(*missing)); !submitted) return tl::unexpected(submitted.error());
    if (slurm_.submit_only) return std::move(outcomes_);
    while (!chunks_.empty() || !to_submit_.empty()) {
      if (control_.stop != nullptr && control_.stop->load()) return stop();
      look_at_results();
      if (since(last_queue_) > kQueueEvery_s) {
        look_at_queue();
        if (auto again = submit_again(); !again) return tl::unexpected(again.error());
        last_queue_ = Clock::now();
      }
      tell_progress();
      std::this_thread::sleep_for(kLookAround);
    }
    queue_.cancel_all(name_);  // what still runs was done by others
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
    return std::move(outcomes_);
  }

 private:
  void end(std::size_t index, BatchOutcome outcome) {
    ++state_.ended;
    if (!outcome.skipped && outcome.status != record::RunStatus::ok) ++state_.failed;
    if (outcome.resumed) ++state_.resumed;
    outcomes_[index] = std::move(outcome);
    if (control_.finished) control_.finished(index, outcomes_[index]);
  }

  /// Ends what is there, or cannot be opened; the others are awaited.
  Result<std::vector<std::size_t>> what_is_missing() {
    std::vector<std::size_t> missing;
    OpenedRecordings opened;
    for (std::size_t i = 0; i < jobs_.size(); ++i) {
      const auto& recording = opened.of(jobs_[i].spec);
      if (!recording) {
        BatchOutcome skipped = outcome_without_results(jobs_[i], recording.error().message);
        skipped.skipped = jobs_[i].optional && recording.error().code == ErrorCode::configuration;
        auto outcome = skipped.skipped ? Result<BatchOutcome>(std::move(skipped))
                                       : record_not_started(jobs_[i], recording.error().message);
        if (!outcome) return tl::unexpected(outcome.error());
        end(i, std::move(*outcome));
        continue;
      }
      const run::PreparedRun run = run::place_run(jobs_[i].spec, *recording);
      Awaited awaited{run.folder, run.run_id, recording->frames.size(), {}, 0};
      const auto head = run::record_head(awaited.folder);
      const bool ours = head && head->run_id == awaited.run_id;
      if (ours && is_finished(run, *head)) {
        BatchOutcome outcome = outcome_of_finished(jobs_[i], awaited.folder, *head);
        outcome.resumed = true;
        end(i, std::move(outcome));
        continue;
      }
      std::error_code ignored;
      if (ours) awaited.written_before = fs::last_write_time(awaited.folder / "record.json", ignored);
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

  /// The task file has a line a task, the numbers of its jobs in the plan; the script is what a node runs.
  Result<void> submit_array(std::span<Chunk> chunks) {
    const fs::path part = folder_ / fmt::format("{}", arrays_++);
    std::string lines = plan_digest(jobs_) + "\n";
    for (const Chunk& chunk : chunks) lines += fmt::format("{}\n", fmt::join(chunk.jobs, " "));
    const std::string script = fmt::format(
        "#!/bin/sh\nexec {} slurm-task {} {} \"$SLURM_ARRAY_TASK_ID\" -j {}\n", quoted(site_.program),
        quoted(site_.invocation), quoted(part / "tasks.txt"), slurm_.at_once);
    std::error_code error;
    fs::create_directories(part / "logs", error);
    for (const auto& [name, text] : {std::pair("tasks.txt", lines), std::pair("task.sh", script)}) {
      if (auto written = text::write_text_file(part / name, text); !written) return written;
    }
    std::size_t largest = 0;
    for (const Chunk& chunk : chunks) largest = std::max(largest, chunk.jobs.size());
    // A run that takes too long is ended by its own limit, and says so; Slurm's is for what hangs beyond
    // that.
    constexpr double kMargin_s = 900;
    const double limit_s = options_.limits.time_s * static_cast<double>(largest);
    const double time_s = limit_s > 0 ? 1.1 * limit_s + kMargin_s : 0;
    const auto job = queue_.submit({name_,
                                    part / "task.sh",
                                    part / "logs",
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
      chunk.alive = part / fmt::format("alive-{}", task);
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
      if (head) end(index, outcome_of_finished(jobs_[index], awaited.folder, *head));
      return head.has_value();
    });
  }

  void look_at_results() {
    // A look at thousands of folders on a network takes its time; the looks stay a tenth of ours.
    if (since(last_look_) < std::min(10 * look_s_, kLongestLook_s)) return;
    const auto start = Clock::now();
    for (Chunk& chunk : chunks_) {
      take_results(chunk);
      std::string sign = text_of(chunk.alive);
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
    end(index, outcome ? std::move(*outcome) : outcome_without_results(jobs_[index], none.reason));
  }

  [[nodiscard]] static std::string log_of(const Chunk& chunk) {
    return text_of(chunk.alive.parent_path() / "logs" / (chunk.task + ".txt"));
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
    if (!control_.progress) return;
    state_.jobs = jobs_.size();
    state_.elapsed_s = since(start_);
    state_.running.clear();
    for (const Chunk& chunk : chunks_) {
      if (!chunk.node.empty()) state_.running.push_back(fmt::format("{} on {}", chunk.task, chunk.node));
    }
    control_.progress(state_);
  }

  Result<std::vector<BatchOutcome>> stop() {
    queue_.cancel_all(name_);
    return fail(
        ErrorCode::run_failed,
        fmt::format("stopped by the user; {} of {} runs are finished and kept", state_.ended, jobs_.size()),
        "the same command goes on where it ended");
  }

  std::span<const BatchJob> jobs_;
  EngineOptions options_;
  SlurmOptions slurm_;
  SlurmSite site_;
  const EngineControl& control_;
  SlurmQueue queue_;
  std::vector<BatchOutcome> outcomes_;
  std::string name_;
  fs::path folder_;  // of task files, scripts, signs of life and logs
  std::map<std::size_t, Awaited> awaited_;
  std::vector<Chunk> chunks_;     // in the queue
  std::vector<Chunk> to_submit_;  // again
  std::set<std::string> excluded_;
  std::size_t arrays_ = 0;
  double look_s_ = 0;
  Clock::time_point last_look_ = Clock::now() - std::chrono::hours(1);
  Clock::time_point last_queue_ = Clock::now();
  Clock::time_point start_ = Clock::now();
  EngineState state_;
};

}  // namespace

Result<std::vector<BatchOutcome>> run_on_slurm(std::span<const BatchJob> jobs, const EngineOptions& options,
                                               const SlurmOptions& slurm, const SlurmSite& site,
                                               const EngineControl& control) {
  if (jobs.empty()) return std::vector<BatchOutcome>{};
  return SlurmEngine(jobs, options, slurm, site, control).run();
}

Result<void> run_slurm_task(std::span<const BatchJob> jobs, const EngineOptions& options,
                            const fs::path& task_file, std::size_t task, const EngineControl& control) {
  std::istringstream lines(text_of(task_file));
  std::string line;
  std::getline(lines, line);
  if (line != plan_digest(jobs)) {
    return fail(
        ErrorCode::configuration,
        fmt::format("{}: the plan is not the one that was submitted: recordings, suite or program have "
                    "changed since",
                    task_file.string()),
        "submit it again");
  }
  for (std::size_t i = 0; i <= task && std::getline(lines, line); ++i) {
  }
  std::vector<BatchJob> mine;
  std::istringstream numbers(line);
  for (std::size_t number = 0; numbers >> number;) {
    if (number >= jobs.size()) {
      return fail(ErrorCode::data_corrupt,
                  fmt::format("{}: run {} of a plan of {}", task_file.string(), number, jobs.size()),
                  "is this the program that submitted the task?");
    }
    mine.push_back(jobs[number]);
  }
  if (mine.empty())
    return fail(ErrorCode::data_missing, fmt::format("{}: has no task {}", task_file.string(), task));
  // In a process of its own: opening a large recording takes longer than a sign of life may.
  const fs::path alive = task_file.parent_path() / fmt::format("alive-{}", task);
  const auto pulse = process::ForkedJob::start(
      [&](const process::JobVoice&) {
        for (std::size_t count = 0;; ++count) {
          static_cast<void>(text::write_text_file(alive, fmt::format("{} {}\n", record::host_name(), count)));
          std::this_thread::sleep_for(std::chrono::seconds(1));
        }
      },
      {});
  if (!pulse) return tl::unexpected(pulse.error());
  const auto outcomes = run_locally(mine, options, control);
  if (!outcomes) return tl::unexpected(outcomes.error());
  return {};
}

}  // namespace fusebench::engine
