#include "datasets/recording/formats/seven_scenes/seven_scenes.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/io/input_file.hpp"
#include "datasets/calibration/recording_catalogue.hpp"
#include "datasets/recording/reading/image_recording.hpp"
#include "datasets/recording/reading/numbered_frames.hpp"
#include "datasets/recording/reading/side_files.hpp"
#include "datasets/recording/reading/text_matrix.hpp"

namespace fusebench::formats::seven_scenes {

namespace {

constexpr double kUnitsPerMetre = 1000;
constexpr std::array<reading::NumberedName, 2> kColor = {
    {{"frame-", ".color.png"}, {"frame-", ".color.jpg"}}};
constexpr std::array<reading::NumberedName, 1> kDepth = {{{"frame-", ".depth.png"}}};
constexpr std::array<reading::NumberedName, 1> kPose = {{{"frame-", ".pose.txt"}}};
constexpr std::string_view kTruthLabel =
    "pseudo ground truth: tracked by KinectFusion in the same depth, not independent";

calibration::RigCalibration published_calibration() {
  auto calibration = calibration::catalogue_calibration("seven_scenes");
  check(calibration.has_value(), "the catalogue holds the calibration of 7-Scenes");
  return *std::move(calibration);
}

Result<calibration::RigCalibration> calibration_of(const std::filesystem::path& folder) {
  calibration::RigCalibration published = published_calibration();
  const std::filesystem::path file = folder / "camera-intrinsics.txt";
  if (!io::is_named(file)) return published;
  const auto camera = reading::read_camera_matrix(file);
  if (!camera) return tl::unexpected(camera.error());
  PinholeCamera without_size = published.depth->pinhole;
  without_size.width_px = without_size.height_px = 0;
  if (*camera == without_size) return published;
  calibration::RigCalibration one_camera;
  one_camera.color.pinhole = *camera;
  one_camera.color.timing = calibration::kUnknownTiming;
  one_camera.source = "camera-intrinsics.txt of the recording: one camera for colour and depth";
  return one_camera;
}

/// Poses are the depth camera's.
Result<void> read_truth(const std::filesystem::path& folder, const calibration::RigCalibration& calibration,
                        const recording::ReadOptions& options, recording::Recording& recording) {
  auto truth = reading::read_depth_camera_poses({folder, kPose}, calibration, reading::frame_rate_hz(options),
                                                recording);
  if (!truth) return tl::unexpected(truth.error());
  if (truth->empty()) return reading::read_ground_truth_beside(folder, recording);
  reading::label_truth(kTruthLabel, recording);
  return reading::set_ground_truth(recording, *std::move(truth), folder / "frame-*.pose.txt");
}

}  // namespace

bool is_seven_scenes(const std::filesystem::path& folder) {
  return reading::has_numbered_file(folder, kDepth.front());
}

Result<recording::Recording> open_seven_scenes(const std::filesystem::path& folder,
                                               const recording::ReadOptions& options) {
  recording::Recording recording = recording::named_recording(folder, "7scenes");
  if (const auto valid = recording::check_read_options(options); !valid) return tl::unexpected(valid.error());
  auto calibration = recording::choose_calibration(
      folder, options, [&] { return calibration_of(folder); }, recording);
  if (!calibration) return tl::unexpected(calibration.error());
  const auto frames = reading::list_numbered(
      {folder, kColor}, {folder, kDepth}, "frame-<k>.color.png (or .jpg) and frame-<k>.depth.png", recording);
  if (!frames) return tl::unexpected(frames.error());
  reading::add_numbered_frames(*frames, "7-Scenes has no stamps", reading::frame_rate_hz(options), recording);
  if (const auto read = read_truth(folder, *calibration, options, recording); !read)
    return tl::unexpected(read.error());
  if (const auto read = reading::read_imu_beside(folder, recording); !read)
    return tl::unexpected(read.error());
  return reading::with_png_images(std::move(recording), std::move(*calibration), kUnitsPerMetre);
}

}  // namespace fusebench::formats::seven_scenes
