#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "eval/cli/console/console.hpp"
#include "eval/cli/console/engine_console.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/running/run_verbs.hpp"
#include "eval/engine/local_engine.hpp"
#include "eval/engine/plan_preview.hpp"
#include "eval/reproduction/table1.hpp"

namespace fusebench::cli::running {

namespace {

struct ReproduceOptions {
  engine::BatchOptions batch;
  engine::EngineOptions engine;
  std::vector<std::string> readings;
  std::string format = "markdown";
  bool dry_run = false;
  bool json = false;
  bool threads_given = false;
};

void print_plan(const reproduction::Table1Plan& plan, const ReproduceOptions& options) {
  const engine::BatchPlan batch{plan.jobs, {}, {}};
  const engine::PlanPreview preview = engine::preview_of(batch);
  const int at_once = options.engine.at_once;
  console::print_output(options.json ? engine::to_json(preview, batch, at_once)
                                     : engine::to_text(preview, batch, at_once));
}

Result<int> reproduce_table1(ReproduceOptions options) {
  const int all_threads = options.batch.threads;
  if (!options.threads_given) options.batch.threads = std::max(1, all_threads / options.engine.at_once);
  const auto protocol = reproduction::table1_protocol();
  if (!protocol) return tl::unexpected(protocol.error());
  const auto recordings = reproduction::table1_suite();
  if (!recordings) return tl::unexpected(recordings.error());
  const auto plan = reproduction::plan_table1(*protocol, *recordings, options.batch, options.readings);
  if (!plan) return tl::unexpected(plan.error());
  for (const std::string& name : plan->absent)
    console::print_progress(fmt::format("left out, not there: {}", name));
  if (options.dry_run) {
    print_plan(*plan, options);
    return 0;
  }
  if (auto made = console::simulate_missing(plan->jobs, all_threads); !made)
    return tl::unexpected(made.error());
  options.engine.limits = recordings->limits;
  console::EngineConsole console(plan->jobs);
  const auto outcomes = engine::run_locally(plan->jobs, options.engine, console.control());
  console.clear();
  if (!outcomes) return tl::unexpected(outcomes.error());
  const auto table = reproduction::table1_of(*protocol, *plan, *outcomes);
  if (!table) return tl::unexpected(table.error());
  console::print_output(reproduction::render_table1(*table, options.json ? "json" : options.format));
  return 0;
}

}  // namespace

console::Verb add_reproduce_verb(CLI::App& app) {
  auto options = std::make_shared<ReproduceOptions>();
  options->batch.out = "results/runs/table1";
  CLI::App* verb = app.add_subcommand(
      "reproduce", "Runs what the paper's table needs and prints it beside the published numbers");
  CLI::App* table1 = verb->add_subcommand(
      "table1",
      "Table 1: intensity error of the direct method and of deformed patches, by each way to read it");
  verb->require_subcommand(1);
  console::add_data_option(*table1, options->batch.data);
  table1->add_option("--out", options->batch.out, "Folder of the runs")
      ->type_name("DIR")
      ->capture_default_str();
  table1
      ->add_option("--simulated", options->batch.simulated,
                   "Folder of the recordings that are simulated; those that are there are used again")
      ->type_name("DIR")
      ->capture_default_str();
  table1->add_option("--reading", options->readings, "Only this reading, by its name; may be repeated")
      ->type_name("NAME")
      ->allow_extra_args(false);
  table1
      ->add_option("--only", options->batch.only,
                   "Only some recordings: recording=TEXT (the name contains it); may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  table1->add_option("-j,--jobs", options->engine.at_once, "Runs at a time, each in a process of its own")
      ->check(CLI::Range(1, 1024))
      ->type_name("N")
      ->capture_default_str();
  table1->add_flag("--dry-run", options->dry_run, "Prints the runs and runs nothing");
  table1->add_option("--format", options->format, "markdown or latex")
      ->check(CLI::IsMember({"markdown", "latex"}))
      ->capture_default_str();
  console::add_threads_option(*table1, options->batch.threads);
  console::add_json_flag(*table1, options->json);
  table1->footer(
      "What the paper does not define (its direct method, its error) is a reading each; docs/table1.md\n"
      "explains them. Recordings that are not under --data have simulated stand-ins, and the output says\n"
      "which is which. A finished run is not repeated.");
  return {verb, [options, table1] {
            options->threads_given = table1->count("--threads") > 0;
            return reproduce_table1(*options);
          }};
}

}  // namespace fusebench::cli::running
