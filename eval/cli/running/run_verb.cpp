#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "eval/cli/console/console.hpp"
#include "eval/cli/console/run_request.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/running/run_verbs.hpp"
#include "eval/run/run.hpp"

namespace fusebench::cli::running {

namespace {

struct RunOptions {
  console::RunRequest request;
  std::filesystem::path out = "results/runs";
  bool profile = false;
  bool json = false;
};

Result<int> run(const RunOptions& options) {
  auto spec = console::spec_of(options.request);
  if (!spec) return tl::unexpected(spec.error());
  spec->out = options.out;
  spec->profile = options.profile;
  const auto prepared = run::prepare_run(std::move(*spec));
  if (!prepared) return tl::unexpected(prepared.error());
  for (const std::string& warning : prepared->recording.warnings)
    console::print_progress(fmt::format("warning: {}", warning));

  const std::string title = fmt::format("{} {}", prepared->recording.name, options.request.variant);
  console::ProgressBar bar(title);
  const run::RunControl control = {
      .progress = [&](std::size_t frame, std::size_t total) { bar.show(frame, total); },
      .stop = &console::stop_requested(),
      .bad_data_is_recorded = false};
  const auto record = run::execute_run(*prepared, control);
  bar.clear();
  if (!record) return tl::unexpected(record.error());

  const std::string ending = record->status == record::RunStatus::ok
                                 ? console::summary_line(*record)
                                 : fmt::format("{}: {}", record::to_string(record->status), record->reason);
  console::print_progress(fmt::format("{}: {}", title, ending));
  console::print_output(options.json ? record::to_json(*record) : prepared->folder.string() + "\n");
  return record->status == record::RunStatus::ok ? 0 : console::kExitRunFailed;
}

}  // namespace

console::Verb add_run_verb(CLI::App& app) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* verb =
      app.add_subcommand("run", "Runs one variant over one recording and writes the run's folder");
  console::add_run_request(*verb, options->request);
  verb->add_option("--out", options->out, "Results go to DIR/<recording>/<variant>/<hash8>/")
      ->type_name("DIR")
      ->capture_default_str();
  console::add_profile_flag(*verb, options->profile);
  console::add_json_flag(*verb, options->json);
  verb->footer(
      "Prints the run's folder, or with --json its record. Exit code 4 if the run failed or was lost.");
  return {verb, [options] { return run(*options); }};
}

}  // namespace fusebench::cli::running
