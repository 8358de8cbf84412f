// fusebench_peers: what a frame costs our pipeline, and what it costs programs that others have written.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <utility>

#include "core/config/config.hpp"
#include "core/config/variants.hpp"
#include "eval/record/build_info.hpp"
#include "eval/record/process_meter.hpp"
#include "eval/run/run.hpp"
#include "eval/text/text_file.hpp"
#include "tests/bench/peers/contest.hpp"
#include "tests/bench/peers/open3d_fusions.hpp"
#include "tests/bench/peers/opencv_odometries.hpp"
#include "tests/bench/peers/scoreboard.hpp"
#include "tests/bench/peers/single_thread.hpp"

namespace fusebench::peers {

using namespace config;
using namespace recording;
using namespace text;
using namespace record;
using namespace run;

namespace {

/// As typed.
struct Request {
  std::filesystem::path recording;
  std::string frames;
  int repetitions = 3;
  std::string imu = "recorded";
  std::filesystem::path json;
};

void add_options(CLI::App& app, Request& request) {
  app.add_option("RECORDING", request.recording, "Folder of a recording with ground truth")->required();
  app.add_option("--frames", request.frames, "Only frames A to B-1")->type_name("A:B");
  app.add_option("--repetitions", request.repetitions, "How often everyone goes through the recording")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option(
         "--imu", request.imu,
         "Inertial samples: recorded, synthetic (made from the ground truth), or auto (recorded where "
         "there are any)")
      ->check(CLI::IsMember({"recorded", "synthetic", "auto"}))
      ->capture_default_str();
  app.add_option("--json", request.json, "Writes the result, with the time of each frame, to a file as well")
      ->type_name("FILE");
}

ImuChoice imu_choice(const std::string& text) {
  if (text == "synthetic") return ImuChoice::synthetic;
  return text == "auto" ? ImuChoice::automatic : ImuChoice::recorded;
}

/// Ours with a band of one width, as the peers have it; by default it grows with the noise of the depth.
Config comparable_config(const Config& config, FieldSettings& field) {
  Config comparable = config;
  comparable.tsdf.voxel_m = field.voxel_m;
  comparable.tsdf.truncation_m = field.truncation_m;
  comparable.tsdf.truncation_sigmas = 0;
  field.max_depth_m = config.depth.max_m;
  return comparable;
}

Result<Recording> open(const Request& request, const EffectiveConfig& config) {
  RunSpec spec;
  spec.recording = request.recording;
  spec.imu = imu_choice(request.imu);
  spec.variant = "full";
  spec.config = config;
  if (!request.frames.empty()) {
    const auto window = parse_window(request.frames);
    if (!window) return tl::unexpected(window.error());
    spec.frames = *window;
  }
  return open_for_run(spec);
}

ContestConditions conditions_of(const Request& request, const Recording& recording,
                                const ContestSettings& settings) {
  const std::size_t begin = request.frames.empty() ? 0 : parse_window(request.frames)->begin;
  std::string imu(to_string(recording.imu_source));
  if (recording.imu_source == ImuSource::synthetic) imu += ", made from the ground truth";
  return {.recording = recording.name,
          .frames = fmt::format("{} to {}", begin, begin + recording.frames.size() - 1),
          .imu = std::move(imu),
          .imu_note = recording.imu_note,
          .width_px = recording.rig.camera.width_px,
          .height_px = recording.rig.camera.height_px,
          .field = settings.field,
          .repetitions = settings.repetitions,
          .cpu = cpu_model(),
          .build = fmt::format("{}, {}", build_info().compiler, build_info().flags)};
}

Result<void> compare(const Request& request) {
  const int threads_before = threads_of_process();  // some libraries start idle ones when they are loaded
  const SingleThread single_thread;
  const auto variant = find_variant("full");
  if (!variant) return tl::unexpected(variant.error());
  EffectiveConfig effective = variant_config(*variant);
  ContestSettings settings;
  effective.values() = comparable_config(effective.values(), settings.field);
  settings.config = effective;
  settings.threads_before = threads_before;
  settings.repetitions = request.repetitions;
  const auto recording = open(request, effective);
  if (!recording) return tl::unexpected(recording.error());

  std::vector<Peer> peers = opencv_odometries();
  for (Peer& fusion : open3d_fusions()) peers.push_back(std::move(fusion));
  settings.progress = [&](int repetition, std::size_t frame) {
    if ((frame + 1) % 20 == 0) fmt::print(stderr, "repetition {}: frame {}\n", repetition + 1, frame + 1);
  };
  const auto result = hold_contest(*recording, peers, settings);
  if (!result) return tl::unexpected(result.error());
  const ContestConditions conditions = conditions_of(request, *recording, settings);
  fmt::print("{}", scoreboard_text(*result, conditions));
  if (request.json.empty()) return {};
  return write_text_file(request.json, scoreboard_json(*result, conditions));
}

int command_line(int argc, const char* const* argv) {
  CLI::App app{"What a frame costs FuseBench and its peers: CPU time, interleaved, one thread each",
               "fusebench_peers"};
  Request request;
  add_options(app, request);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    app.exit(error);
    return exit_code(ErrorCode::usage);
  }
  const auto done = compare(request);
  if (done) return 0;
  fmt::print(stderr, "error: {}\n", done.error().message);
  if (!done.error().hint.empty()) fmt::print(stderr, "  hint: {}\n", done.error().hint);
  return exit_code(done.error().code);
}

}  // namespace

}  // namespace fusebench::peers

int main(int argc, char** argv) {
  try {
    return fusebench::peers::command_line(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return fusebench::exit_code(fusebench::ErrorCode::internal);
  }
}
