#include "eval/cli/console/run_request.hpp"

#include <CLI/CLI.hpp>
#include <utility>

#include "eval/cli/console/shared_options.hpp"
#include "eval/suites/recording_names.hpp"
#include "eval/suites/suite_file.hpp"

namespace fusebench::cli::console {

void add_run_request(CLI::App& verb, RunRequest& request) {
  verb.add_option("RECORDING", request.recording, "Folder of a recording, or the name of one under --data")
      ->required();
  add_variant_option(verb, request.variant);
  verb.add_option("--imu", request.imu,
                  "Inertial samples of variants with an IMU: recorded, synthetic (made from the ground "
                  "truth, and labelled), or auto (recorded if there are any)")
      ->check(CLI::IsMember({"recorded", "synthetic", "auto"}))
      ->capture_default_str();
  add_set_option(verb, request.sets);
  add_config_option(verb, request.config);
  add_threads_option(verb, request.threads);
  verb.add_option("--frames", request.frames, "Only frames A to B-1; A: takes all from A on")
      ->type_name("A:B");
  add_reading_options(verb, request.reading);
  add_data_option(verb, request.data);
}

Result<run::RunSpec> spec_of(const RunRequest& request) {
  auto config = effective_config(request.variant, request.config, request.sets);
  if (!config) return tl::unexpected(config.error());
  const auto window = parse_frames(request.frames);
  if (!window) return tl::unexpected(window.error());
  const auto imu = suites::parse_imu_choice(request.imu);
  if (!imu) return tl::unexpected(imu.error());
  const auto folder = suites::find_recording(request.recording, request.data);
  if (!folder) return tl::unexpected(folder.error());
  auto open = open_options(request.reading);
  if (!open) return tl::unexpected(open.error());
  run::RunSpec spec;
  spec.recording = *folder;
  spec.open = std::move(*open);
  spec.imu = *imu;
  spec.prepare = request.prepare == "auto";
  spec.variant = request.variant;
  spec.config = std::move(*config);
  spec.frames = *window;
  spec.threads = request.threads;
  return spec;
}

}  // namespace fusebench::cli::console
