#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "eval/cli/console/number_checks.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/running/run_verbs.hpp"
#include "eval/cli/running/suite_run.hpp"
#include "eval/run/run_specification.hpp"
#include "eval/suites/suite_names.hpp"

namespace fusebench::cli::running {

namespace {

void add_slurm_options(CLI::App& verb, BenchOptions& options) {
  engine::SlurmOptions& slurm = options.slurm;
  verb.add_option("--executor", options.executor,
                  "Where runs are executed: local, or slurm (job arrays): --out must then be in a folder "
                  "that all nodes share, and -j is the number of runs at a time of each task")
      ->check(CLI::IsMember({"local", "slurm"}))
      ->capture_default_str();
  verb.add_flag("--submit", slurm.submit_only, "With slurm: returns when all runs are in the queue");
  verb.add_option("--chunk", slurm.chunk,
                  "With slurm: number of runs of one task; default: about a minute of runs")
      ->check(console::positive())
      ->type_name("N");
  verb.add_option("--slurm-silence", slurm.silence_s,
                  "With slurm: a running task without a heartbeat for this long is cancelled, and its runs "
                  "are submitted again")
      ->check(console::number_range(2.0, 86400.0))
      ->type_name("S")
      ->capture_default_str();
  verb.add_option("--slurm-arg", slurm.arguments,
                  "With slurm: an argument for sbatch, e.g. --slurm-arg=--partition=cpu; repeatable")
      ->type_name("ARG")
      ->allow_extra_args(false);
}

void add_suite_options(CLI::App& verb, engine::Invocation& invocation) {
  engine::BatchOptions& batch = invocation.options;
  verb.add_option("SUITE", invocation.suite,
                  "A suite: its TOML file, or the name of one in configs/suites (`fusebench list suites`)")
      ->required();
  console::add_data_option(verb, batch.data);
  verb.add_option("--out", batch.out, "Folder of the runs; default: results/runs/<suite>")->type_name("DIR");
  verb.add_option("--only", batch.only,
                  "Only some runs: recording=TEXT (the name contains it), variant=NAME, or split=held-out or "
                  "tuning; repeatable: several values of one key are OR-ed, keys are AND-ed")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  verb.add_option("--set", batch.sets,
                  "Sets an option, e.g. iekf.max_iterations=8, or sweeps it: iekf.max_iterations=1,2,4; "
                  "repeatable: sweeps are combined")
      ->type_name("KEY=VALUE[,VALUE...]")
      ->allow_extra_args(false);
  verb.add_option("--repetitions", invocation.overrides.repetitions,
                  "Number of repetitions of each run, to measure its time; default: the suite's")
      ->check(CLI::Range(1, run::kMostRepetitions))
      ->type_name("N");
  verb.add_option("--replicates", invocation.overrides.replicates,
                  "Number of replicates of each run: their initial poses differ by noise far below the "
                  "resolution of the sensors, so their results differ by chance. Tables show medians and "
                  "ranges; default: the suite's")
      ->check(CLI::Range(1, run::kMostReplicates))
      ->type_name("N");
  verb.add_option("--keep", invocation.overrides.kept,
                  "Files of each run: all, or small (without model, patches, states and pixels; a hundredth "
                  "of the space); default: the suite's")
      ->check(CLI::IsMember({"all", "small"}))
      ->type_name("FILES");
}

}  // namespace

console::Verb add_bench_verb(CLI::App& app) {
  auto options = std::make_shared<BenchOptions>();
  CLI::App* verb = app.add_subcommand(
      "bench", "Runs a suite: every variant over every recording, and every point of its sweeps");
  add_suite_options(*verb, options->invocation);
  verb->add_flag("--repeat", options->controls.engine.repeat_finished, "Repeats finished runs");
  add_batch_controls(*verb, options->invocation.options, options->controls);
  add_slurm_options(*verb, *options);
  console::add_profile_flag(*verb, options->invocation.options.profile);
  verb->add_option(
          "--summary", options->summary,
          "Writes the summary of all runs as JSON: by split, group and variant, against the motion in the "
          "image, and the suite's acceptance criteria")
      ->type_name("FILE");
  verb->add_option("--summary-page", options->summary_page,
                   "Writes the summary as a page with charts (HTML, needs no network)")
      ->type_name("FILE");
  console::add_json_flag(*verb, options->controls.json);
  verb->footer(
      "A finished run is not repeated: its folder is named by the hash of configuration, recording "
      "and\nestimator. With --profile, a run without a profile is. A run that fails, crashes, hangs or is "
      "lost\nis a row with its reason, the other runs go on, and the exit code is 4. A suite "
      "with\nacceptance criteria prints its summary and exits with 1 if one failed; lost runs then count by "
      "the criteria.\ndocs/experiments.md describes suites.");
  return {.app = verb,
          .run =
              [options, verb] {
                options->controls.threads_given = verb->count("--threads") > 0;
                return suites::find_suite(options->invocation.suite).and_then([&](const auto& file) {
                  options->invocation.suite = file;
                  return run_suite(*options);
                });
              },
          .forks = true};
}

}  // namespace fusebench::cli::running
