#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include "eval/cli/running/entered_invocation.hpp"
#include "eval/cli/running/run_verbs.hpp"
#include "eval/cli/running/suite_run.hpp"
#include "eval/run/run_specification.hpp"

namespace fusebench::cli::running {

namespace {

/// Every invocation that was kept, its failed runs only.
Result<int> rerun(const BenchOptions& options, const std::filesystem::path& runs) {
  std::error_code ignored;
  const auto files = engine::kept_invocations(std::filesystem::absolute(runs, ignored));
  if (!files) return tl::unexpected(files.error());
  int worst = 0;
  for (const std::filesystem::path& file : *files) {
    auto invocation = enter_invocation(file);
    if (!invocation) return tl::unexpected(invocation.error());
    BenchOptions again = options;
    again.invocation = std::move(*invocation);
    again.controls.engine.only_failed = true;
    const auto code = run_suite(std::move(again));
    if (!code) return code;
    worst = std::max(worst, *code);
  }
  return worst;
}

}  // namespace

console::Verb add_rerun_verb(CLI::App& app) {
  struct RerunOptions {
    BenchOptions bench;
    std::filesystem::path runs;
  };
  auto options = std::make_shared<RerunOptions>();
  CLI::App* verb = app.add_subcommand("rerun", "Repeats the failed runs of a folder of runs");
  verb->add_option("RUNS", options->runs, "Folder that `fusebench bench` wrote (its --out)")->required();
  verb->add_option("-j,--jobs", options->bench.controls.engine.at_once, "Runs at a time")
      ->check(CLI::Range(1, run::kMostAtOnce))
      ->type_name("N")
      ->capture_default_str();
  return {.app = verb,
          .run =
              [options] {
                options->bench.controls.threads_given = true;  // the invocation has the number
                return rerun(options->bench, options->runs);
              },
          .forks = true};
}

}  // namespace fusebench::cli::running
