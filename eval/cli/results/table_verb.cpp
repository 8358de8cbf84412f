#include <CLI/CLI.hpp>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "eval/cli/console/console.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/console/table_width.hpp"
#include "eval/cli/results/result_verbs.hpp"
#include "eval/compare/tables/paper_table.hpp"
#include "eval/compare/tables/pivot_table.hpp"
#include "eval/compare/tables/systems_table.hpp"
#include "eval/compare/tables/table.hpp"
#include "eval/record/registry/run_metric.hpp"

namespace fusebench::cli::results {

namespace {

struct TableOptions {
  std::filesystem::path runs;
  std::string paper;
  std::string pivot;
  bool systems = false;
  std::string format = "markdown";
  tables::LatexLayout layout;
  bool json = false;
  std::optional<std::size_t> width;
  const CLI::Option* named_format = nullptr;
};

Result<int> pivot(const std::vector<run_files::FoundRun>& runs, const TableOptions& options,
                  tables::TableFormat format, std::size_t width) {
  const auto metric = options.pivot == "tracked"
                          ? Result<const registry::RunMetric*>(&registry::run_metric("coverage"))
                          : registry::find_ranking_metric(options.pivot);
  if (!metric) return tl::unexpected(metric.error());
  const auto text = tables::render_pivot(tables::table_of(runs), **metric, format, options.layout, width);
  if (!text) return tl::unexpected(text.error());
  console::print_output(*text);
  return 0;
}

Result<int> table(TableOptions options) {
  const auto format = tables::parse_table_format(options.json ? "json" : options.format);
  if (!format) return tl::unexpected(format.error());
  const auto runs = run_files::find_runs(options.runs);
  const std::size_t width = console::table_width(options.width, options.named_format->count() > 0);
  if (options.systems) {
    if (!runs) return tl::unexpected(runs.error());
    console::print_output(
        tables::render_systems_table(tables::systems_table_of(*runs), *format, options.layout, width));
    return 0;
  }
  if (options.paper.empty()) {
    if (!runs) return tl::unexpected(runs.error());
    if (!options.pivot.empty()) return pivot(*runs, options, *format, width);
    if (!options.layout.metrics.empty() && *format != tables::TableFormat::latex)
      return fail(ErrorCode::usage, "--metrics requires --format latex");
    for (std::string& name : options.layout.metrics)
      if (const auto metric = registry::find_ranking_metric(name)) name = (*metric)->key;
    if (auto known = tables::check_latex_metrics(options.layout.metrics); !known)
      return tl::unexpected(known.error());
    console::print_output(tables::render_table(tables::table_of(*runs), *format, options.layout, width));
    return 0;
  }
  const auto published = tables::published_table(options.paper);
  if (!published) return tl::unexpected(published.error());
  if (!runs) return tl::unexpected(runs.error());
  console::print_output(
      tables::render_paper_table(tables::paper_table(*published, *runs), *format, options.layout, width));
  return 0;
}

}  // namespace

console::Verb add_table_verb(CLI::App& app) {
  auto options = std::make_shared<TableOptions>();
  CLI::App* verb = app.add_subcommand("table", "Prints the table of a folder of runs");
  verb->add_option("RUNS", options->runs, "Folder that holds runs at any depth")->required();
  options->named_format =
      verb->add_option("--format", options->format,
                       "markdown, csv (a line a run), csv-long (a line a number), json or latex")
          ->check(CLI::IsMember({"markdown", "csv", "csv-long", "json", "latex"}))
          ->capture_default_str();
  verb->add_option("--paper", options->paper,
                   "A published table (table1, ate_tum, ate_icl, surface_icl) next to the results of RUNS")
      ->type_name("NAME");
  verb->add_flag(
          "--systems", options->systems,
          "A row a recording and system: medians and ranges over repetitions, with lost frames, CPU and "
          "memory, and published numbers below")
      ->excludes("--paper");
  verb->add_option(
          "--pivot", options->pivot,
          "One number, a line a recording and a column a method: ate, rpe, aie, mesh, cpu, tracked, ..., or "
          "the name of a metric that ranks")
      ->type_name("METRIC")
      ->excludes("--paper")
      ->excludes("--systems");
  verb->add_option("--metrics", options->layout.metrics,
                   "LaTeX, table of runs: the numbers that it has, by the names of --pivot or by their keys "
                   "(`fusebench list metrics`)")
      ->type_name("KEY,...")
      ->delimiter(',')
      ->excludes("--paper")
      ->excludes("--systems")
      ->excludes("--pivot");
  verb->add_option(
          "--columns", options->layout.columns,
          "LaTeX: how many columns of a two-column paper the table covers, 1 or 2; it is split where it "
          "is wider")
      ->check(CLI::IsMember({1, 2}))
      ->capture_default_str();
  verb->add_flag("--rotated", options->layout.rotated, "LaTeX: turned, on a page of its own");
  console::add_json_flag(*verb, options->json);
  console::add_width_option(*verb, options->width);
  return {verb, [options] { return table(*options); }};
}

}  // namespace fusebench::cli::results
