#include "eval/cli/results/recorded_frames.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "datasets/calibration/camera_presets.hpp"
#include "datasets/open_recording.hpp"
#include "datasets/recording/recording.hpp"
#include "eval/record/record.hpp"
#include "eval/suites/recording_names.hpp"

namespace fusebench::cli::results {

namespace {

/// In the folder of recordings, else where an engine writes simulated ones: in `simulated` next to the runs
/// or above (results/runs/SUITE), or in its usual folder in the working folder.
Result<std::filesystem::path> folder_of(const record::RecordedRecording& recorded,
                                        const std::filesystem::path& data,
                                        const std::filesystem::path& runs) {
  auto given = suites::find_recording(recorded.name, data);
  if (given || recorded.data != "simulated") return given;
  std::error_code ignored;
  const std::filesystem::path root = std::filesystem::weakly_canonical(runs, ignored);
  const std::filesystem::path parent = root.parent_path();
  for (const std::filesystem::path& all_simulated :
       {parent / "simulated", parent.parent_path() / "simulated",
        std::filesystem::absolute("results/simulated", ignored)}) {
    // Runs may lie in a folder of that name themselves.
    if (all_simulated != root && std::filesystem::is_directory(all_simulated / recorded.name, ignored))
      return all_simulated / recorded.name;
  }
  return given;
}

Result<recording::Recording> open_window(const std::filesystem::path& folder,
                                         const record::RecordedRecording& recorded,
                                         const datasets::OpenOptions& options) {
  auto recording = datasets::open_recording(folder, options);
  const std::size_t end = recorded.first_frame + recorded.frames;
  if (recording && end <= recording->frames.size()) {
    if (auto cut = recording::select_frames(*recording, recorded.first_frame, end); !cut)
      return tl::unexpected(cut.error());
  }
  return recording;
}

/// The camera of the run; a record that is older says no more of it than what it contributes to the
/// fingerprint, so it may be a published one.
std::vector<datasets::OpenOptions> cameras_of(const record::RecordedRecording& recorded) {
  std::vector<datasets::OpenOptions> cameras;
  if (recorded.camera) {
    datasets::OpenOptions& options = cameras.emplace_back();
    options.read.camera = recorded.camera->color;
    options.read.depth_units_per_metre = recorded.camera->depth_units_per_metre;
    return cameras;
  }
  for (const calibration::CameraPreset& preset : calibration::camera_presets())
    cameras.emplace_back().read.camera = preset.camera;
  return cameras;
}

/// With its own calibration, else with the camera that the run was given.
Result<recording::Recording> open_as_run(const std::filesystem::path& folder,
                                         const record::RecordedRecording& recorded) {
  auto recording = open_window(folder, recorded, {});
  if (recording && recording->fingerprint == recorded.fingerprint) return recording;
  if (!recording && recording.error().code != ErrorCode::configuration) return recording;
  for (const datasets::OpenOptions& options : cameras_of(recorded)) {
    auto with_camera = open_window(folder, recorded, options);
    if (with_camera && with_camera->fingerprint == recorded.fingerprint) return with_camera;
  }
  if (!recording) {
    return fail(recording.error().code,
                fmt::format("{}, and with {} it is not the recording that was run", recording.error().message,
                            recorded.camera ? "the camera of the run" : "any published camera"),
                "put a calibration.toml with the camera of the run into the folder");
  }
  return fail(ErrorCode::data_missing,
              fmt::format("{} has another content or camera than when it was run", folder.string()),
              "--data names the folder of recordings that has it as it was");
}

Result<std::vector<ColorImage>> read_frames(const std::filesystem::path& folder,
                                            const record::RecordedRecording& recorded,
                                            std::span<const std::size_t> frames) {
  const auto recording = open_as_run(folder, recorded);
  if (!recording) return tl::unexpected(recording.error());
  std::vector<ColorImage> images;
  for (const std::size_t frame : frames) {
    auto loaded = recording->load_frame(frame);
    if (!loaded) return tl::unexpected(loaded.error());
    images.push_back(std::move(loaded->color));
  }
  return images;
}

}  // namespace

report::FrameReader recorded_frames(const std::filesystem::path& data, const std::filesystem::path& runs) {
  return [data, runs](const record::RecordedRecording& recording, std::span<const std::size_t> frames) {
    auto folder = folder_of(recording, data, runs);
    if (!folder && data.empty()) folder.error().hint = "--data FOLDER (the folder of recordings) shows them";
    return folder.and_then(
        [&](const std::filesystem::path& place) { return read_frames(place, recording, frames); });
  };
}

}  // namespace fusebench::cli::results
