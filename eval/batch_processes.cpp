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

/// What the process printed of its run; nothing if it printed something else.
std::optional<BatchOutcome> reported(const BatchJob& job, const std::string& text) {
  using Json = nlohmann::json;
  const Json document = Json::parse(text, nullptr, false);
  const auto runs = document.is_object() ? document.find("runs") : document.end();
  if (document.is_discarded() || runs == document.end() || !runs->is_array() || runs->size() != 1)
    return std::nullopt;
  try {
    const Json& run = runs->front();
    BatchOutcome outcome;
    outcome.recording = job.recording.filename().string();
    outcome.variant = job.variant;
    outcome.group = job.group;
    outcome.half = job.half;
    outcome.reason = run.at("reason").get<std::string>();
    outcome.resumed = run.at("resumed").get<bool>();
    outcome.skipped = run.at("skipped").get<bool>();
    outcome.folder = run.at("folder").get<std::string>();
    return outcome;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

BatchOutcome outcome_of(const BatchJob& job, const ChildEnd& end) {
  auto outcome = reported(job, end.output);
  if (!outcome) {
    const std::string why = error_line(end.errors);
    return not_started(
        job, fmt::format("the run's process ended with {}{}{}", end.how(), why.empty() ? "" : ": ", why));
  }
  if (outcome->folder.empty()) return std::move(*outcome);
  auto record = read_record(outcome->folder / "record.json");
  if (!record) {
    // A run that ended by an error of its own, such as a full disk, leaves no record.
    if (outcome->reason.empty()) outcome->reason = record.error().message;
    return std::move(*outcome);
  }
  outcome->record = std::move(*record);
  outcome->status = outcome->record.status;
  outcome->reason = outcome->record.reason;
  return std::move(*outcome);
}

}  // namespace

Result<std::vector<BatchOutcome>> run_batch_in_processes(const std::vector<BatchJob>& jobs, int at_once,
                                                         const JobCommand& command,
                                                         const ProcessControl& control) {
  check(at_once >= 1, "at least one process at a time");
  std::vector<BatchOutcome> outcomes(jobs.size());
  std::vector<RunningJob> running;
  for (std::size_t next = 0; next < jobs.size() || !running.empty();) {
    // Leaving asks the processes to stop and waits for them.
    if (control.stop != nullptr && control.stop->load())
      return fail(ErrorCode::run_failed, "stopped by the user");
    while (next < jobs.size() && running.size() < static_cast<std::size_t>(at_once)) {
      auto process = ChildProcess::start(command(next));
      if (!process) return tl::unexpected(process.error());
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
