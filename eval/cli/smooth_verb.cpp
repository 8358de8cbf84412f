#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <memory>
#include <utility>

#include "core/staged_folder.hpp"
#include "core/variants.hpp"
#include "eval/cli/console.hpp"
#include "eval/cli/run_request.hpp"
#include "eval/cli/shared_options.hpp"
#include "eval/cli/recording_verbs.hpp"
#include "eval/run.hpp"
#include "eval/smoothing.hpp"

namespace fusebench {

namespace {

struct SmoothVerbOptions {
  RunRequest request;
  std::filesystem::path out;
  bool json = false;
};

Result<PreparedRun> prepare(const SmoothVerbOptions& options) {
  auto spec = spec_of(options.request);
  if (!spec) return tl::unexpected(spec.error());
  if (!needs_imu(spec->config.values)) {
    return fail(
        ErrorCode::usage,
        fmt::format("variant '{}' uses no IMU, and the batch estimate needs one", options.request.variant),
        "take --variant full");
  }
  return prepare_run(std::move(*spec));
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
  const Workers workers(options.request.threads);
  const auto smoothed = smooth(recording, prepared->spec.config.values, workers, control);
  bar.clear();
  if (!smoothed) return tl::unexpected(smoothed.error());
  for (const std::string& remark : smoothing_remarks(*smoothed))
    print_progress(fmt::format("warning: {}", remark));
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
  add_run_request(*verb, options->request);
  verb->add_option("--out", options->out, "Folder for trajectory.tum, states.csv and smoothing.json")
      ->type_name("DIR")
      ->required();
  add_json_flag(*verb, options->json);
  verb->footer(
      "The trajectory is labelled \"pseudo ground truth\": it comes from the recording that it may be "
      "compared "
      "with.\nAs groundtruth.txt beside the images it keeps that label.");
  return {verb, [options] { return run(*options); }};
}

}  // namespace fusebench
