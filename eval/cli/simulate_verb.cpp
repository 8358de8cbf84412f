#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "datasets/simulator/simulation.hpp"
#include "eval/cli/console.hpp"
#include "eval/cli/shared_options.hpp"
#include "eval/cli/verbs.hpp"
#include "eval/json_text.hpp"

namespace fusebench {

namespace {

struct SimulateOptions {
  std::filesystem::path out;
  std::string preset = "slow";
  std::string layout = "zr300";
  std::uint64_t seed = 1;
  double duration_s = 10;
  double rate_hz = 30;
  std::string size = "640x480";
  bool from_rest = false;
  bool in_motion = false;
  std::filesystem::path trajectory;
  double speed = 1;
  std::filesystem::path scene;
  SceneFileOptions scene_options;
  double exposure_s = 0.008;
  int blur_samples = 8;
  double rolling_shutter_s = 0;
  double time_offset_s = 0;
  bool no_noise = false;
  int threads = 1;
  bool json = false;
};

// The parser has checked the names.
MotionPreset preset_of(const std::string& name) {
  if (name == "fast") return MotionPreset::fast;
  return name == "shake" ? MotionPreset::shake : MotionPreset::slow;
}

RecordingLayout layout_of(const std::string& name) {
  if (name == "tum") return RecordingLayout::tum;
  return name == "icl" ? RecordingLayout::icl : RecordingLayout::zr300;
}

Result<ImageSize> parse_size(const std::string& text) {
  ImageSize size;
  const char* const end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.width_px);
  const bool cross = width.ec == std::errc{} && width.ptr != end && *width.ptr == 'x';
  const auto height = cross ? std::from_chars(width.ptr + 1, end, size.height_px) : width;
  if (!cross || height.ec != std::errc{} || height.ptr != end) {
    return fail(ErrorCode::usage, fmt::format("--size {} (allowed: WIDTHxHEIGHT)", text),
                "e.g. --size 640x480");
  }
  return size;
}

Result<SimulationOptions> simulation_of(const SimulateOptions& chosen) {
  const auto size = parse_size(chosen.size);
  if (!size) return tl::unexpected(size.error());
  auto options = simulation_defaults(layout_of(chosen.layout), preset_of(chosen.preset), *size);
  if (!options) return options;
  options->seed = chosen.seed;
  options->duration_s = chosen.duration_s;
  options->rate_hz = chosen.rate_hz;
  options->scene_file = chosen.scene;
  options->scene = chosen.scene_options;
  // A preset starts from rest unless told otherwise, a trajectory as it begins.
  options->motion.from_rest = !chosen.in_motion;
  options->trajectory_file = chosen.trajectory;
  options->file_motion.speed = chosen.speed;
  options->file_motion.from_rest = chosen.from_rest;
  // In a scene of the user's own, the poses say where the camera is; in the furnished room they cannot.
  options->file_motion.in_place = !chosen.scene.empty();
  options->exposure_s = chosen.exposure_s;
  options->blur_samples = chosen.blur_samples;
  options->rig.color.timing.color_readout_s = chosen.rolling_shutter_s;
  options->imu.time_offset_s = chosen.time_offset_s;
  if (chosen.no_noise) remove_noise(*options);
  return options;
}

std::string json_of(const SimulateOptions& chosen, const SimulationReport& report) {
  using Json = nlohmann::ordered_json;
  Json document{{"recording", chosen.out.string()},
                {"format", chosen.layout},
                {"identity", report.identity},
                {"reused", report.reused}};
  if (!report.reused) {
    document["frames"] = report.frames;
    document["imu_samples"] = report.imu_samples;
    document["peak_speed_mps"] = report.peaks.speed_mps;
    document["peak_rate_radps"] = report.peaks.rate_radps;
    document["trajectory_scale"] = report.trajectory_shrunk;
    document["trajectory_turned_rad"] = report.trajectory_turned_rad;
    document["warnings"] = report.warnings;
  }
  return json_text(document) + "\n";
}

void print_summary(const SimulationReport& report) {
  if (report.reused) {
    print_progress("this recording is there already: left as it is");
    return;
  }
  for (const std::string& warning : report.warnings) print_progress(fmt::format("warning: {}", warning));
  if (report.trajectory_turned_rad != 0) {
    print_progress(fmt::format("the trajectory was moved into the room and turned by {:.0f} degrees",
                               report.trajectory_turned_rad * 180 / std::numbers::pi));
  }
  if (report.trajectory_shrunk < 1) {
    print_progress(
        fmt::format("warning: the trajectory was shrunk to {:.0f} % to stay in the free part of the scene",
                    100 * report.trajectory_shrunk));
  }
  print_progress(fmt::format("{} frames, {} inertial samples, up to {:.2f} m/s and {:.2f} rad/s",
                             report.frames, report.imu_samples, report.peaks.speed_mps,
                             report.peaks.rate_radps));
}

Result<int> simulate_recording(const SimulateOptions& chosen) {
  const auto options = simulation_of(chosen);
  if (!options) return tl::unexpected(options.error());
  const Workers workers(chosen.threads);
  ProgressBar bar("simulating");
  SimulationControl control;
  control.progress = [&](std::size_t done, std::size_t total) { bar.show(done, total); };
  control.stop = &stop_requested();
  const auto report = simulate(*options, chosen.out, workers, control);
  bar.clear();
  if (!report) return tl::unexpected(report.error());
  print_summary(*report);
  print_output(chosen.json ? json_of(chosen, *report) : chosen.out.string() + "\n");
  return 0;
}

void add_motion_options(CLI::App& verb, SimulateOptions& options) {
  verb.add_option("--preset", options.preset,
                  "Hand-held motion: slow (up to 0.4 m/s, 0.6 rad/s), fast (2 m/s, 3 rad/s), shake (1.2 m/s, "
                  "2.5 rad/s, at 2 to 4 Hz)")
      ->check(CLI::IsMember({"slow", "fast", "shake"}))
      ->capture_default_str();
  auto* in_motion = verb.add_flag("--in-motion", options.in_motion,
                                  "The first frame is in full motion; default for --trajectory");
  verb.add_flag("--from-rest", options.from_rest, "Still for 1 s, then a smooth start; default for --preset")
      ->excludes(in_motion);
  auto* trajectory =
      verb.add_option("--trajectory", options.trajectory,
                      "Camera path instead of a preset: TUM text (world z up), or a trajectory of ICL-NUIM")
          ->type_name("FILE");
  verb.add_option("--speed", options.speed, "Drives the path of --trajectory that much faster")
      ->type_name("X")
      ->needs(trajectory)
      ->capture_default_str();
  verb.add_option("--duration", options.duration_s, "Length; 0: all of --trajectory")
      ->type_name("S")
      ->capture_default_str();
}

void add_sensor_options(CLI::App& verb, SimulateOptions& options) {
  verb.add_option("--rate", options.rate_hz, "Images a second (icl: 30, zr300: 4 to 200)")
      ->type_name("HZ")
      ->capture_default_str();
  verb.add_option("--size", options.size, "Pixels of the images")->type_name("WxH")->capture_default_str();
  verb.add_option("--exposure", options.exposure_s, "Exposure time, which blurs motion")
      ->type_name("S")
      ->capture_default_str();
  verb.add_option("--blur-samples", options.blur_samples, "Instants that an exposure is made of")
      ->type_name("N")
      ->capture_default_str();
  verb.add_option("--rolling-shutter", options.rolling_shutter_s,
                  "Time between the first and the last row of colour images")
      ->type_name("S")
      ->capture_default_str();
  verb.add_option("--time-offset", options.time_offset_s,
                  "What the IMU's stamps are ahead of the images'; calibration.toml says it")
      ->type_name("S")
      ->capture_default_str();
  verb.add_flag("--no-noise", options.no_noise,
                "Without noise of images, depth and IMU, biases, vignetting and exposure drift");
}

}  // namespace

Verb add_simulate_verb(CLI::App& app) {
  auto options = std::make_shared<SimulateOptions>();
  CLI::App* verb = app.add_subcommand(
      "simulate", "Makes a recording with exact truth: images, depth, IMU, trajectory, states and mesh");
  verb->add_option("--out", options->out, "Folder of the recording")->type_name("DIR")->required();
  verb->add_option("--format", options->layout,
                   "Layout and sensors: zr300 (as FMDataset), tum (RGB-D) or icl (ICL-NUIM)")
      ->check(CLI::IsMember({"zr300", "tum", "icl"}))
      ->capture_default_str();
  verb->add_option("--seed", options->seed, "Of the room, the motion and all noise")
      ->type_name("N")
      ->capture_default_str();
  add_motion_options(*verb, *options);
  auto* scene = verb->add_option("--scene", options->scene, "PLY or OBJ (z up) instead of the furnished room")
                    ->type_name("FILE");
  verb->add_flag("--scene-y-up", options->scene_options.y_up, "The y axis of --scene points up")
      ->needs(scene);
  verb->add_option("--scene-unit", options->scene_options.metres_per_unit, "Metres that a unit of --scene is")
      ->type_name("M")
      ->needs(scene)
      ->capture_default_str();
  add_sensor_options(*verb, *options);
  add_threads_option(*verb, options->threads);
  add_json_flag(*verb, options->json);
  verb->footer(
      "The same options make the same bytes. A folder that holds this recording already is left as it is; "
      "one that "
      "holds\nanything else is an error. Prints the folder, or with --json what was made.");
  return {verb, [options] { return simulate_recording(*options); }};
}

}  // namespace fusebench
