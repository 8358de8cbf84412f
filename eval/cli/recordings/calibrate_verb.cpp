#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "core/config/config_access.hpp"
#include "core/config/variants.hpp"
#include "datasets/calibration/rig_calibration.hpp"
#include "datasets/open_recording.hpp"
#include "eval/cli/console/console.hpp"
#include "eval/cli/console/number_checks.hpp"
#include "eval/cli/console/progress.hpp"
#include "eval/cli/console/run_request.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/recordings/calibration_output.hpp"
#include "eval/cli/recordings/recording_verbs.hpp"
#include "eval/report/inspection_report/depth_camera_report.hpp"
#include "eval/run/batch_estimation/calibration.hpp"
#include "eval/run/preparation/sensor_check.hpp"
#include "eval/run/run.hpp"

namespace fusebench::cli::recordings {

namespace {

struct CalibrateVerbOptions {
  console::RunRequest request;
  std::filesystem::path out;
  double rotation_prior_deg = 10;
  double translation_prior_cm = 10;
  double offset_prior_ms = 50;
  double scale_prior_percent = 3;
  int rounds = 4;
  bool depth_camera = false;
  bool json = false;
};

/// Of the images alone: no estimator runs, and no IMU is needed.
Result<int> run_depth_camera(const CalibrateVerbOptions& options) {
  const auto spec = console::spec_of(options.request);
  if (!spec) return tl::unexpected(spec.error());
  const auto recording = run::open_window(spec->recording, spec->open, spec->frames);
  if (!recording) return tl::unexpected(recording.error());
  console::print_warnings(recording->warnings);
  const console::Progress progress(
      fmt::format("comparing edges of depth and colour of {} frames", recording->frames.size()));
  const Workers workers(options.request.threads);
  const auto fit = inspection_report::estimate_depth_camera(*recording, workers);
  if (!fit) return tl::unexpected(fit.error());
  if (!options.out.empty()) {
    if (auto told = inspection_report::check_determined(*fit, *recording); !told)
      return tl::unexpected(told.error());
  }
  const auto written =
      write_calibration(options.out, inspection_report::rig_with_depth_camera(*recording, *fit));
  if (!written) return tl::unexpected(written.error());
  console::print_output(options.json ? inspection_report::depth_camera_json(*fit, *recording)
                                     : inspection_report::depth_camera_text(*fit, *recording));
  return 0;
}

/// What is calibrated, and how the estimator runs over it.
struct CalibrateTask {
  config::EffectiveConfig config;
  recording::Recording recording;
};

/// What a run could do without an IMU of its own, a calibration cannot.
tl::unexpected<Error> no_samples(const recording::Recording& recording) {
  return fail(
      ErrorCode::usage,
      fmt::format("a calibration of camera and IMU needs an IMU, and recording '{}' has none",
                  recording.name),
      fmt::format("use a recording with inertial samples (--depth-camera needs none){}",
                  recording.ground_truth.empty() ? ""
                                                 : "; with --imu synthetic and without --out it only prints "
                                                   "a result for samples made from the ground truth"));
}

Result<CalibrateTask> prepare(const CalibrateVerbOptions& options) {
  const console::Progress opening("opening " + options.request.recording);
  auto spec = console::spec_of(options.request);
  if (!spec) return tl::unexpected(spec.error());
  if (!config::needs_imu(spec->config.values())) {
    return fail(ErrorCode::usage,
                fmt::format("variant '{}' uses no IMU, and a calibration needs one", options.request.variant),
                "use --variant full");
  }
  if (auto related = config::check_relations(spec->config.values()); !related)
    return tl::unexpected(related.error());
  auto whole = datasets::open_recording(spec->recording, spec->open);
  if (!whole) return tl::unexpected(whole.error());
  if (spec->imu == run::ImuChoice::recorded && whole->imu_source == recording::ImuSource::none)
    return no_samples(*whole);
  auto view = run::view_for_run(std::move(*whole), *spec);
  if (!view) return tl::unexpected(view.error());
  return CalibrateTask{std::move(spec->config), std::move(*view)};
}

Result<int> run(const CalibrateVerbOptions& options) {
  if (options.depth_camera) return run_depth_camera(options);
  const auto task = prepare(options);
  if (!task) return tl::unexpected(task.error());
  const recording::Recording& recording = task->recording;
  if (recording.imu_source == recording::ImuSource::synthetic && !options.out.empty()) {
    return fail(ErrorCode::usage,
                fmt::format("the IMU of '{}' is made from its ground truth, so a calibration file would not "
                            "describe a sensor",
                            recording.name),
                "a calibration requires recorded inertial samples; without --out the result is only printed");
  }
  console::print_warnings(recording.warnings);
  const Workers workers(options.request.threads);
  console::Progress progress("checking the IMU of " + recording.name);
  if (auto refused = preparation::refusal(preparation::inspected_sensors(recording, workers), recording.name))
    return tl::unexpected(*std::move(refused));
  progress.say("calibrating " + recording.name);
  const run::RunControl control = {
      .progress = [&](std::size_t frame, std::size_t total) { progress.show(frame, total); }};
  const batch_estimation::CalibrationOptions how{.rotation_prior_rad = radians(options.rotation_prior_deg),
                                                 .translation_prior_m = 0.01 * options.translation_prior_cm,
                                                 .time_offset_prior_s = 1e-3 * options.offset_prior_ms,
                                                 .scale_prior = 0.01 * options.scale_prior_percent,
                                                 .max_rounds = options.rounds};
  const auto calibration =
      batch_estimation::calibrate(recording, task->config.values(), how, workers, control);
  if (!calibration) return tl::unexpected(calibration.error());
  const auto done = batch_estimation::check_fit(*calibration, recording).and_then([&] {
    return write_calibration(options.out, batch_estimation::calibrated_rig(recording, *calibration));
  });
  console::print_output(options.json ? batch_estimation::to_json(*calibration, recording)
                                     : batch_estimation::to_text(*calibration, recording));
  if (!done) return tl::unexpected(done.error());
  return 0;
}

}  // namespace

console::Verb add_calibrate_verb(CLI::App& app) {
  auto options = std::make_shared<CalibrateVerbOptions>();
  CLI::App* verb = app.add_subcommand(
      "calibrate",
      "Estimates from a recording the camera-IMU extrinsics, the offset of their clocks, the "
      "scales of the IMU's axes, and read-outs and delay of the images; or its depth camera");
  verb->add_flag("--depth-camera", options->depth_camera,
                 "Estimates focal length, centre and pose of the depth camera instead, from edges in depth "
                 "and colour; requires no IMU");
  console::add_run_request(*verb, options->request);
  verb->add_option("--out", options->out,
                   "Writes the calibration of all sensors, for --calibration of other verbs or as the "
                   "recording's calibration.toml")
      ->type_name("FILE.toml");
  verb->add_option("--rotation-prior", options->rotation_prior_deg,
                   "Standard deviation of the rotation in the recording's calibration, degrees")
      ->check(console::number_range(0.01, 90.0))
      ->type_name("DEG")
      ->capture_default_str();
  verb->add_option("--translation-prior", options->translation_prior_cm,
                   "Standard deviation of the translation, cm")
      ->check(console::number_range(0.01, 1000.0))
      ->type_name("CM")
      ->capture_default_str();
  verb->add_option("--offset-prior", options->offset_prior_ms, "Standard deviation of the clock offset, ms")
      ->check(console::number_range(0.01, 1000.0))
      ->type_name("MS")
      ->capture_default_str();
  verb->add_option("--scale-prior", options->scale_prior_percent,
                   "Standard deviation of the scales of gyroscope and accelerometer per axis, percent; 0 "
                   "keeps them constant")
      ->check(console::number_range(0.0, 20.0))
      ->type_name("PERCENT")
      ->capture_default_str();
  verb->add_option("--rounds", options->rounds,
                   "Largest number of rounds; each starts from the calibration of the round before")
      ->check(CLI::Range(2, 20))
      ->type_name("N")
      ->capture_default_str();
  console::add_json_flag(*verb, options->json);
  verb->footer(
      "Read-outs and delay are estimated if calibration.toml has no value, or a value with an "
      "uncertainty\n(readout_sigma_s, delay_sigma_s); values without one are kept. Recommended motion and "
      "definitions: docs/calibration.md.");
  return {verb, [options] { return run(*options); }};
}

}  // namespace fusebench::cli::recordings
