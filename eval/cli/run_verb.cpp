#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "eval/cli/console.hpp"
#include "eval/cli/reading_options.hpp"
#include "eval/cli/shared_options.hpp"
#include "eval/cli/verbs.hpp"
#include "eval/experiment.hpp"
#include "eval/run.hpp"

namespace fusebench {

namespace {

struct RunOptions {
  std::string recording;
  std::filesystem::path data;
  std::string variant = "full";
  std::filesystem::path out = "results/runs";
  std::string imu = "recorded";
  ReadingOptions reading;
  std::filesystem::path config;
  std::vector<std::string> sets;
  std::string frames;
  int threads = 1;
  bool json = false;
};

Result<RunSpec> spec_of(const RunOptions& options) {
  RunSpec spec;
  auto config = effective_config(options.variant, options.config, options.sets);
  if (!config) return tl::unexpected(config.error());
  const auto window = parse_frames(options.frames);
  if (!window) return tl::unexpected(window.error());
  const auto imu = parse_imu_choice(options.imu);
  if (!imu) return tl::unexpected(imu.error());
  const auto folder = find_recording(options.recording, options.data);
  if (!folder) return tl::unexpected(folder.error());
  auto open = open_options(options.reading);
  if (!open) return tl::unexpected(open.error());
  spec.open = std::move(*open);
  spec.recording = *folder;
  spec.imu = *imu;
  spec.variant = options.variant;
  spec.config = std::move(*config);
  spec.frames = *window;
  spec.threads = options.threads;
  spec.out = options.out;
  return spec;
}

Result<int> run(const RunOptions& options) {
  auto spec = spec_of(options);
  if (!spec) return tl::unexpected(spec.error());
  const auto prepared = prepare_run(std::move(*spec));
  if (!prepared) return tl::unexpected(prepared.error());
  for (const std::string& warning : prepared->recording.warnings)
    print_progress(fmt::format("warning: {}", warning));

  const std::string title = fmt::format("{} {}", prepared->recording.name, options.variant);
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
  verb->add_option("RECORDING", options->recording, "Folder of a recording, or the name of one under --data")
      ->required();
  add_variant_option(*verb, options->variant);
  verb->add_option("--out", options->out, "Results go to DIR/<recording>/<variant>/<hash8>/")
      ->type_name("DIR")
      ->capture_default_str();
  verb->add_option("--imu", options->imu,
                   "Inertial samples for variants that need them: recorded, synthetic (made from the ground "
                   "truth and labelled so), or auto (recorded where there are any)")
      ->check(CLI::IsMember({"recorded", "synthetic", "auto"}))
      ->capture_default_str();
  add_set_option(*verb, options->sets);
  add_config_option(*verb, options->config);
  add_threads_option(*verb, options->threads);
  verb->add_option("--frames", options->frames, "Only frames A to B-1")->type_name("A:B");
  add_reading_options(*verb, options->reading);
  add_data_option(*verb, options->data);
  add_json_flag(*verb, options->json);
  verb->footer(
      "Prints the run's folder, or with --json its record. Exit code 4 if the run failed or was lost.");
  return {verb, [options] { return run(*options); }};
}

}  // namespace fusebench
