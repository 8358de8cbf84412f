#include "eval/cli/console/engine_console.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "eval/cli/console/console.hpp"
#include "eval/record/record.hpp"
#include "eval/suites/engine/simulated_recordings.hpp"
#include "eval/text/text_layout.hpp"

namespace fusebench::cli::console {

namespace {

constexpr std::size_t kMostRows = 50;  // of finished runs that are listed one by one

std::string ending_of(const engine::BatchOutcome& outcome) {
  if (outcome.skipped) return "skipped: " + outcome.reason;
  if (outcome.status != record::RunStatus::ok)
    return fmt::format("{}: {}", record::to_string(outcome.status), outcome.reason);
  const auto record = record::read_record(outcome.folder / "record.json");
  return record ? summary_line(*record) : record.error().message;
}

}  // namespace

EngineConsole::EngineConsole(std::span<const engine::BatchJob> jobs) : jobs_(jobs) {}

engine::EngineControl EngineConsole::control() {
  return {[this](std::size_t index, const engine::BatchOutcome& outcome) { tell(index, outcome); },
          [this](const engine::EngineState& state) { show(state); }, &stop_requested()};
}

void EngineConsole::tell(std::size_t index, const engine::BatchOutcome& outcome) {
  if (outcome.resumed && outcome.skipped) return;  // not selected
  ++told_;
  if (outcome.resumed && ++resumed_ > kMostRows) return;
  const bool more = outcome.resumed && resumed_ == kMostRows;
  print_progress(fmt::format("[{}/{}] {}: {}{}{}", told_, jobs_.size(), engine::to_string(jobs_[index]),
                             outcome.resumed && !outcome.skipped ? "(was there) " : "", ending_of(outcome),
                             more ? "; further finished runs are not listed" : ""));
}

void EngineConsole::show(const engine::EngineState& state) {
  std::string line = fmt::format("[{}/{}] {}", state.ended, state.jobs, rate_text(state));
  for (const std::string& job : state.running) line += " | " + job;
  progress_.say(std::move(line));
}

std::string rate_text(const engine::EngineState& state) {
  const std::size_t made = state.ended - state.resumed;
  std::string text = fmt::format("{} failed", state.failed);
  const double done = static_cast<double>(made) + state.share_running;
  if (done <= 0.1 || state.elapsed_s <= 0) return text;
  const double left = static_cast<double>(state.jobs - state.ended) - state.share_running;
  return text + fmt::format(", {:.1f} runs/min, {} left", 60 * done / state.elapsed_s,
                            text::duration_text(std::max(0.0, left) * state.elapsed_s / done));
}

Result<void> simulate_missing(const std::vector<engine::BatchJob>& jobs, int threads) {
  std::string title;
  std::optional<Progress> progress;
  engine::SimulatingControl control;
  control.started = [&](const std::string& name, std::size_t index, std::size_t count) {
    title = fmt::format("[{}/{}] simulating {}", index + 1, count, name);
    progress.emplace(title);
  };
  control.progress = [&](std::size_t done, std::size_t total) { progress->show(done, total); };
  control.finished = [&](const std::vector<std::string>& lines) {
    for (const std::string& line : lines) print_progress(fmt::format("{}: {}", title, line));
  };
  return engine::make_simulated_recordings(jobs, threads, control);
}

}  // namespace fusebench::cli::console
