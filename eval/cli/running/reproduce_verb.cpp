#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "eval/cli/console/console.hpp"
#include "eval/cli/console/progress.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/running/batch_controls.hpp"
#include "eval/cli/running/run_verbs.hpp"
#include "eval/compare/reproduction/table1.hpp"
#include "eval/page/figures.hpp"
#include "eval/page/page.hpp"
#include "eval/record/run_files/found_runs.hpp"
#include "eval/report/paper_figures/paper_figures.hpp"
#include "eval/text/text_file.hpp"

namespace fusebench::cli::running {

namespace {

/// What both verbs need to run their runs.
struct ReproduceOptions {
  engine::BatchOptions batch;
  BatchControls controls;
  reproduction::Table1Extent extent;
  std::string format;
  std::filesystem::path figures;
  std::filesystem::path page;
};

Result<int> reproduce_table1(ReproduceOptions options) {
  const int all_threads = options.batch.threads;
  share_threads(options.controls, options.batch);
  const auto protocol = reproduction::table1_protocol();
  if (!protocol) return tl::unexpected(protocol.error());
  const auto recordings = reproduction::table1_suite();
  if (!recordings) return tl::unexpected(recordings.error());
  const auto plan = reproduction::plan_table1(*protocol, *recordings, options.batch, options.extent);
  if (!plan) return tl::unexpected(plan.error());
  for (const std::string& name : plan->absent)
    console::print_progress(fmt::format("left out, does not exist: {}", name));
  if (options.controls.dry_run) {
    print_preview({plan->jobs, {}, {}}, options.controls);
    return 0;
  }
  const auto outcomes = run_here(plan->jobs, options.controls, recordings->limits, all_threads);
  if (!outcomes) return tl::unexpected(outcomes.error());
  const console::Progress progress("tables");
  const console::Heartbeat heartbeat;
  const auto table = reproduction::table1_of(*protocol, *plan, *outcomes);
  if (!table) return tl::unexpected(table.error());
  console::print_output(reproduction::render_table1(*table, options.controls.json ? "json" : options.format));
  if (options.page.empty()) return 0;
  const std::string html = page::to_html(reproduction::table1_page(*table));
  if (auto written = text::write_text_file(options.page, html); !written)
    return tl::unexpected(written.error());
  return 0;
}

/// The runs of each recording, by its group.
std::vector<paper_figures::RecordingRuns> runs_by_group(const std::vector<engine::BatchOutcome>& outcomes) {
  std::vector<paper_figures::RecordingRuns> recordings;
  for (const engine::BatchOutcome& outcome : outcomes) {
    auto place = std::ranges::find(recordings, outcome.group, &paper_figures::RecordingRuns::label);
    if (place == recordings.end()) place = recordings.insert(recordings.end(), {outcome.group, {}});
    if (auto run = run_files::found_run(outcome.folder)) place->runs.push_back(std::move(*run));
  }
  return recordings;
}

Result<int> reproduce_figures(ReproduceOptions options) {
  const int all_threads = options.batch.threads;
  share_threads(options.controls, options.batch);
  const auto format = page::parse_figure_format(options.format);
  if (!format) return tl::unexpected(format.error());
  const auto suite = reproduction::figures_suite();
  if (!suite) return tl::unexpected(suite.error());
  const auto plan = engine::plan_batch(*suite, options.batch);
  if (!plan) return tl::unexpected(plan.error());
  if (options.controls.dry_run) {
    print_preview(*plan, options.controls);
    return 0;
  }
  const auto outcomes = run_here(plan->jobs, options.controls, suite->limits, all_threads);
  if (!outcomes) return tl::unexpected(outcomes.error());
  const console::Progress progress("drawing figures");
  const console::Heartbeat heartbeat;
  std::error_code error;
  std::filesystem::create_directories(options.figures, error);
  if (error)
    return fail(ErrorCode::io,
                fmt::format("{}: the folder cannot be made: {}", options.figures.string(), error.message()));
  const auto written = paper_figures::write_paper_figures(runs_by_group(*outcomes), options.figures, *format);
  if (!written) return tl::unexpected(written.error());
  console::print_warnings(written->warnings);
  const std::filesystem::path file = options.figures / "figures.html";
  if (auto saved = text::write_text_file(file, page::to_html(written->page)); !saved)
    return tl::unexpected(saved.error());
  console::print_progress(
      fmt::format("{}: figures as {} with the scripts that draw them, and all of them on {}",
                  options.figures.string(), options.format, file.filename().string()));
  return 0;
}

void add_running_options(CLI::App& verb, ReproduceOptions& options) {
  verb.add_option("--out", options.batch.out, "Folder of the runs")->type_name("DIR")->capture_default_str();
  add_batch_controls(verb, options.batch, options.controls);
}

CLI::App* add_table1(CLI::App& verb, ReproduceOptions& options) {
  CLI::App* table1 = verb.add_subcommand(
      "table1",
      "Table 1: intensity error of the direct method and of deformed patches, by each way to read it");
  options.batch.out = "results/runs/table1";
  options.format = "markdown";
  console::add_data_option(*table1, options.batch.data);
  add_running_options(*table1, options);
  table1->add_option("--reading", options.extent.readings, "Only this reading; repeatable")
      ->type_name("NAME")
      ->allow_extra_args(false);
  table1
      ->add_option("--only", options.batch.only,
                   "Only some recordings: recording=TEXT (the name contains it); repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  table1->add_option("--format", options.format, "markdown or latex")
      ->check(CLI::IsMember({"markdown", "latex"}))
      ->capture_default_str();
  table1->add_flag("--all-seeds", options.extent.factorial_everywhere,
                   "Makes the factorial for all recordings instead of the first one of each column");
  table1->add_option("--page", options.page, "Writes the tables as a page as well (HTML, needs no network)")
      ->type_name("FILE.html");
  console::add_json_flag(*table1, options.controls.json);
  table1->footer(
      "A reading is one interpretation of definitions that the paper leaves open (direct method, "
      "error);\ndocs/paper.md explains them. Recordings that are not under --data are replaced by simulated "
      "ones,\nwhich the output labels. A finished run is not repeated.");
  return table1;
}

CLI::App* add_figures(CLI::App& verb, ReproduceOptions& options) {
  CLI::App* figures = verb.add_subcommand(
      "figures",
      "The figures: speed, patches under deformation, with and without an IMU, reconstructions side by side");
  options.batch.out = "results/runs/figures";
  options.figures = "results/figures";
  options.format = "svg";
  add_running_options(*figures, options);
  figures->add_option("--figures", options.figures, "Folder of the figures")
      ->type_name("DIR")
      ->capture_default_str();
  figures->add_option("--format", options.format, "svg or pdf")
      ->check(CLI::IsMember({"svg", "pdf"}))
      ->capture_default_str();
  figures->footer(
      "The recordings are simulated. Drawn by gnuplot; figures.html shows all of them on one page.");
  return figures;
}

}  // namespace

console::Verb add_reproduce_verb(CLI::App& app) {
  CLI::App* verb = app.add_subcommand(
      "reproduce",
      "Makes the runs of the paper's table or figures, and shows them next to the published ones");
  verb->require_subcommand(1);
  const auto table1_options = std::make_shared<ReproduceOptions>();
  const auto figures_options = std::make_shared<ReproduceOptions>();
  CLI::App* table1 = add_table1(*verb, *table1_options);
  CLI::App* figures = add_figures(*verb, *figures_options);
  return {.app = verb,
          .run =
              [=] {
                if (figures->parsed()) {
                  figures_options->controls.threads_given = figures->count("--threads") > 0;
                  return reproduce_figures(*figures_options);
                }
                table1_options->controls.threads_given = table1->count("--threads") > 0;
                return reproduce_table1(*table1_options);
              },
          .forks = true};
}

}  // namespace fusebench::cli::running
