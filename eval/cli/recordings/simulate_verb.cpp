#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "datasets/simulator/simulation.hpp"
#include "eval/cli/console/console.hpp"
#include "eval/cli/console/progress.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/recordings/recording_verbs.hpp"
#include "eval/suites/simulation_request.hpp"
#include "eval/text/json_text.hpp"

namespace fusebench::cli::recordings {

namespace {

struct SimulateOptions {
  std::filesystem::path out;
  suites::SimulationRequest request;
  std::string preset = "slow";
  std::string layout = "zr300";
  std::string size = "640x480";
  bool from_rest = false;
  bool in_motion = false;
  int threads = 1;
  bool json = false;
};

Result<simulator::SimulationOptions> simulation_of(const SimulateOptions& chosen) {
  suites::SimulationRequest request = chosen.request;
  const auto size = suites::parse_image_size(chosen.size);
  if (!size) {
    return fail(size.error().code, fmt::format("--{}", size.error().message), "e.g. --size 640x480");
  }
  const auto preset = suites::parse_motion_preset(chosen.preset);
  if (!preset) return tl::unexpected(preset.error());
  const auto layout = suites::parse_recording_layout(chosen.layout);
  if (!layout) return tl::unexpected(layout.error());
  request.size = *size;
  request.preset = *preset;
  request.layout = *layout;
  if (chosen.from_rest || chosen.in_motion) request.from_rest = chosen.from_rest;
  return suites::simulation_options(request);
}

std::string json_of(const SimulateOptions& chosen, const simulator::SimulationReport& report) {
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
  return text::json_text(document) + "\n";
}

void print_summary(const simulator::SimulationReport& report) {
  if (report.reused) {
    console::print_progress("this recording exists already and stays unchanged");
    return;
  }
  console::print_warnings(report.warnings);
  if (report.trajectory_turned_rad != 0) {
    console::print_progress(fmt::format("the trajectory was moved into the room and turned by {:.0f} degrees",
                                        report.trajectory_turned_rad * 180 / std::numbers::pi));
  }
  if (report.trajectory_shrunk < 1) {
    console::print_progress(
        fmt::format("warning: the trajectory was shrunk to {:.0f} % to stay in the free part of the scene",
                    100 * report.trajectory_shrunk));
  }
  console::print_progress(fmt::format("{} frames, {} inertial samples, up to {:.2f} m/s and {:.2f} rad/s",
                                      report.frames, report.imu_samples, report.peaks.speed_mps,
                                      report.peaks.rate_radps));
}

Result<int> simulate_recording(const SimulateOptions& chosen) {
  const auto options = simulation_of(chosen);
  if (!options) return tl::unexpected(options.error());
  const Workers workers(chosen.threads);
  console::Progress progress("simulating " + chosen.out.string());
  simulator::SimulationControl control;
  control.progress = [&](std::size_t done, std::size_t total) { progress.show(done, total); };
  const auto report = simulator::simulate(*options, chosen.out, workers, control);
  if (!report) return tl::unexpected(report.error());
  print_summary(*report);
  console::print_output(chosen.json ? json_of(chosen, *report) : chosen.out.string() + "\n");
  return 0;
}

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const simulator::motion::MotionPreset preset : simulator::motion::motion_presets())
    names.emplace_back(simulator::motion::to_string(preset));
  return names;
}

void add_motion_options(CLI::App& verb, SimulateOptions& options) {
  verb.add_option(
          "--preset", options.preset,
          "Hand-held motion: slow (up to 0.4 m/s, 0.6 rad/s), fast (2 m/s, 3 rad/s), shake (1.2 m/s, "
          "2.5 rad/s, at 2 to 4 Hz), sweep (sideways before a cluttered shelf: 2 m/s, 1 rad/s); with "
          "--realistic and 60 s: realistic_scan (0.5 m/s, 0.8 rad/s), realistic_turns (0.8 m/s, quick "
          "turns of up to 7 rad/s), realistic_revisit (0.8 m/s, 1.2 rad/s, back every 20 s); along a "
          "route, up to 0.8 m/s and 1.2 rad/s, with or without --realistic: loop_room (two laps, 33 s), "
          "loop_flat (three rooms and back, 120 s), corridor (25 m out and back, 90 s), shake_revisit "
          "(one place, between views 2 s of 200 to 400 deg/s, 60 s), twin_rooms (two equal rooms, 70 s), "
          "no_loop (nothing twice, 58 s)")
      ->check(CLI::IsMember(preset_names()))
      ->capture_default_str();
  auto* in_motion = verb.add_flag("--in-motion", options.in_motion,
                                  "The first frame is in full motion; default for --trajectory");
  verb.add_flag("--from-rest", options.from_rest, "Still for 1 s, then a smooth start; default for --preset")
      ->excludes(in_motion);
  auto* trajectory =
      verb.add_option("--trajectory", options.request.trajectory,
                      "Camera path instead of a preset: TUM text (z up), or a trajectory of ICL-NUIM")
          ->type_name("FILE");
  verb.add_option("--speed", options.request.speed, "Speeds up the motion of --trajectory by this factor")
      ->type_name("X")
      ->needs(trajectory)
      ->capture_default_str();
  verb.add_option("--skip", options.request.skip_s, "Leaves out this much of --trajectory at its beginning")
      ->type_name("S")
      ->needs(trajectory)
      ->capture_default_str();
  verb.add_option("--duration", options.request.duration_s,
                  "Length; 0: all of --trajectory; default 10, of realistic presets 60, of routes as above")
      ->type_name("S");
}

void add_sensor_options(CLI::App& verb, SimulateOptions& options) {
  verb.add_flag("--realistic", options.request.realistic,
                "Realistic sensors: uncalibrated rolling shutters and depth delay, jitter of stamps, dropped "
                "frames, automatic exposure, a colour filter mosaic, errors of depth and IMU; in an office "
                "if the preset has no scene of its own");
  verb.add_option("--rate", options.request.rate_hz, "Images a second (icl: 30, zr300: 4 to 200)")
      ->type_name("HZ")
      ->capture_default_str();
  verb.add_option("--size", options.size, "Pixels of the images")->type_name("WxH")->capture_default_str();
  verb.add_option("--exposure", options.request.exposure_s,
                  "Exposure time, which blurs motion; default 0.008, with --realistic automatic")
      ->type_name("S");
  verb.add_option("--blur-samples", options.request.blur_samples,
                  "Renderings that an exposure averages; 0: one for each 2 px that the image moves, 8 to 64")
      ->type_name("N")
      ->capture_default_str();
  verb.add_option("--rolling-shutter", options.request.rolling_shutter_s,
                  "Time between the first and the last row of colour images")
      ->type_name("S")
      ->capture_default_str();
  verb.add_option("--time-offset", options.request.time_offset_s,
                  "Lead of the IMU's stamps over the images', as in calibration.toml")
      ->type_name("S")
      ->capture_default_str();
  verb.add_flag("--no-noise", options.request.no_noise,
                "Without noise of images, depth and IMU, biases, vignetting and exposure drift");
}

std::string kinds_of_faults() {
  std::string text;
  for (const simulator::faults::FaultDescription& kind : simulator::faults::fault_kinds()) {
    text += fmt::format("{}{} ({}", text.empty() ? "" : "; ", kind.name, kind.sentence);
    if (!kind.amount.empty()) text += fmt::format("; AMOUNT: {}, else {}", kind.amount, kind.usual);
    text += ")";
  }
  return text;
}

void add_fault_options(CLI::App& verb, SimulateOptions& options) {
  verb.add_option("--fault", options.request.faults,
                  "Fault from BEGIN to END, seconds from the first frame; repeatable: " + kinds_of_faults())
      ->type_name("KIND=BEGIN:END[:AMOUNT]")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  verb.add_option("--calibration-error", options.request.calibration_error,
                  "Error of the camera-IMU extrinsics in calibration.toml, in degrees and centimetres")
      ->type_name("DEG:CM");
  verb.add_option("--untold-time-offset", options.request.untold_time_offset_s,
                  "Additional lead of the IMU's stamps over the images', not in calibration.toml")
      ->type_name("S")
      ->capture_default_str();
}

}  // namespace

console::Verb add_simulate_verb(CLI::App& app) {
  auto options = std::make_shared<SimulateOptions>();
  CLI::App* verb = app.add_subcommand(
      "simulate",
      "Simulates a recording with exact ground truth: images, depth, IMU, trajectory, states and mesh");
  verb->add_option("--out", options->out, "Folder of the recording")->type_name("DIR")->required();
  verb->add_option("--format", options->layout,
                   "Layout and sensors: zr300 (as FMDataset), tum (RGB-D) or icl (ICL-NUIM)")
      ->check(CLI::IsMember({"zr300", "tum", "icl"}))
      ->capture_default_str();
  verb->add_option("--seed", options->request.seed, "Of the room, the motion and all noise")
      ->type_name("N")
      ->capture_default_str();
  add_motion_options(*verb, *options);
  auto* scene =
      verb->add_option("--scene", options->request.scene, "PLY or OBJ (z up) instead of the furnished room")
          ->type_name("FILE");
  verb->add_flag("--scene-y-up", options->request.scene_options.y_up, "The y axis of --scene points up")
      ->needs(scene);
  verb->add_option("--scene-unit", options->request.scene_options.metres_per_unit,
                   "Metres that a unit of --scene is")
      ->type_name("M")
      ->needs(scene)
      ->capture_default_str();
  add_sensor_options(*verb, *options);
  add_fault_options(*verb, *options);
  console::add_threads_option(*verb, options->threads);
  console::add_json_flag(*verb, options->json);
  verb->footer(
      "The same options make the same bytes. A folder that already contains this recording stays "
      "unchanged;\nany other existing folder is an error. Prints the folder, or with --json a summary.");
  return {verb, [options] { return simulate_recording(*options); }};
}

}  // namespace fusebench::cli::recordings
