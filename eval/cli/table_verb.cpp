#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "eval/cli/console.hpp"
#include "eval/cli/shared_options.hpp"
#include "eval/cli/result_verbs.hpp"
#include "eval/report/paper_table.hpp"
#include "eval/report/table.hpp"

namespace fusebench {

namespace {

struct TableOptions {
  std::filesystem::path runs;
  std::string paper;
  std::string format = "markdown";
  bool json = false;
};

Result<int> table(const TableOptions& options) {
  const auto format = parse_table_format(options.json ? "json" : options.format);
  if (!format) return tl::unexpected(format.error());
  const auto runs = find_runs(options.runs);
  if (options.paper.empty()) {
    if (!runs) return tl::unexpected(runs.error());
    print_output(render_table(table_of(*runs), *format));
    return 0;
  }
  const auto published = published_table(options.paper);
  if (!published) return tl::unexpected(published.error());
  if (!runs) return tl::unexpected(runs.error());
  print_output(render_paper_table(paper_table(*published, *runs), *format));
  return 0;
}

}  // namespace

Verb add_table_verb(CLI::App& app) {
  auto options = std::make_shared<TableOptions>();
  CLI::App* verb = app.add_subcommand("table", "Prints the table of a folder of runs");
  verb->add_option("RUNS", options->runs, "Folder that holds runs at any depth")->required();
  verb->add_option("--format", options->format,
                   "markdown, csv (a line a run), csv-long (a line a number), json or latex")
      ->check(CLI::IsMember({"markdown", "csv", "csv-long", "json", "latex"}))
      ->capture_default_str();
  verb->add_option("--paper", options->paper,
                   "A published table (table1, ate_tum, ate_icl, surface_icl) beside what was run here")
      ->type_name("NAME");
  add_json_flag(*verb, options->json);
  return {verb, [options] { return table(*options); }};
}

}  // namespace fusebench
