#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/base/parallel.hpp"
#include "eval/cli/console/console.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/console/table_width.hpp"
#include "eval/cli/running/run_verbs.hpp"
#include "eval/compare/aggregate/best.hpp"
#include "eval/record/registry/run_metric.hpp"

namespace fusebench::cli::running {

namespace {

struct BestOptions {
  std::filesystem::path runs;
  std::string by = "ate";
  aggregate::BestRequest request;
  std::string format = "markdown";
  bool json = false;
  std::optional<std::size_t> width;
  const CLI::Option* named_format = nullptr;
  int threads = 1;
};

bool has_ranked_row(const aggregate::BestGroup& group) {
  return std::ranges::any_of(group.rows, [](const aggregate::BestRow& row) { return row.rank.has_value(); });
}

Result<int> best(const BestOptions& options) {
  const auto format = aggregate::parse_best_format(options.json ? "json" : options.format);
  if (!format) return tl::unexpected(format.error());
  aggregate::BestRequest request = options.request;
  const auto metric = registry::find_ranking_metric(options.by);
  if (!metric) return tl::unexpected(metric.error());
  request.metric = *metric;
  const auto rows = aggregate::read_run_rows(options.runs, Workers(options.threads));
  if (!rows) return tl::unexpected(rows.error());
  const auto table = aggregate::best_configurations(*rows, request);
  if (!table) return tl::unexpected(table.error());
  if (std::ranges::none_of(table->groups, has_ranked_row))
    return fail(ErrorCode::data_missing, fmt::format("no run has {}", request.metric->key),
                "rank by another number, e.g. --by aie or --by cpu");
  const std::size_t width = console::table_width(options.width, options.named_format->count() > 0);
  console::print_output(aggregate::render_best(*table, *format, width));
  return 0;
}

}  // namespace

console::Verb add_best_verb(CLI::App& app) {
  auto options = std::make_shared<BestOptions>();
  CLI::App* verb = app.add_subcommand("best", "Ranks the configurations in a folder of runs");
  verb->add_option("RUNS", options->runs, "Folder that holds runs at any depth")->required();
  verb->add_option("--by", options->by,
                   "ate, rpe, aie, mesh, cpu, wall, memory, or the name of a metric in `fusebench collect`")
      ->capture_default_str();
  verb->add_option("--group", options->request.group,
                   "none: one ranking over all recordings; or one for each recording, each variant, or each "
                   "value of an option that runs edit")
      ->type_name("none|recording|variant|KEY")
      ->capture_default_str();
  verb->add_option("-n", options->request.most, "Configurations shown of each group; 0: all")
      ->type_name("N")
      ->capture_default_str();
  options->named_format = verb->add_option("--format", options->format, "markdown, csv or json")
                              ->check(CLI::IsMember({"markdown", "csv", "json"}))
                              ->capture_default_str();
  console::add_json_flag(*verb, options->json);
  console::add_width_option(*verb, options->width);
  console::add_threads_option(*verb, options->threads);
  return {verb, [options] { return best(*options); }};
}

}  // namespace fusebench::cli::running
