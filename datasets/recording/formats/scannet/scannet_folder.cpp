#include "datasets/recording/formats/scannet/scannet_folder.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/io/input_file.hpp"
#include "datasets/images/image_files.hpp"
#include "datasets/recording/reading/image_recording.hpp"
#include "datasets/recording/reading/numbered_frames.hpp"
#include "datasets/recording/reading/side_files.hpp"
#include "datasets/recording/reading/text_matrix.hpp"

namespace fusebench::formats::scannet {

namespace {

namespace fs = std::filesystem;

constexpr double kUnitsPerMetre = 1000;
constexpr double kSameTransform = 1e-9;
constexpr std::array<reading::NumberedName, 2> kColor = {{{"", ".jpg"}, {"", ".png"}}};
constexpr std::array<reading::NumberedName, 1> kDepth = {{{"", ".png"}}};
constexpr std::array<reading::NumberedName, 1> kPose = {{{"", ".txt"}}};
constexpr std::string_view kTruthLabel =
    "pseudo ground truth: BundleFusion's estimate of the same recording, not independent";

/// A file of the folder intrinsic, or of the recording's folder; nothing if there is none.
std::optional<fs::path> sensor_file(const fs::path& folder, const char* name) {
  for (const fs::path& file : {folder / "intrinsic" / name, folder / name}) {
    if (io::is_named(file)) return file;
  }
  return std::nullopt;
}

/// K of a 4x4 matrix, with the size of its images.
Result<PinholeCamera> camera_of(const fs::path& file, const images::ImageSize& size) {
  const auto m = reading::read_matrix(file, 4, 4);
  if (!m) return tl::unexpected(m.error());
  const std::array<double, 9> K = {(*m)[0], (*m)[1], (*m)[2], (*m)[4], (*m)[5],
                                   (*m)[6], (*m)[8], (*m)[9], (*m)[10]};
  auto camera = reading::camera_of_matrix(K, file.string());
  if (!camera) return camera;
  camera->width_px = size.width_px;
  camera->height_px = size.height_px;
  return camera;
}

/// Identity without the file.
Result<SE3> device_from_camera(const fs::path& folder, const char* name) {
  const auto file = sensor_file(folder, name);
  if (!file) return SE3{};
  const auto T = reading::read_pose_matrix(*file);
  if (!T) return tl::unexpected(T.error());
  if (*T) return **T;
  return fail(ErrorCode::data_corrupt, fmt::format("{}: has numbers that are not finite", file->string()));
}

Result<calibration::RigCalibration> published_calibration(const fs::path& folder,
                                                          const reading::NumberedFrame& first) {
  const auto color_size = images::read_image_size(first.color_file);
  if (!color_size) return tl::unexpected(color_size.error());
  const auto depth_image = images::read_depth16(first.depth_file);
  if (!depth_image) return tl::unexpected(depth_image.error());
  const fs::path depth_file =
      sensor_file(folder, "intrinsic_depth.txt").value_or(folder / "intrinsic" / "intrinsic_depth.txt");
  const auto depth = camera_of(depth_file, {depth_image->width, depth_image->height});
  if (!depth) return tl::unexpected(depth.error());
  calibration::RigCalibration calibration;
  calibration.color.timing = calibration::kUnknownTiming;
  calibration.source = "intrinsic_color.txt and intrinsic_depth.txt of the recording";
  const auto color_file = sensor_file(folder, "intrinsic_color.txt");
  if (!color_file) {
    calibration.color.pinhole = *depth;
    calibration.source = "intrinsic_depth.txt of the recording: one camera for colour and depth";
    return calibration;
  }
  const auto color = camera_of(*color_file, *color_size);
  if (!color) return tl::unexpected(color.error());
  calibration.color.pinhole = *color;
  const auto T_device_color = device_from_camera(folder, "extrinsic_color.txt");
  if (!T_device_color) return tl::unexpected(T_device_color.error());
  const auto T_device_depth = device_from_camera(folder, "extrinsic_depth.txt");
  if (!T_device_depth) return tl::unexpected(T_device_depth.error());
  const SE3 T_color_depth = T_device_color->inverse() * *T_device_depth;
  if (*color != *depth || pose_minus(T_color_depth, SE3{}).norm() > kSameTransform)
    calibration.depth = calibration::DepthCamera{*depth, T_color_depth};
  return calibration;
}

/// Poses are the depth camera's, as in the .sens file.
Result<void> read_truth(const fs::path& folder, const calibration::RigCalibration& calibration,
                        double rate_hz, recording::Recording& recording) {
  auto truth = reading::read_depth_camera_poses({folder / "pose", kPose}, calibration, rate_hz, recording);
  if (!truth) return tl::unexpected(truth.error());
  if (truth->empty()) return reading::read_ground_truth_beside(folder, recording);
  reading::label_truth(kTruthLabel, recording);
  return reading::set_ground_truth(recording, *std::move(truth), folder / "pose");
}

}  // namespace

bool is_scannet(const fs::path& folder) {
  std::error_code ignored;
  return sensor_file(folder, "intrinsic_depth.txt") && fs::is_directory(folder / "color", ignored) &&
         fs::is_directory(folder / "depth", ignored);
}

Result<recording::Recording> open_scannet(const fs::path& folder, const recording::ReadOptions& options) {
  recording::Recording recording = recording::named_recording(folder, "scannet");
  if (const auto valid = recording::check_read_options(options); !valid) return tl::unexpected(valid.error());
  const auto frames = reading::list_numbered({folder / "color", kColor}, {folder / "depth", kDepth},
                                             "color/<k>.jpg (or .png) and depth/<k>.png", recording);
  if (!frames) return tl::unexpected(frames.error());
  auto calibration = recording::choose_calibration(
      folder, options, [&] { return published_calibration(folder, frames->front()); }, recording);
  if (!calibration) return tl::unexpected(calibration.error());
  const double rate_hz = reading::frame_rate_hz(options);
  reading::add_numbered_frames(*frames, "ScanNet's export has no stamps", rate_hz, recording);
  if (const auto read = read_truth(folder, *calibration, rate_hz, recording); !read)
    return tl::unexpected(read.error());
  if (const auto read = reading::read_imu_beside(folder, recording); !read)
    return tl::unexpected(read.error());
  return reading::with_png_images(std::move(recording), std::move(*calibration), kUnitsPerMetre);
}

}  // namespace fusebench::formats::scannet
