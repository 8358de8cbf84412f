#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "eval/batch.hpp"
#include "eval/batch_processes.hpp"
#include "eval/cli/console.hpp"
#include "eval/cli/shared_options.hpp"
#include "eval/cli/verbs.hpp"
#include "eval/experiment.hpp"
#include "eval/json_text.hpp"
#include "eval/simulated_recordings.hpp"
#include "eval/study/bars_json.hpp"
#include "eval/study/summary_formats.hpp"
#include "eval/text_file.hpp"

namespace fusebench {

namespace {

constexpr int kExitBarFailed = 1;

struct BenchOptions {
  std::filesystem::path suite;
  BatchOptions batch;
  int at_once = 1;
  std::size_t job = 0;  // 0: all
  bool threads_given = false;
  std::filesystem::path summary;
  std::filesystem::path summary_page;
  bool json = false;
};

struct RunCounts {
  std::size_t ok = 0;
  std::size_t failed = 0;
  std::size_t total = 0;
};

std::string json_of(const Suite& suite, const std::vector<BatchOutcome>& outcomes, const RunCounts& counts,
                    const std::vector<BarResult>& bars) {
  using Json = nlohmann::ordered_json;
  Json runs = Json::array();
  for (const BatchOutcome& outcome : outcomes) {
    runs.push_back({{"recording", outcome.recording},
                    {"variant", outcome.variant},
                    {"status", to_string(outcome.status)},
                    {"reason", outcome.reason},
                    {"skipped", outcome.skipped},
                    {"resumed", outcome.resumed},
                    {"folder", outcome.folder.string()}});
  }
  Json document = {{"suite", suite.name}, {"n_ok", counts.ok}, {"n_total", counts.total}, {"runs", runs}};
  if (!suite.bars.empty()) document["bars"] = bars_json(bars);
  return json_text(document) + "\n";
}

/// The bar while a run goes on, one line when it has ended.
class BatchConsole {
 public:
  explicit BatchConsole(const std::vector<BatchJob>& jobs) : jobs_(jobs) {}

  [[nodiscard]] BatchControl control() {
    BatchControl control;
    control.started = [this](const BatchJob&, std::size_t index, std::size_t) {
      index_ = index;
      bar_ = ProgressBar(title(index));
    };
    control.progress = [this](std::size_t frame, std::size_t total) { bar_.show(frame, total); };
    control.finished = [this](const BatchOutcome& outcome) { say(index_, outcome); };
    control.stop = &stop_requested();
    return control;
  }

  /// Of runs side by side only the end is told.
  [[nodiscard]] ProcessControl process_control() {
    return {[this](std::size_t index, const BatchOutcome& outcome) { say(index, outcome); },
            &stop_requested()};
  }

 private:
  [[nodiscard]] std::string title(std::size_t index) const {
    const BatchJob& job = jobs_[index];
    return fmt::format("[{}/{}] {} {}", index + 1, jobs_.size(), job.recording.filename().string(),
                       job.variant);
  }

  void say(std::size_t index, const BatchOutcome& outcome) {
    bar_.clear();
    const std::string ending =
        outcome.status == RunStatus::ok
            ? summary_line(outcome.record)
            : fmt::format("{}: {}", outcome.skipped ? "skipped" : to_string(outcome.status), outcome.reason);
    print_progress(fmt::format("{}: {}{}", title(index), outcome.resumed ? "(was there) " : "", ending));
  }

  const std::vector<BatchJob>& jobs_;
  std::size_t index_ = 0;
  ProgressBar bar_{""};
};

Result<void> simulate_missing(const std::vector<BatchJob>& jobs, int threads) {
  std::string title;
  ProgressBar bar("");
  SimulatingControl control;
  control.started = [&](const std::string& name, std::size_t index, std::size_t count) {
    title = fmt::format("[{}/{}] simulating {}", index + 1, count, name);
    bar = ProgressBar(title);
  };
  control.progress = [&](std::size_t done, std::size_t total) { bar.show(done, total); };
  control.finished = [&](const SimulationReport& report) {
    bar.clear();
    if (report.reused) return;
    print_progress(fmt::format("{}: {} frames, up to {:.2f} m/s and {:.2f} rad/s", title, report.frames,
                               report.peaks.speed_mps, report.peaks.rate_radps));
    for (const std::string& warning : report.warnings) print_progress(fmt::format("warning: {}", warning));
  };
  control.stop = &stop_requested();
  auto made = make_simulated_recordings(jobs, threads, control);
  bar.clear();
  return made;
}

/// This program again, for one job; what is relative stays so, since it starts in the same folder.
std::vector<std::string> command_of(const BenchOptions& options, const BatchOptions& batch,
                                    std::size_t index) {
  std::vector<std::string> command = {"/proc/self/exe",
                                      "bench",
                                      options.suite.string(),
                                      "--job",
                                      fmt::format("{}", index + 1),
                                      "--out",
                                      batch.out.string(),
                                      "--simulated",
                                      batch.simulated.string(),
                                      "--threads",
                                      fmt::format("{}", batch.threads),
                                      "--json"};
  const auto add = [&](std::string key, std::string value) {
    command.push_back(std::move(key));
    command.push_back(std::move(value));
  };
  if (!batch.data.empty()) add("--data", batch.data.string());
  for (const std::string& filter : batch.only) add("--only", filter);
  for (const std::string& assignment : batch.sets) add("--set", assignment);
  if (batch.resume) command.emplace_back("--resume");
  return command;
}

/// Processes that are stopped cannot tell which empty folders above theirs nobody else needs.
void remove_empty_folders(const std::filesystem::path& folder) {
  std::error_code error;
  std::vector<std::filesystem::path> inner;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_directory(ignored) && !entry->is_symlink(ignored)) inner.push_back(entry->path());
  }
  for (const std::filesystem::path& path : inner) remove_empty_folders(path);
  std::filesystem::remove(folder, error);  // leaves what is not empty
}

Result<std::vector<BatchOutcome>> run_jobs(const BenchOptions& options, const BatchOptions& batch,
                                           const std::vector<BatchJob>& jobs) {
  BatchConsole console(jobs);
  if (options.at_once == 1) return run_batch(jobs, batch.resume, console.control());
  const auto command = [&](std::size_t index) { return command_of(options, batch, index); };
  std::error_code ignored;
  const bool was_there = std::filesystem::exists(batch.out, ignored);
  auto outcomes = run_batch_in_processes(jobs, options.at_once, command, console.process_control());
  if (!outcomes && !was_there) remove_empty_folders(batch.out);
  return outcomes;
}

/// All jobs, or the one of --job.
Result<std::vector<BatchJob>> jobs_of(const Suite& suite, const BenchOptions& options,
                                      const BatchOptions& batch) {
  auto jobs = plan_batch(suite, batch);
  if (!jobs || options.job == 0) return jobs;
  if (options.job > jobs->size()) {
    return fail(ErrorCode::usage, fmt::format("--job {} (allowed: 1 .. {}, with what --only leaves)",
                                              options.job, jobs->size()));
  }
  return std::vector<BatchJob>{std::move((*jobs)[options.job - 1])};
}

RunCounts counts_of(const std::vector<BatchOutcome>& outcomes) {
  RunCounts counts;
  for (const BatchOutcome& outcome : outcomes) {
    if (outcome.skipped) continue;
    ++counts.total;
    if (outcome.status == RunStatus::ok) ++counts.ok;
    if (outcome.status == RunStatus::failed) ++counts.failed;
  }
  return counts;
}

std::vector<StudyRun> study_runs(const std::vector<BatchOutcome>& outcomes) {
  std::vector<StudyRun> runs;
  for (const BatchOutcome& outcome : outcomes) {
    if (outcome.skipped) continue;
    runs.push_back(
        {outcome.recording, outcome.group, outcome.half, outcome.variant, outcome.folder, outcome.record});
  }
  return runs;
}

/// What the runs say together: the files that were asked for, the tables, and the bars. Nothing of that is
/// for one job alone, or for a suite without bars unless a file is asked for.
Result<std::vector<BarResult>> conclude(const Suite& suite, const BenchOptions& options,
                                        const std::vector<BatchOutcome>& outcomes) {
  const bool files = !options.summary.empty() || !options.summary_page.empty();
  if (options.job != 0 || (suite.bars.empty() && !files)) return std::vector<BarResult>{};
  const Study study = gather_study(study_runs(outcomes));
  StudySummary summary = summarise(suite.name, study, suite.bars);
  if (!options.summary.empty()) {
    if (auto written = write_text_file(options.summary, summary_json(summary, study)); !written)
      return tl::unexpected(written.error());
  }
  if (!options.summary_page.empty()) {
    if (auto written = write_text_file(options.summary_page, summary_page(summary, study)); !written)
      return tl::unexpected(written.error());
  }
  if (!options.json) print_output(summary_text(summary));
  return std::move(summary.bars);
}

/// Bars say what a lost run means; without bars, each run has to be ok.
int exit_code_of(const RunCounts& counts, const std::vector<BarResult>& bars) {
  const auto failed = [](const BarResult& bar) { return bar.decided.verdict == Verdict::failed; };
  if (std::any_of(bars.begin(), bars.end(), failed)) return kExitBarFailed;
  const bool good = bars.empty() ? counts.ok == counts.total : counts.failed == 0;
  return good ? 0 : kExitRunFailed;
}

Result<int> bench(const BenchOptions& options) {
  const auto suite = read_suite(options.suite);
  if (!suite) return tl::unexpected(suite.error());
  BatchOptions batch = options.batch;
  if (batch.out.empty()) batch.out = std::filesystem::path("results/runs") / suite->name;
  const int all_threads = batch.threads;
  // Side by side, runs share the machine unless somebody says how many threads each has.
  if (!options.threads_given) batch.threads = std::max(1, all_threads / options.at_once);
  const auto jobs = jobs_of(*suite, options, batch);
  if (!jobs) return tl::unexpected(jobs.error());
  if (auto made = simulate_missing(*jobs, all_threads); !made) return tl::unexpected(made.error());
  const auto outcomes = run_jobs(options, batch, *jobs);
  if (!outcomes) return tl::unexpected(outcomes.error());

  const RunCounts counts = counts_of(*outcomes);
  if (counts.total == 0 && options.job == 0) {
    return fail(ErrorCode::data_missing,
                fmt::format("suite '{}': none of the recordings can be opened", suite->name),
                "the lines above say why");
  }
  print_progress(fmt::format("{}: {} of {} runs ok; `fusebench table {}` shows them", suite->name, counts.ok,
                             counts.total, batch.out.string()));
  const auto bars = conclude(*suite, options, *outcomes);
  if (!bars) return tl::unexpected(bars.error());
  if (options.json) print_output(json_of(*suite, *outcomes, counts, *bars));
  return exit_code_of(counts, *bars);
}

}  // namespace

Verb add_bench_verb(CLI::App& app) {
  auto options = std::make_shared<BenchOptions>();
  CLI::App* verb = app.add_subcommand("bench", "Runs a suite: every variant over every recording");
  verb->add_option("SUITE", options->suite, "TOML file of a suite, e.g. configs/suites/quickstart.toml")
      ->required();
  add_data_option(*verb, options->batch.data);
  verb->add_option("--out", options->batch.out, "Folder of the runs; default: results/runs/<suite>")
      ->type_name("DIR");
  verb->add_option("--simulated", options->batch.simulated,
                   "Folder of the recordings that the suite simulates; those that are there are used again")
      ->type_name("DIR")
      ->capture_default_str();
  verb->add_option("--only", options->batch.only,
                   "Only some runs: recording=TEXT (the name contains it) or variant=NAME; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  verb->add_flag("--resume", options->batch.resume,
                 "Leaves alone what already ended as ok or lost with the same hash");
  add_set_option(*verb, options->batch.sets);
  verb->add_option("-j,--jobs", options->at_once,
                   "Runs at a time, each in a process of its own; --threads is then by default its share of "
                   "the machine")
      ->check(CLI::Range(1, 1024))
      ->type_name("N")
      ->capture_default_str();
  verb->add_option("--job", options->job, "Only the run of that number, counted from 1 after --only")
      ->type_name("N");
  add_threads_option(*verb, options->batch.threads);
  verb->add_option(
          "--summary", options->summary,
          "Writes what the runs say together as JSON: by half, group and variant, against the motion "
          "in the image, and the suite's bars")
      ->type_name("FILE");
  verb->add_option("--summary-page", options->summary_page,
                   "Writes the same as a page with charts (HTML, needs no network)")
      ->type_name("FILE");
  add_json_flag(*verb, options->json);
  verb->footer(
      "A run that fails or is lost is a row with its reason, and the suite goes on; the exit code is then 4. "
      "A "
      "suite with\nbars prints its summary and ends with 1 if a bar failed; runs that are lost are then the "
      "bars' matter.");
  return {verb, [options, verb] {
            options->threads_given = verb->count("--threads") > 0;
            return bench(*options);
          }};
}

}  // namespace fusebench
