#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "eval/cli/console/console.hpp"
#include "eval/cli/console/engine_console.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/running/run_verbs.hpp"
#include "eval/engine/invocation.hpp"
#include "eval/engine/local_engine.hpp"
#include "eval/engine/plan_preview.hpp"
#include "eval/engine/slurm_engine.hpp"
#include "eval/study/bars_json.hpp"
#include "eval/study/summary_formats.hpp"
#include "eval/suites/experiment.hpp"
#include "eval/text/json_text.hpp"
#include "eval/text/text_file.hpp"

namespace fusebench::cli::running {

namespace {

constexpr int kExitBarFailed = 1;

struct BenchOptions {
  engine::Invocation invocation;
  engine::EngineOptions engine;
  std::string executor = "local";
  engine::SlurmOptions slurm;
  bool threads_given = false;
  bool dry_run = false;
  std::filesystem::path summary;
  std::filesystem::path summary_page;
  bool json = false;
};

struct RunCounts {
  std::size_t ok = 0;
  std::size_t failed = 0;
  std::size_t total = 0;
};

std::string json_of(const suites::Suite& suite, const engine::BatchPlan& plan,
                    const std::vector<engine::BatchOutcome>& outcomes, const RunCounts& counts,
                    const std::vector<study::BarResult>& bars) {
  using Json = nlohmann::ordered_json;
  Json runs = Json::array();
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const engine::BatchOutcome& outcome = outcomes[i];
    runs.push_back({{"recording", outcome.recording},
                    {"variant", outcome.variant},
                    {"edits", suites::to_string(plan.jobs[i].edits)},
                    {"repetition", plan.jobs[i].spec.repetition},
                    {"status", record::to_string(outcome.status)},
                    {"reason", outcome.reason},
                    {"skipped", outcome.skipped},
                    {"resumed", outcome.resumed},
                    {"folder", outcome.folder.string()}});
  }
  Json excluded = Json::array();
  for (const engine::ExcludedRun& run : plan.excluded)
    excluded.push_back({{"run", run.run}, {"reason", run.reason}});
  Json document = {{"suite", suite.name},
                   {"n_ok", counts.ok},
                   {"n_total", counts.total},
                   {"runs", runs},
                   {"excluded", excluded}};
  if (!suite.bars.empty()) document["bars"] = study::bars_json(bars);
  return text::json_text(document) + "\n";
}

RunCounts counts_of(const std::vector<engine::BatchOutcome>& outcomes) {
  RunCounts counts;
  for (const engine::BatchOutcome& outcome : outcomes) {
    if (outcome.skipped) continue;
    ++counts.total;
    if (outcome.status == record::RunStatus::ok) ++counts.ok;
    if (outcome.status == record::RunStatus::failed) ++counts.failed;
  }
  return counts;
}

/// With their records.
std::vector<study::StudyRun> study_runs(const engine::BatchPlan& plan,
                                        const std::vector<engine::BatchOutcome>& outcomes) {
  std::vector<study::StudyRun> runs;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const engine::BatchOutcome& outcome = outcomes[i];
    if (outcome.skipped) continue;
    auto record = record::read_record(outcome.folder / "record.json");
    if (!record) {
      record = record::RunRecord{};
      record->reason = outcome.reason;
      record->recording.name = outcome.recording;
      record->variant = outcome.variant;
      record->config_hash = config::config_hash(plan.jobs[i].spec.config.values);
    }
    const bool is_there = record->status != record::RunStatus::failed;
    runs.push_back({outcome.recording, outcome.group, outcome.half, outcome.variant,
                    is_there ? outcome.folder : std::filesystem::path(), std::move(*record)});
  }
  return runs;
}

/// What the runs say together: the files that were asked for, the tables, and the bars. Nothing of that is
/// for a suite without bars unless a file is asked for.
Result<std::vector<study::BarResult>> conclude(const suites::Suite& suite, const BenchOptions& options,
                                               const engine::BatchPlan& plan,
                                               const std::vector<engine::BatchOutcome>& outcomes) {
  const bool files = !options.summary.empty() || !options.summary_page.empty();
  if (suite.bars.empty() && !files) return std::vector<study::BarResult>{};
  const study::Study study = study::gather_study(study_runs(plan, outcomes), suite.variants);
  study::StudySummary summary = study::summarise(suite.name, study, suite.bars);
  if (!options.summary.empty()) {
    if (auto written = text::write_text_file(options.summary, study::summary_json(summary, study)); !written)
      return tl::unexpected(written.error());
  }
  if (!options.summary_page.empty()) {
    if (auto written = text::write_text_file(options.summary_page, study::summary_page(summary, study));
        !written)
      return tl::unexpected(written.error());
  }
  if (!options.json) console::print_output(study::summary_text(summary));
  return std::move(summary.bars);
}

/// Bars say what a lost run means; without bars, each run has to be ok.
int exit_code_of(const RunCounts& counts, const std::vector<study::BarResult>& bars) {
  const auto failed = [](const study::BarResult& bar) {
    return bar.decided.verdict == study::Verdict::failed;
  };
  if (std::any_of(bars.begin(), bars.end(), failed)) return kExitBarFailed;
  const bool good = bars.empty() ? counts.ok == counts.total : counts.failed == 0;
  return good ? 0 : console::kExitRunFailed;
}

Result<int> preview(const BenchOptions& options, const engine::BatchPlan& plan) {
  const engine::PlanPreview preview = engine::preview_of(plan);
  const int at_once = options.engine.at_once;
  console::print_output(options.json ? engine::to_json(preview, plan, at_once)
                                     : engine::to_text(preview, plan, at_once));
  return 0;
}

Result<std::vector<engine::BatchOutcome>> run_plan(const BenchOptions& options, const suites::Suite& suite,
                                                   const engine::BatchPlan& plan, int all_threads) {
  const auto kept = engine::keep(options.invocation);
  if (!kept) return tl::unexpected(kept.error());
  if (auto made = console::simulate_missing(plan.jobs, all_threads); !made)
    return tl::unexpected(made.error());
  engine::EngineOptions engine = options.engine;
  engine.limits = suite.limits;
  console::EngineConsole console(plan.jobs);
  const engine::EngineControl control = console.control();
  std::error_code ignored;
  const engine::SlurmSite site{std::filesystem::absolute(*kept, ignored),
                               std::filesystem::read_symlink("/proc/self/exe", ignored)};
  auto outcomes = options.executor == "slurm"
                      ? engine::run_on_slurm(plan.jobs, engine, options.slurm, site, control)
                      : engine::run_locally(plan.jobs, engine, control);
  console.clear();
  return outcomes;
}

/// Side by side, runs share the machine unless somebody says how many threads each has; on a cluster, a run
/// has one, and the cluster many runs.
Result<void> set_executor(BenchOptions& options) {
  int& threads = options.invocation.options.threads;
  const int at_once = options.engine.at_once;
  if (options.executor == "local") {
    if (options.slurm.submit_only || options.slurm.chunk > 0 || !options.slurm.arguments.empty())
      return fail(ErrorCode::usage, "--submit, --chunk and --slurm-arg are for --executor slurm");
    if (!options.threads_given) threads = std::max(1, threads / at_once);
    return {};
  }
  if (!options.threads_given) threads = 1;
  options.slurm.at_once = at_once;
  options.slurm.cpus = at_once * threads;
  if (!options.engine.repeat_finished) return {};
  return fail(ErrorCode::usage, "--repeat is for --executor local", "another --out starts afresh");
}

/// Returns when everything is in the queue.
Result<int> submit(const BenchOptions& options, const suites::Suite& suite, const engine::BatchPlan& plan,
                   int all_threads) {
  const auto outcomes = run_plan(options, suite, plan, all_threads);
  if (!outcomes) return tl::unexpected(outcomes.error());
  const std::string out = options.invocation.options.out.string();
  console::print_progress(
      fmt::format("{}: submitted; `fusebench collect {}` shows what is there, and the same command without "
                  "--submit waits for the rest and submits again what was lost",
                  suite.name, out));
  return 0;
}

Result<int> bench(BenchOptions options) {
  const auto suite = engine::suite_of(options.invocation);
  if (!suite) return tl::unexpected(suite.error());
  engine::BatchOptions& batch = options.invocation.options;
  if (batch.out.empty()) batch.out = std::filesystem::path("results/runs") / suite->name;
  const int all_threads = batch.threads;
  if (auto sensible = set_executor(options); !sensible) return tl::unexpected(sensible.error());
  const auto plan = engine::plan_batch(*suite, batch);
  if (!plan) return tl::unexpected(plan.error());
  for (const std::string& warning : plan->warnings) console::print_progress("warning: " + warning);
  if (options.dry_run) return preview(options, *plan);
  if (plan->jobs.empty()) {
    return fail(ErrorCode::usage,
                fmt::format("all {} runs of suite '{}' are excluded, the first one because: {}",
                            plan->excluded.size(), suite->name, plan->excluded.front().reason),
                "[[exclude]] without recording, variant and options leaves everything out");
  }
  if (options.executor == "slurm" && options.slurm.submit_only)
    return submit(options, *suite, *plan, all_threads);
  const auto outcomes = run_plan(options, *suite, *plan, all_threads);
  if (!outcomes) return tl::unexpected(outcomes.error());

  const RunCounts counts = counts_of(*outcomes);
  if (options.engine.only_failed) {
    console::print_progress(
        fmt::format("{}: {} runs were run again, {} of them ok", suite->name, counts.total, counts.ok));
    return counts.failed == 0 ? 0 : console::kExitRunFailed;
  }
  if (counts.total == 0) {
    return fail(ErrorCode::data_missing,
                fmt::format("suite '{}': none of the recordings can be opened", suite->name),
                "the lines above say why");
  }
  console::print_progress(fmt::format(
      "{}: {} of {} runs ok{}; `fusebench table {}` shows them", suite->name, counts.ok, counts.total,
      plan->excluded.empty() ? "" : fmt::format(", {} excluded", plan->excluded.size()), batch.out.string()));
  const auto bars = conclude(*suite, options, *plan, *outcomes);
  if (!bars) return tl::unexpected(bars.error());
  if (options.json) console::print_output(json_of(*suite, *plan, *outcomes, counts, *bars));
  return exit_code_of(counts, *bars);
}

void add_slurm_options(CLI::App& verb, BenchOptions& options) {
  engine::SlurmOptions& slurm = options.slurm;
  verb.add_option(
          "--executor", options.executor,
          "Where runs run: local, or slurm: as job arrays; --out must then be on a folder that all nodes "
          "share, and -j is the runs at a time of each task")
      ->check(CLI::IsMember({"local", "slurm"}))
      ->capture_default_str();
  verb.add_flag("--submit", slurm.submit_only, "With slurm: returns when everything is in the queue");
  verb.add_option("--chunk", slurm.chunk, "With slurm: runs of one task; default: about a minute's")
      ->check(CLI::PositiveNumber)
      ->type_name("N");
  verb.add_option(
          "--slurm-silence", slurm.silence_s,
          "With slurm: a running task without a sign of life for so long is given up, and its runs are "
          "submitted again")
      ->check(CLI::Range(2.0, 86400.0))
      ->type_name("S")
      ->capture_default_str();
  verb.add_option("--slurm-arg", slurm.arguments,
                  "With slurm: an argument for sbatch, e.g. --slurm-arg=--partition=cpu; may be repeated")
      ->type_name("ARG")
      ->allow_extra_args(false);
}

void add_suite_options(CLI::App& verb, engine::Invocation& invocation) {
  engine::BatchOptions& batch = invocation.options;
  verb.add_option("SUITE", invocation.suite, "TOML file of a suite, e.g. configs/suites/quickstart.toml")
      ->required();
  console::add_data_option(verb, batch.data);
  verb.add_option("--out", batch.out, "Folder of the runs; default: results/runs/<suite>")->type_name("DIR");
  verb.add_option("--simulated", batch.simulated,
                  "Folder of the recordings that the suite simulates; those that are there are used again")
      ->type_name("DIR")
      ->capture_default_str();
  verb.add_option("--only", batch.only,
                  "Only some runs: recording=TEXT (the name contains it) or variant=NAME; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  verb.add_option(
          "--set", batch.sets,
          "Sets one option, e.g. iekf.max_iterations=8, or sweeps it: iekf.max_iterations=1,2,4; may be "
          "repeated, sweeps then multiply")
      ->type_name("KEY=VALUE[,VALUE...]")
      ->allow_extra_args(false);
  verb.add_option("--repetitions", invocation.overrides.repetitions,
                  "Repeats each run, for samples of its time; default: as the suite says")
      ->check(CLI::Range(1, 1000))
      ->type_name("N");
  verb.add_option(
          "--keep", invocation.overrides.kept,
          "Files of each run: all, or small (no model, patches, states and pixels: a hundredth of the "
          "space); default: as the suite says")
      ->check(CLI::IsMember({"all", "small"}))
      ->type_name("FILES");
}

console::Verb add(CLI::App& app) {
  auto options = std::make_shared<BenchOptions>();
  CLI::App* verb = app.add_subcommand(
      "bench", "Runs a suite: every variant over every recording, and every point of its sweeps");
  add_suite_options(*verb, options->invocation);
  verb->add_flag("--repeat", options->engine.repeat_finished, "Runs again what is finished");
  verb->add_flag("--dry-run", options->dry_run,
                 "Prints the runs, which are finished, and how long the others will take; runs nothing");
  verb->add_option("-j,--jobs", options->engine.at_once,
                   "Runs at a time, each in a process of its own; --threads is then by default its share of "
                   "the machine")
      ->check(CLI::Range(1, 1024))
      ->type_name("N")
      ->capture_default_str();
  add_slurm_options(*verb, *options);
  console::add_threads_option(*verb, options->invocation.options.threads);
  console::add_profile_flag(*verb, options->invocation.options.profile);
  verb->add_option(
          "--summary", options->summary,
          "Writes what the runs say together as JSON: by half, group and variant, against the motion "
          "in the image, and the suite's bars")
      ->type_name("FILE");
  verb->add_option("--summary-page", options->summary_page,
                   "Writes the same as a page with charts (HTML, needs no network)")
      ->type_name("FILE");
  console::add_json_flag(*verb, options->json);
  verb->footer(
      "A finished run is never repeated: its folder is named by the hash of configuration, recording and\n"
      "estimator. With --profile, one that has no profile is. A run that fails, crashes, hangs or is lost\n"
      "is a row with its reason, and the suite goes on; the exit code is then 4. A suite with bars prints\n"
      "its summary and ends with 1 if a bar failed; runs that are lost are then the bars' matter.\n"
      "docs/experiments.md says what a suite can ask for.");
  return {verb, [options, verb] {
            options->threads_given = verb->count("--threads") > 0;
            return bench(*options);
          }};
}

/// Relative folders in a suite are relative to where its command was given.
Result<void> enter(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::current_path(folder, error);
  if (!error) return {};
  return fail(ErrorCode::data_missing,
              fmt::format("{}: the folder where the suite was started cannot be entered: {}", folder.string(),
                          error.message()));
}

/// Every invocation that was kept, its failed runs only.
Result<int> rerun(const BenchOptions& options, const std::filesystem::path& runs) {
  std::error_code ignored;
  const auto files = engine::kept_invocations(std::filesystem::absolute(runs, ignored));
  if (!files) return tl::unexpected(files.error());
  int worst = 0;
  for (const std::filesystem::path& file : *files) {
    auto invocation = engine::read_invocation(file);
    if (!invocation) return tl::unexpected(invocation.error());
    if (auto entered = enter(invocation->working_folder); !entered) return tl::unexpected(entered.error());
    BenchOptions again = options;
    again.invocation = std::move(*invocation);
    again.engine.only_failed = true;
    const auto code = bench(std::move(again));
    if (!code) return code;
    worst = std::max(worst, *code);
  }
  return worst;
}

}  // namespace

console::Verb add_bench_verb(CLI::App& app) {
  return add(app);
}

console::Verb add_slurm_task_verb(CLI::App& app) {
  struct TaskOptions {
    std::filesystem::path invocation;
    std::filesystem::path tasks;
    std::size_t task = 0;
    engine::EngineOptions engine;
  };
  auto options = std::make_shared<TaskOptions>();
  CLI::App* verb = app.add_subcommand("slurm-task", "What a node runs for --executor slurm; not for people");
  verb->add_option("INVOCATION", options->invocation, "Kept by bench")->required();
  verb->add_option("TASKS", options->tasks, "The array's task file")->required();
  verb->add_option("TASK", options->task, "Number of the task")->required();
  verb->add_option("-j,--jobs", options->engine.at_once, "Runs at a time")->check(CLI::Range(1, 1024));
  return {verb, [options]() -> Result<int> {
            const auto invocation = engine::read_invocation(options->invocation);
            if (!invocation) return tl::unexpected(invocation.error());
            if (auto entered = enter(invocation->working_folder); !entered)
              return tl::unexpected(entered.error());
            const auto suite = engine::suite_of(*invocation);
            if (!suite) return tl::unexpected(suite.error());
            const auto plan = engine::plan_batch(*suite, invocation->options);
            if (!plan) return tl::unexpected(plan.error());
            options->engine.limits = suite->limits;
            engine::EngineControl control;
            control.stop = &console::stop_requested();
            const auto done =
                engine::run_slurm_task(plan->jobs, options->engine, options->tasks, options->task, control);
            if (!done) return tl::unexpected(done.error());
            return 0;
          }};
}

console::Verb add_rerun_verb(CLI::App& app) {
  struct RerunOptions {
    BenchOptions bench;
    std::filesystem::path runs;
  };
  auto options = std::make_shared<RerunOptions>();
  CLI::App* verb = app.add_subcommand("rerun", "Repeats the failed runs of a folder of runs");
  verb->add_option("RUNS", options->runs, "Folder that `fusebench bench` wrote (its --out)")->required();
  verb->add_option("-j,--jobs", options->bench.engine.at_once, "Runs at a time")
      ->check(CLI::Range(1, 1024))
      ->type_name("N")
      ->capture_default_str();
  return {verb, [options] {
            options->bench.threads_given = true;  // as the runs were asked for
            return rerun(options->bench, options->runs);
          }};
}

}  // namespace fusebench::cli::running
