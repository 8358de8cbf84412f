#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "eval/cli/console.hpp"
#include "eval/cli/run_request.hpp"
#include "eval/cli/shared_options.hpp"
#include "eval/cli/run_verbs.hpp"
#include "eval/run.hpp"

namespace fusebench {

namespace {

struct RunOptions {
  RunRequest request;
  std::filesystem::path out = "results/runs";
  bool profile = false;
  bool json = false;
};

Result<int> run(const RunOptions& options) {
  auto spec = spec_of(options.request);
  if (!spec) return tl::unexpected(spec.error());
  spec->out = options.out;
  spec->profile = options.profile;
  const auto prepared = prepare_run(std::move(*spec));
  if (!prepared) return tl::unexpected(prepared.error());
  for (const std::string& warning : prepared->recording.warnings)
    print_progress(fmt::format("warning: {}", warning));

  const std::string title = fmt::format("{} {}", prepared->recording.name, options.request.variant);
  ProgressBar bar(title);
  const RunControl control = {
      .progress = [&](std::size_t frame, std::size_t total) { bar.show(frame, total); },
      .stop = &stop_requested(),
      .bad_data_is_recorded = false};
  const auto record = execute_run(*prepared, control);
  bar.clear();
  if (!record) return tl::unexpected(record.error());

  const std::string ending = record->status == RunStatus::ok
                                 ? summary_line(*record)
                                 : fmt::format("{}: {}", to_string(record->status), record->reason);
  print_progress(fmt::format("{}: {}", title, ending));
  print_output(options.json ? to_json(*record) : prepared->folder.string() + "\n");
  return record->status == RunStatus::ok ? 0 : kExitRunFailed;
}

}  // namespace

Verb add_run_verb(CLI::App& app) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* verb =
      app.add_subcommand("run", "Runs one variant over one recording and writes the run's folder");
  add_run_request(*verb, options->request);
  verb->add_option("--out", options->out, "Results go to DIR/<recording>/<variant>/<hash8>/")
      ->type_name("DIR")
      ->capture_default_str();
  add_profile_flag(*verb, options->profile);
  add_json_flag(*verb, options->json);
  verb->footer(
      "Prints the run's folder, or with --json its record. Exit code 4 if the run failed or was lost.");
  return {verb, [options] { return run(*options); }};
}

}  // namespace fusebench
