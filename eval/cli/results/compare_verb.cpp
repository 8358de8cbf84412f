#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/nearest_name.hpp"
#include "core/config/config_access.hpp"
#include "eval/cli/console/console.hpp"
#include "eval/cli/console/progress.hpp"
#include "eval/cli/console/table_width.hpp"
#include "eval/cli/results/result_verbs.hpp"
#include "eval/compare/comparison.hpp"
#include "eval/compare/comparison_formats.hpp"
#include "eval/compare/gates.hpp"
#include "eval/record/run_files/found_runs.hpp"
#include "eval/text/text_file.hpp"

namespace fusebench::cli::results {

namespace {

constexpr int kExitGateFailed = 1;

struct CompareOptions {
  std::filesystem::path base;
  std::filesystem::path fresh;
  std::filesystem::path gates;
  std::filesystem::path confirm;
  std::filesystem::path out;
  compare::IgnoredOptions ignored;
  std::string format = "table";
  bool all = false;
  std::optional<std::size_t> width;
};

/// A beginning without its dot is the usual mistake.
Result<void> check_ignored(const compare::IgnoredOptions& ignored) {
  std::vector<std::string> keys;
  for (const config::OptionRow& row : config::describe_options(config::EffectiveConfig{}.values()))
    keys.push_back(row.key);
  for (const std::string& name : ignored) {
    if (std::ranges::any_of(keys, [&](const std::string& key) { return compare::is_ignored({name}, key); }))
      continue;
    const bool is_group =
        std::ranges::any_of(keys, [&](const std::string& key) { return key.starts_with(name + "."); });
    return fail(ErrorCode::usage,
                fmt::format("--ignore-options {}: no option{}", name, nearest_hint(name, keys)),
                is_group ? fmt::format("all options of the group: --ignore-options {}.", name)
                         : "`fusebench list options` names them");
  }
  return {};
}

Result<int> compare(const CompareOptions& options) {
  const auto format = compare::parse_comparison_format(options.format);
  if (!format) return tl::unexpected(format.error());
  const auto gates =
      options.gates.empty() ? Result<compare::Gates>(compare::Gates()) : compare::read_gates(options.gates);
  if (!gates) return tl::unexpected(gates.error());
  if (auto known = check_ignored(options.ignored); !known) return tl::unexpected(known.error());
  console::Progress progress(fmt::format("reading {}", options.base.string()));
  auto base = run_files::find_runs(options.base);
  if (!base) return tl::unexpected(base.error());
  progress.say(fmt::format("reading {}", options.fresh.string()));
  auto fresh = run_files::find_runs(options.fresh);
  if (!fresh) return tl::unexpected(fresh.error());
  const auto confirming = options.confirm.empty() ? Result<std::vector<run_files::FoundRun>>()
                                                  : run_files::find_runs(options.confirm);
  if (!confirming) return tl::unexpected(confirming.error());
  progress.say("comparing runs");
  const auto comparison =
      compare::compare_runs(std::move(*base), std::move(*fresh), *gates, *confirming, options.ignored);
  if (!comparison) return tl::unexpected(comparison.error());
  // A file is no terminal, whatever standard output is.
  const std::size_t width =
      options.out.empty() ? console::table_width(options.width) : options.width.value_or(0);
  const std::string text = compare::render_comparison(*comparison, *format, options.all, width);
  if (options.out.empty()) {
    console::print_output(text);
  } else {
    if (auto written = text::write_text_file(options.out, text); !written)
      return tl::unexpected(written.error());
    console::print_progress(compare::comparison_summary(*comparison));
  }
  return comparison->passed() ? 0 : kExitGateFailed;
}

}  // namespace

console::Verb add_compare_verb(CLI::App& app) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* verb = app.add_subcommand("compare",
                                      "Compares two folders of runs and fails on a regression. Exit code: 0 "
                                      "all gates passed, 1 one failed, 2 "
                                      "usage or gates, 3 data missing or damaged");
  verb->add_option("BASE", options->base, "Folder of runs that is the baseline")->required();
  verb->add_option("NEW", options->fresh, "Folder of runs that is compared with it")->required();
  verb->add_option("--gates", options->gates,
                   "Gates: which metrics may change, and by how much [as in configs/gates.toml]")
      ->type_name("FILE.toml");
  verb->add_option("--confirm", options->confirm,
                   "Repeated runs of NEW: times and memory fail their gates only if these confirm it")
      ->type_name("DIR");
  verb->add_option("--ignore-options", options->ignored,
                   "Compares runs that differ in this option, or in all options whose keys start with KEY "
                   "(patches.); repeatable")
      ->allow_extra_args(false)
      ->type_name("KEY");
  verb->add_option(
          "--format", options->format,
          "table, markdown, json, junit (a test case a gate), and the numbers of NEW as gbench (Google "
          "Benchmark), github-benchmark (customSmallerIsBetter) or openmetrics")
      ->check(
          CLI::IsMember({"table", "markdown", "json", "junit", "gbench", "github-benchmark", "openmetrics"}))
      ->capture_default_str();
  verb->add_option("--out", options->out, "Writes to FILE instead of standard output")->type_name("FILE");
  verb->add_flag("--all", options->all, "Also shows gates without a change (table and markdown)");
  console::add_width_option(*verb, options->width);
  return {verb, [options] { return compare(*options); }};
}

}  // namespace fusebench::cli::results
