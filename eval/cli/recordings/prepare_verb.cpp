#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "eval/cli/console/console.hpp"
#include "eval/cli/console/progress.hpp"
#include "eval/cli/console/reading_options.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/recordings/calibration_output.hpp"
#include "eval/cli/recordings/recording_verbs.hpp"
#include "eval/run/preparation/preparation_report.hpp"
#include "eval/run/run_specification.hpp"
#include "eval/suites/recording_names.hpp"

namespace fusebench::cli::recordings {

namespace {

struct PrepareVerbOptions {
  std::string recording;
  std::filesystem::path data;
  std::string frames;
  console::ReadingOptions reading;
  int threads = 1;
  std::filesystem::path out;
  bool json = false;
};

Result<recording::Recording> open(const PrepareVerbOptions& options) {
  const auto window = console::parse_frames(options.frames);
  if (!window) return tl::unexpected(window.error());
  const auto folder = suites::find_recording(options.recording, options.data);
  if (!folder) return tl::unexpected(folder.error());
  const auto how = console::open_options(options.reading);
  if (!how) return tl::unexpected(how.error());
  return run::open_window(*folder, *how, *window);
}

Result<int> run(const PrepareVerbOptions& options) {
  console::Progress progress("opening " + options.recording);
  auto recording = open(options);
  if (!recording) return tl::unexpected(recording.error());
  console::print_warnings(recording->warnings);
  const Workers workers(options.threads);
  progress.say("measuring the depth camera, checking the IMU");
  const preparation::SensorCheck sensors = preparation::inspected_sensors(*recording, workers);
  if (sensors.depth_camera) preparation::use_depth_camera(*recording, *sensors.depth_camera);
  progress.say(fmt::format("measuring read-outs and delay of {} frames", recording->frames.size()));
  const auto prepared = preparation::prepare(*recording, workers, nullptr);
  if (!prepared) return tl::unexpected(prepared.error());
  const auto rig = preparation::rig_with_timing(*recording, preparation::timing_after(*prepared));
  if (auto written = write_calibration(options.out, rig); !written) return tl::unexpected(written.error());
  console::print_output(options.json ? preparation::to_json(*prepared, sensors, *recording)
                                     : preparation::to_text(*prepared, sensors, *recording));
  return preparation::refusal(sensors, recording->name) ? exit_code(ErrorCode::data_corrupt) : 0;
}

}  // namespace

console::Verb add_prepare_verb(CLI::App& app) {
  auto options = std::make_shared<PrepareVerbOptions>();
  CLI::App* verb = app.add_subcommand(
      "prepare",
      "Measures from the images the timing that the calibration does not contain "
      "(read-outs of colour and depth, delay of depth) and the depth camera, and checks the IMU");
  verb->add_option("RECORDING", options->recording, "Folder of a recording, or the name of one under --data")
      ->required();
  console::add_threads_option(*verb, options->threads);
  verb->add_option("--frames", options->frames, "Only frames A to B-1; A: takes all from A on")
      ->type_name("A:B");
  console::add_reading_options(*verb, options->reading);
  console::add_data_option(*verb, options->data);
  verb->add_option("--out", options->out,
                   "Writes the calibration of all sensors, for --calibration of other verbs or as the "
                   "recording's calibration.toml")
      ->type_name("FILE.toml");
  console::add_json_flag(*verb, options->json);
  verb->footer(
      "`run` and `bench` do the same before they run (--prepare auto). The timing needs neither IMU nor "
      "ground truth. "
      "How it is measured: docs/calibration.md.");
  return {verb, [options] { return run(*options); }};
}

}  // namespace fusebench::cli::recordings
