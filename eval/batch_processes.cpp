#include "eval/batch_processes.hpp"

#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "eval/child_processes.hpp"

namespace fusebench {

namespace {

struct RunningJob {
  std::size_t index = 0;
  ChildProcess process;
};

/// The line with which a program says why it ended; empty if it said nothing.
std::string error_line(const std::string& errors) {
  const std::string_view mark = "error: ";
  const std::size_t begin = errors.rfind(mark);
  if (begin == std::string::npos) return "";
  return errors.substr(begin + mark.size(), errors.find('\n', begin) - begin - mark.size());
}

/// What the process printed of its run, without the record; nothing if it printed something else, or ended as
/// none does that did its job.
std::optional<BatchOutcome> reported(const BatchJob& job, const ChildEnd& end) {
  using Json = nlohmann::json;
  if (end.signal != 0) return std::nullopt;
  if (end.exit_code.value_or(0) != 0 && end.exit_code != exit_code(ErrorCode::run_failed))
    return std::nullopt;
  const Json document = Json::parse(end.output, nullptr, false);
  const auto runs = document.is_object() ? document.find("runs") : document.end();
  if (document.is_discarded() || runs == document.end() || !runs->is_array() || runs->size() != 1)
    return std::nullopt;
  try {
    const Json& run = runs->front();
    BatchOutcome outcome = without_results(job, run.at("reason").get<std::string>());
    const auto status = parse_run_status(run.at("status").get<std::string>());
    if (!status) return std::nullopt;
    outcome.status = *status;
    outcome.resumed = run.at("resumed").get<bool>();
    outcome.skipped = run.at("skipped").get<bool>();
    outcome.folder = run.at("folder").get<std::string>();
    return outcome;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

/// Whether a record is the one that the process wrote for this job, and not of an earlier run or another
/// question.
bool belongs(const RunRecord& record, const BatchOutcome& told) {
  return record.recording.name == told.recording && record.variant == told.variant &&
         record.config_hash == told.record.config_hash && record.status == told.status &&
         record.reason == told.reason;
}

BatchOutcome outcome_of(const BatchJob& job, const ChildEnd& end) {
  auto told = reported(job, end);
  if (!told) {
    const std::string why = error_line(end.errors);
    return not_started(
        job, fmt::format("the run's process ended with {}{}{}", end.how(), why.empty() ? "" : ": ", why));
  }
  if (told->folder.empty()) {
    told->status = RunStatus::failed;
    return std::move(*told);
  }
  const std::filesystem::path file = told->folder / "record.json";
  auto record = read_record(file);
  if (!record) return not_started(job, record.error().message);
  if (!belongs(*record, *told)) {
    return not_started(job, fmt::format("{}: is not the record of this run: {}, {}, configuration {}, {}",
                                        file.string(), record->recording.name, record->variant,
                                        record->config_hash, to_string(record->status)));
  }
  told->record = std::move(*record);
  return std::move(*told);
}

/// All of them end at the same time, so that it takes no longer than the slowest; whoever drops them waits.
void interrupt_all(std::vector<RunningJob>& running) {
  for (RunningJob& job : running) job.process.interrupt();
}

}  // namespace

Result<std::vector<BatchOutcome>> run_batch_in_processes(const std::vector<BatchJob>& jobs, int at_once,
                                                         const JobCommand& command,
                                                         const ProcessControl& control) {
  check(at_once >= 1, "at least one process at a time");
  std::vector<BatchOutcome> outcomes(jobs.size());
  std::vector<RunningJob> running;
  for (std::size_t next = 0; next < jobs.size() || !running.empty();) {
    if (control.stop != nullptr && control.stop->load()) {
      interrupt_all(running);
      return fail(ErrorCode::run_failed, "stopped by the user");
    }
    while (next < jobs.size() && running.size() < static_cast<std::size_t>(at_once)) {
      auto process = ChildProcess::start(command(next));
      if (!process) {
        interrupt_all(running);
        return tl::unexpected(process.error());
      }
      running.push_back({next, std::move(*process)});
      ++next;
    }
    std::vector<RunningJob> still;
    for (RunningJob& job : running) {
      const auto end = job.process.poll();
      if (!end) {
        still.push_back(std::move(job));
        continue;
      }
      if (control.stop != nullptr && control.stop->load()) continue;
      outcomes[job.index] = outcome_of(jobs[job.index], *end);
      if (control.finished) control.finished(job.index, outcomes[job.index]);
    }
    running = std::move(still);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return outcomes;
}

}  // namespace fusebench
