#include "eval/simulated_recordings.hpp"

#include <fmt/format.h>

#include "eval/simulation_request.hpp"

namespace fusebench {

namespace {

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

}  // namespace

Result<void> make_simulated_recordings(const std::vector<BatchJob>& jobs, int threads,
                                       const SimulatingControl& control) {
  const std::vector<const BatchJob*> recordings = recordings_of(jobs);
  const Workers workers(threads);
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const BatchJob& job = *recordings[i];
    const std::string name = job.recording.filename().string();
    if (control.started) control.started(name, i, recordings.size());
    const auto options = simulation_options(*job.simulation);
    const auto report = options ? simulate(*options, job.recording, workers, {control.progress, control.stop})
                                : tl::unexpected(options.error());
    if (!report) {
      const Error& error = report.error();
      return fail(error.code, fmt::format("recording '{}': {}", name, error.message), error.hint);
    }
    if (control.finished) control.finished(*report);
  }
  return {};
}

}  // namespace fusebench
