#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <memory>
#include <utility>

#include "core/base/io/staged_folder.hpp"
#include "core/config/variants.hpp"
#include "eval/cli/console/console.hpp"
#include "eval/cli/console/progress.hpp"
#include "eval/cli/console/run_request.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/recordings/recording_verbs.hpp"
#include "eval/run/batch_estimation/smoothing.hpp"
#include "eval/run/run.hpp"

namespace fusebench::cli::recordings {

namespace {

struct SmoothVerbOptions {
  console::RunRequest request;
  std::filesystem::path out;
  bool json = false;
};

Result<run::PreparedRun> prepare(const SmoothVerbOptions& options) {
  const console::Progress opening("opening " + options.request.recording);
  auto spec = console::spec_of(options.request);
  if (!spec) return tl::unexpected(spec.error());
  if (!config::needs_imu(spec->config.values())) {
    return fail(
        ErrorCode::usage,
        fmt::format("variant '{}' uses no IMU, and the batch estimate needs one", options.request.variant),
        "take --variant full");
  }
  return run::prepare_run(std::move(*spec));
}

Result<void> write_results(const std::filesystem::path& out,
                           const batch_estimation::SmoothedRecording& smoothed, const std::string& json) {
  auto folder = io::StagedFolder::create(out);
  if (!folder) return tl::unexpected(folder.error());
  const std::array<std::pair<std::string_view, std::string>, 3> texts = {
      {{"trajectory.tum", batch_estimation::pseudo_truth_text(smoothed)},
       {"states.csv", batch_estimation::smoothed_states_text(smoothed)},
       {"smoothing.json", json}}};
  for (const auto& [name, text] : texts) {
    if (auto written = folder->write(name, text); !written) return written;
  }
  return folder->commit();
}

Result<int> run(const SmoothVerbOptions& options) {
  const auto prepared = prepare(options);
  if (!prepared) return tl::unexpected(prepared.error());
  const recording::Recording& recording = prepared->recording;
  if (recording.imu_source == recording::ImuSource::synthetic) {
    return fail(
        ErrorCode::usage,
        fmt::format("the IMU of '{}' is made from its ground truth, so the reference would depend on it",
                    recording.name),
        "a reference trajectory needs recorded inertial samples");
  }
  console::print_warnings(recording.warnings);
  console::Progress progress("estimating " + recording.name);
  const run::RunControl control = {
      .progress = [&](std::size_t frame, std::size_t total) { progress.show(frame, total); }};
  const Workers workers(options.request.threads);
  const auto smoothed = batch_estimation::smooth(recording, prepared->spec.config.values(), workers, control);
  if (!smoothed) return tl::unexpected(smoothed.error());
  console::print_warnings(batch_estimation::smoothing_remarks(*smoothed));
  const std::string json = batch_estimation::to_json(*smoothed, recording);
  if (auto written = write_results(options.out, *smoothed, json); !written)
    return tl::unexpected(written.error());
  console::print_output(options.json ? json : options.out.string() + "\n");
  return 0;
}

}  // namespace

console::Verb add_smooth_verb(CLI::App& app) {
  auto options = std::make_shared<SmoothVerbOptions>();
  CLI::App* verb = app.add_subcommand(
      "smooth",
      "Estimates a reference trajectory of a recording without ground truth, by batch optimisation");
  console::add_run_request(*verb, options->request);
  verb->add_option("--out", options->out, "Folder for trajectory.tum, states.csv and smoothing.json")
      ->type_name("DIR")
      ->required();
  console::add_json_flag(*verb, options->json);
  verb->footer(
      "The trajectory is labelled \"pseudo ground truth\", because it is estimated from the same "
      "recording.\nAs groundtruth.txt next to the images it keeps this label.");
  return {verb, [options] { return run(*options); }};
}

}  // namespace fusebench::cli::recordings
