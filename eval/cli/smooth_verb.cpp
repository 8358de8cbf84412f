#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <memory>
#include <utility>

#include "core/staged_folder.hpp"
#include "core/variants.hpp"
#include "eval/cli/console.hpp"
#include "eval/cli/reading_options.hpp"
#include "eval/cli/shared_options.hpp"
#include "eval/cli/verbs.hpp"
#include "eval/experiment.hpp"
#include "eval/run.hpp"
#include "eval/smoothing.hpp"

namespace fusebench {

namespace {

struct SmoothVerbOptions {
  std::string recording;
  std::filesystem::path data;
  std::string variant = "full";
  std::string imu = "recorded";
  ReadingOptions reading;
  std::filesystem::path config;
  std::vector<std::string> sets;
  std::string frames;
  std::filesystem::path out;
  int threads = 1;
  bool json = false;
};

Result<PreparedRun> prepare(const SmoothVerbOptions& options) {
  RunSpec spec;
  auto config = effective_config(options.variant, options.config, options.sets);
  if (!config) return tl::unexpected(config.error());
  if (!needs_imu(config->values)) {
    return fail(ErrorCode::usage,
                fmt::format("variant '{}' uses no IMU, and the batch estimate needs one", options.variant),
                "take --variant full");
  }
  const auto window = parse_frames(options.frames);
  if (!window) return tl::unexpected(window.error());
  const auto imu = parse_imu_choice(options.imu);
  if (!imu) return tl::unexpected(imu.error());
  const auto folder = find_recording(options.recording, options.data);
  if (!folder) return tl::unexpected(folder.error());
  auto open = open_options(options.reading);
  if (!open) return tl::unexpected(open.error());
  spec.recording = *folder;
  spec.open = std::move(*open);
  spec.imu = *imu;
  spec.variant = options.variant;
  spec.config = std::move(*config);
  spec.frames = *window;
  spec.threads = options.threads;
  return prepare_run(std::move(spec));
}

Result<void> write_results(const std::filesystem::path& out, const SmoothedRecording& smoothed,
                           const std::string& json) {
  auto folder = StagedFolder::create(out);
  if (!folder) return tl::unexpected(folder.error());
  const std::array<std::pair<std::string_view, std::string>, 3> texts = {
      {{"trajectory.tum", pseudo_truth_text(smoothed)},
       {"states.csv", smoothed_states_text(smoothed)},
       {"smoothing.json", json}}};
  for (const auto& [name, text] : texts) {
    if (auto written = folder->write(name, text); !written) return written;
  }
  return folder->commit();
}

Result<int> run(const SmoothVerbOptions& options) {
  const auto prepared = prepare(options);
  if (!prepared) return tl::unexpected(prepared.error());
  const Recording& recording = prepared->recording;
  if (recording.imu_source == ImuSource::synthetic) {
    return fail(
        ErrorCode::usage,
        fmt::format("the IMU of '{}' is made from its ground truth, which would become part of the reference",
                    recording.name),
        "a reference trajectory needs recorded inertial samples");
  }
  for (const std::string& warning : recording.warnings) print_progress(fmt::format("warning: {}", warning));
  ProgressBar bar(recording.name + " smooth");
  const RunControl control = {
      .progress = [&](std::size_t frame, std::size_t total) { bar.show(frame, total); },
      .stop = &stop_requested()};
  const Workers workers(options.threads);
  const auto smoothed = smooth(recording, prepared->spec.config.values, workers, control);
  bar.clear();
  if (!smoothed) return tl::unexpected(smoothed.error());
  const std::string json = to_json(*smoothed, recording);
  if (auto written = write_results(options.out, *smoothed, json); !written)
    return tl::unexpected(written.error());
  print_output(options.json ? json : options.out.string() + "\n");
  return 0;
}

}  // namespace

Verb add_smooth_verb(CLI::App& app) {
  auto options = std::make_shared<SmoothVerbOptions>();
  CLI::App* verb = app.add_subcommand(
      "smooth", "A reference trajectory where there is no truth: a batch estimate of the whole recording");
  verb->add_option("RECORDING", options->recording, "Folder of a recording, or the name of one under --data")
      ->required();
  verb->add_option("--out", options->out, "Folder for trajectory.tum, states.csv and smoothing.json")
      ->type_name("DIR")
      ->required();
  add_variant_option(*verb, options->variant);
  verb->add_option("--imu", options->imu, "Inertial samples: recorded, synthetic or auto, as for `run`")
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
      "The trajectory is labelled \"pseudo ground truth\": it comes from the recording that it may be "
      "compared "
      "with.\nAs groundtruth.txt beside the images it keeps that label.");
  return {verb, [options] { return run(*options); }};
}

}  // namespace fusebench
