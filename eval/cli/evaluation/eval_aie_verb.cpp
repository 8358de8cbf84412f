#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/base/trajectory/trajectory.hpp"
#include "eval/cli/console/console.hpp"
#include "eval/cli/console/progress.hpp"
#include "eval/cli/console/reading_options.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/evaluation/eval_verbs.hpp"
#include "eval/metrics/trajectory_files/trajectory_formats.hpp"
#include "eval/record/pose_intensity/pose_intensity.hpp"
#include "eval/record/record_origin.hpp"
#include "eval/text/json_text.hpp"
#include "eval/text/plain_table.hpp"

namespace fusebench::cli::evaluation {

namespace {

struct AieOptions {
  std::filesystem::path recording;
  std::vector<std::filesystem::path> estimates;
  console::ReadingOptions reading;
  bool truth = false;
  bool true_depth = false;
  bool json = false;
};

Result<std::vector<pose_intensity::NamedTrajectory>> load_all(const AieOptions& options,
                                                              const recording::Recording& recording) {
  std::vector<pose_intensity::NamedTrajectory> trajectories;
  if (options.truth) {
    if (recording.ground_truth.empty())
      return fail(ErrorCode::data_missing, fmt::format("{} has no ground truth", recording.name),
                  "omit --truth");
    // At the instants of the images, under their stamps.
    trajectories.push_back(
        {"ground truth", record::true_trajectory(recording, record::frame_stamps(recording))});
  }
  for (const std::filesystem::path& file : options.estimates) {
    std::vector<std::string> warnings;
    auto loaded = trajectory_files::load_trajectory(file, {}, warnings);
    if (!loaded) return tl::unexpected(loaded.error());
    console::print_warnings(warnings);
    if (!loaded->has_stamps())
      return fail(ErrorCode::usage,
                  fmt::format("{}: poses need stamps, which the format kitti does not have", file.string()),
                  "use TUM or EuRoC files");
    trajectories.push_back({file.string(), std::move(loaded->poses)});
  }
  return trajectories;
}

std::string to_text(const pose_intensity::PoseIntensity& result) {
  std::vector<text::TableCells> lines = {{"trajectory", "AIE of poses", "RMS", "frames with a pose"}};
  for (const pose_intensity::TrajectoryIntensity& row : result.trajectories)
    lines.push_back({row.name, fmt::format("{:.3f}", row.aie_grey), fmt::format("{:.3f}", row.rms_grey),
                     fmt::format("{}/{}", row.frames, result.possible + 1)});
  return text::markdown_table(lines, 1) +
         fmt::format(
             "\ngrey levels; {} of {} pairs of frames, {} pixels, the same of all trajectories; depth: {}; "
             "occluded pixels {}\n",
             result.frames, result.possible, result.pixels, result.depth,
             result.visibility_by_truth ? "left out by the true poses" : "not left out: no true poses");
}

std::string to_json(const pose_intensity::PoseIntensity& result) {
  nlohmann::ordered_json json = {{"metric", "aie_of_poses"},
                                 {"unit", "grey levels 0-255"},
                                 {"frames", result.frames},
                                 {"possible", result.possible},
                                 {"pixels", result.pixels},
                                 {"depth", result.depth},
                                 {"visibility_by_truth", result.visibility_by_truth}};
  for (const pose_intensity::TrajectoryIntensity& row : result.trajectories)
    json["trajectories"].push_back(
        {{"name", row.name}, {"aie", row.aie_grey}, {"rms", row.rms_grey}, {"frames_with_pose", row.frames}});
  return text::json_text(json) + "\n";
}

Result<int> run(const AieOptions& options) {
  const auto open = console::open_options(options.reading);
  if (!open) return tl::unexpected(open.error());
  console::Progress progress("opening " + options.recording.string());
  const auto recording = datasets::open_recording(options.recording, *open);
  if (!recording) return tl::unexpected(recording.error());
  const auto trajectories = load_all(options, *recording);
  if (!trajectories) return tl::unexpected(trajectories.error());
  if (trajectories->empty())
    return fail(ErrorCode::usage, "no trajectory is given", "pass files, or --truth for the recording's own");
  progress.say(fmt::format("comparing the images of {} frames", recording->frames.size()));
  const pose_intensity::ProbeOptions probes{.true_depth = options.true_depth};
  const auto result = pose_intensity::pose_intensity(*recording, *trajectories, probes);
  if (!result) return tl::unexpected(result.error());
  console::print_output(options.json ? to_json(*result) : to_text(*result));
  return 0;
}

}  // namespace

console::Verb add_eval_aie_verb(CLI::App& eval) {
  auto options = std::make_shared<AieOptions>();
  CLI::App* verb = eval.add_subcommand(
      "aie",
      "Intensity error of poses alone: the same probe patches of a recording for trajectories of any system");
  verb->add_option("RECORDING", options->recording, "Folder of the recording")->required();
  verb->add_option("EST", options->estimates, "Trajectories with stamps (TUM, EuRoC), of the colour camera");
  verb->add_flag("--truth", options->truth, "Also evaluates the recording's ground truth, the lower limit");
  verb->add_flag("--true-depth", options->true_depth,
                 "Uses depth of the ground-truth mesh instead of measured depth (simulated recordings)");
  console::add_reading_options(*verb, options->reading);
  console::add_json_flag(*verb, options->json);
  verb->footer(
      "Only pairs of frames count for which all trajectories have both poses. docs/metrics.md defines "
      "the\nnumbers. Exit code 3 for a recording or a trajectory that cannot be used.");
  return {verb, [options] { return run(*options); }};
}

}  // namespace fusebench::cli::evaluation
