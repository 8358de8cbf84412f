#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "core/base/parallel.hpp"
#include "eval/cli/console/console.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/running/run_verbs.hpp"
#include "eval/compare/aggregate/long_table.hpp"
#include "eval/text/text_file.hpp"

namespace fusebench::cli::running {

namespace {

struct CollectOptions {
  std::filesystem::path runs;
  std::string format = "csv";
  std::filesystem::path out;
  bool without_timing = false;
  int threads = 1;
};

Result<int> collect(const CollectOptions& options) {
  const auto format = aggregate::parse_long_format(options.format);
  if (!format) return tl::unexpected(format.error());
  const auto rows = aggregate::read_run_rows(options.runs, Workers(options.threads));
  if (!rows) return tl::unexpected(rows.error());
  const std::string table = aggregate::long_table(*rows, {*format, options.without_timing});
  if (options.out.empty()) {
    console::print_output(table);
  } else if (auto written = text::write_text_file(options.out, table); !written) {
    return tl::unexpected(written.error());
  }
  if (const std::size_t damaged = aggregate::unreadable_count(*rows); damaged > 0)
    console::print_progress(
        fmt::format("{} of {} records cannot be read; the table has the reasons", damaged, rows->size()));
  return 0;
}

}  // namespace

console::Verb add_collect_verb(CLI::App& app) {
  auto options = std::make_shared<CollectOptions>();
  CLI::App* verb = app.add_subcommand("collect", "Writes every number of a folder of runs as one long table");
  verb->add_option("RUNS", options->runs, "Folder that holds runs at any depth")->required();
  verb->add_option("--format", options->format, "csv, or jsonl (JSON lines)")
      ->check(CLI::IsMember({"csv", "jsonl"}))
      ->capture_default_str();
  verb->add_option("--out", options->out, "File; default: standard output")->type_name("FILE");
  verb->add_flag("--without-timing", options->without_timing,
                 "Leaves out times and memory, so that two folders compare byte for byte");
  console::add_threads_option(*verb, options->threads);
  return {verb, [options] { return collect(*options); }};
}

}  // namespace fusebench::cli::running
