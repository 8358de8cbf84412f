#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <memory>
#include <utility>

#include "core/variants.hpp"
#include "eval/calibration.hpp"
#include "eval/cli/console.hpp"
#include "eval/cli/reading_options.hpp"
#include "eval/cli/shared_options.hpp"
#include "eval/cli/verbs.hpp"
#include "eval/experiment.hpp"
#include "eval/run.hpp"

namespace fusebench {

namespace {

struct CalibrateVerbOptions {
  std::string recording;
  std::filesystem::path data;
  std::string variant = "full";
  std::string imu = "recorded";
  ReadingOptions reading;
  std::filesystem::path config;
  std::vector<std::string> sets;
  std::string frames;
  std::filesystem::path out;
  double rotation_prior_deg = 10;
  double translation_prior_cm = 10;
  double offset_prior_ms = 50;
  int rounds = 3;
  int threads = 1;
  bool json = false;
};

Result<PreparedRun> prepare(const CalibrateVerbOptions& options) {
  RunSpec spec;
  auto config = effective_config(options.variant, options.config, options.sets);
  if (!config) return tl::unexpected(config.error());
  if (!needs_imu(config->values)) {
    return fail(ErrorCode::usage,
                fmt::format("variant '{}' uses no IMU, and a calibration needs one", options.variant),
                "take --variant full: the IMU only helps to find the poses, which are the images' own");
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

Result<void> write_file(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream)
    return fail(ErrorCode::io, fmt::format("{}: cannot be written", file.string()),
                "choose another place for --out");
  return {};
}

Result<int> run(const CalibrateVerbOptions& options) {
  const auto prepared = prepare(options);
  if (!prepared) return tl::unexpected(prepared.error());
  const Recording& recording = prepared->recording;
  for (const std::string& warning : recording.warnings) print_progress(fmt::format("warning: {}", warning));
  ProgressBar bar(recording.name + " calibrate");
  const RunControl control = {
      .progress = [&](std::size_t frame, std::size_t total) { bar.show(frame, total); },
      .stop = &stop_requested()};
  const CalibrationOptions how{.rotation_prior_rad = radians(options.rotation_prior_deg),
                               .translation_prior_m = 0.01 * options.translation_prior_cm,
                               .time_offset_prior_s = 1e-3 * options.offset_prior_ms,
                               .max_rounds = options.rounds};
  const Workers workers(options.threads);
  const auto calibration = calibrate(recording, prepared->spec.config.values, how, workers, control);
  bar.clear();
  if (!calibration) return tl::unexpected(calibration.error());
  if (!options.out.empty()) {
    const auto written = write_file(options.out, to_toml(calibrated_rig(recording, *calibration)));
    if (!written) return tl::unexpected(written.error());
  }
  print_output(options.json ? to_json(*calibration, recording) : to_text(*calibration, recording));
  return 0;
}

}  // namespace

Verb add_calibrate_verb(CLI::App& app) {
  auto options = std::make_shared<CalibrateVerbOptions>();
  CLI::App* verb = app.add_subcommand(
      "calibrate",
      "Finds from a recording where the camera sits on the IMU and how far their clocks are apart");
  verb->add_option("RECORDING", options->recording, "Folder of a recording, or the name of one under --data")
      ->required();
  verb->add_option("--out", options->out,
                   "Writes the calibration of all sensors, for --calibration of other verbs or as the "
                   "recording's calibration.toml")
      ->type_name("FILE.toml");
  add_variant_option(*verb, options->variant);
  verb->add_option("--imu", options->imu, "Inertial samples: recorded, synthetic or auto, as for `run`")
      ->check(CLI::IsMember({"recorded", "synthetic", "auto"}))
      ->capture_default_str();
  verb->add_option(
          "--rotation-prior", options->rotation_prior_deg,
          "How far off the recording's calibration may be: standard deviation of the rotation, degrees")
      ->check(CLI::Range(0.01, 90.0))
      ->type_name("DEG")
      ->capture_default_str();
  verb->add_option("--translation-prior", options->translation_prior_cm, "The same of the translation, cm")
      ->check(CLI::Range(0.01, 1000.0))
      ->type_name("CM")
      ->capture_default_str();
  verb->add_option("--offset-prior", options->offset_prior_ms, "The same of the clocks' offset, ms")
      ->check(CLI::Range(0.01, 1000.0))
      ->type_name("MS")
      ->capture_default_str();
  verb->add_option("--rounds", options->rounds, "At most so many runs, each from the last one's calibration")
      ->check(CLI::Range(1, 20))
      ->type_name("N")
      ->capture_default_str();
  add_set_option(*verb, options->sets);
  add_config_option(*verb, options->config);
  add_threads_option(*verb, options->threads);
  verb->add_option("--frames", options->frames, "Only frames A to B-1")->type_name("A:B");
  add_reading_options(*verb, options->reading);
  add_data_option(*verb, options->data);
  add_json_flag(*verb, options->json);
  verb->footer("How to move, what the numbers mean and what they do not: docs/calibration.md.");
  return {verb, [options] { return run(*options); }};
}

}  // namespace fusebench
