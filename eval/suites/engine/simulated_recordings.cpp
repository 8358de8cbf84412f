#include "eval/suites/engine/simulated_recordings.hpp"

#include <fmt/format.h>
#include <poll.h>

#include "eval/record/process/forked_job.hpp"
#include "eval/suites/simulation_request.hpp"

namespace fusebench::engine {

namespace {

constexpr char kBetweenLines = '\x1f';

/// The first job of each recording that is simulated.
std::vector<const BatchJob*> recordings_of(const std::vector<BatchJob>& jobs) {
  std::vector<const BatchJob*> recordings;
  for (const BatchJob& job : jobs) {
    // Jobs of one recording stand together.
    const bool first = recordings.empty() || recordings.back()->recording != job.recording;
    if (job.simulation && first) recordings.push_back(&job);
  }
  return recordings;
}

std::string lines_of(const simulator::SimulationReport& report) {
  if (report.reused) return "";
  std::string text = fmt::format("{} frames, up to {:.2f} m/s and {:.2f} rad/s", report.frames,
                                 report.peaks.speed_mps, report.peaks.rate_radps);
  for (const std::string& warning : report.warnings)
    text += fmt::format("{}warning: {}", kBetweenLines, warning);
  return text;
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(kBetweenLines, begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

/// In the child.
void work(const BatchJob& job, int threads, const std::atomic<bool>* stop,
          const process::JobReporter& reporter) {
  const Workers workers(threads);
  const auto options = suites::simulation_options(*job.simulation);
  const simulator::SimulationControl control{
      [&](std::size_t done, std::size_t total) { reporter.progress(done, total); }, stop};
  const auto report = options ? simulator::simulate(*options, job.recording, workers, control)
                              : tl::unexpected(options.error());
  if (report) {
    reporter.finished(lines_of(*report));
  } else {
    reporter.failed(report.error());
  }
}

process::JobEnd wait_for(process::ForkedJob& process, const SimulatingControl& control) {
  constexpr int kLookAround_ms = 100;
  while (true) {
    pollfd descriptor{process.descriptor(), POLLIN, 0};
    ::poll(&descriptor, 1, kLookAround_ms);
    if (control.stop != nullptr && control.stop->load()) process.interrupt();
    if (auto end = process.poll()) return std::move(*end);
    if (control.progress && process.total() > 0) control.progress(process.done(), process.total());
  }
}

}  // namespace

Result<void> check_simulations(const std::vector<BatchJob>& jobs) {
  for (const BatchJob* job : recordings_of(jobs)) {
    const auto checked = suites::simulation_options(*job->simulation).and_then(simulator::check_simulation);
    if (!checked) {
      return fail(
          checked.error().code,
          fmt::format("recording '{}': {}", job->recording.filename().string(), checked.error().message),
          checked.error().hint);
    }
  }
  return {};
}

Result<void> make_simulated_recordings(const std::vector<BatchJob>& jobs, int threads,
                                       const SimulatingControl& control) {
  const std::vector<const BatchJob*> recordings = recordings_of(jobs);
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const BatchJob& job = *recordings[i];
    const std::string name = job.recording.filename().string();
    if (control.started) control.started(name, i, recordings.size());
    auto process = process::ForkedJob::start(
        [&](const process::JobReporter& reporter) { work(job, threads, control.stop, reporter); }, {},
        job.recording);
    if (!process) return tl::unexpected(process.error());
    const process::JobEnd end = wait_for(*process, control);
    if (!end.finished) {
      const Error error = end.error.value_or(Error{ErrorCode::run_failed, "simulating it " + end.reason, ""});
      return fail(error.code, fmt::format("recording '{}': {}", name, error.message), error.hint);
    }
    if (control.finished) control.finished(split(*end.finished));
  }
  return {};
}

}  // namespace fusebench::engine
