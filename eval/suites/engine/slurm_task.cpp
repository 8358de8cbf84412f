#include "eval/suites/engine/slurm_task.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <sstream>
#include <system_error>
#include <thread>
#include <utility>

#include "core/base/io/bounded_text.hpp"
#include "core/base/io/fingerprint.hpp"
#include "core/config/config_access.hpp"
#include "eval/record/build_info.hpp"
#include "eval/record/process/forked_job.hpp"
#include "eval/record/process_meter.hpp"
#include "eval/suites/engine/local_engine.hpp"
#include "eval/text/text_file.hpp"

namespace fusebench::engine {

namespace {

namespace fs = std::filesystem;

constexpr const char* kTaskFile = "tasks.txt";

/// Numbers of jobs mean the same to whoever has this one.
std::string plan_digest(std::span<const BatchJob> jobs) {
  io::Fingerprint digest;
  digest.add(record::build_info().estimator);
  for (const BatchJob& job : jobs) {
    digest.add(to_string(job));
    digest.add(config::config_hash(job.spec.config.values()));
  }
  return digest.hex();
}

std::string quoted(const fs::path& path) {
  std::string text = "'";
  for (const char c : path.string()) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// The jobs of one line of the task file.
Result<std::vector<BatchJob>> jobs_of_task(std::span<const BatchJob> jobs, const fs::path& task_file,
                                           std::size_t task) {
  std::istringstream lines(text_if_there(task_file));
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
  return mine;
}

}  // namespace

std::string text_if_there(const fs::path& file) {
  return io::whole_text(file, std::uintmax_t{1} << 28, "file of tasks").value_or("");
}

fs::path sign_of_life(const fs::path& folder, std::size_t task) {
  return folder / fmt::format("alive-{}", task);
}

Result<void> write_task_files(const fs::path& folder, std::span<const BatchJob> jobs,
                              std::span<const std::vector<std::size_t>> tasks, const SlurmSite& site,
                              int at_once) {
  std::string lines = plan_digest(jobs) + "\n";
  for (const std::vector<std::size_t>& numbers : tasks) lines += fmt::format("{}\n", fmt::join(numbers, " "));
  const std::string script =
      fmt::format("#!/bin/sh\nexec {} slurm-task {} {} \"$SLURM_ARRAY_TASK_ID\" -j {}\n",
                  quoted(site.program), quoted(site.invocation), quoted(folder / kTaskFile), at_once);
  std::error_code ignored;  // a folder that is not there is an error of its files
  fs::create_directories(folder / kTaskLogs, ignored);
  for (const auto& [name, text] : {std::pair(kTaskFile, lines), std::pair(kTaskScript, script)}) {
    if (auto written = text::write_text_file(folder / name, text); !written) return written;
  }
  return {};
}

Result<void> run_slurm_task(std::span<const BatchJob> jobs, const EngineOptions& options,
                            const fs::path& task_file, std::size_t task, const EngineControl& control) {
  const auto mine = jobs_of_task(jobs, task_file, task);
  if (!mine) return tl::unexpected(mine.error());
  // In a process of its own: opening a large recording takes longer than a heartbeat may.
  const fs::path alive = sign_of_life(task_file.parent_path(), task);
  const auto pulse = process::ForkedJob::start(
      [&](const process::JobReporter&) {
        for (std::size_t count = 0;; ++count) {
          static_cast<void>(text::write_text_file(alive, fmt::format("{} {}\n", record::host_name(), count)));
          std::this_thread::sleep_for(std::chrono::seconds(1));
        }
      },
      {});
  if (!pulse) return tl::unexpected(pulse.error());
  const auto outcomes = run_locally(*mine, options, control);
  if (!outcomes) return tl::unexpected(outcomes.error());
  return {};
}

}  // namespace fusebench::engine
