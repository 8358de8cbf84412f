#include "datasets/recording/formats/bonn/bonn_rgbd.hpp"

#include <cmath>
#include <string>
#include <system_error>
#include <utility>

#include "datasets/calibration/recording_catalogue.hpp"
#include "datasets/recording/reading/image_list.hpp"
#include "datasets/recording/reading/image_pairs.hpp"
#include "datasets/recording/reading/image_recording.hpp"
#include "datasets/recording/reading/side_files.hpp"

namespace fusebench::formats::bonn {

namespace {

constexpr double kUnitsPerMetre = 5000;

/// The page's matrices. T_m maps the camera's coordinates to the markers', T_ros exchanges axes of worlds.
SE3 T_markers_camera() {
  Matrix3d scaled;
  scaled << 1.0157, 0.1828, -0.2389, 0.0009, -0.8431, -0.6413, -0.3009, 0.6147, -0.8085;
  return {Quaterniond(Matrix3d(scaled / std::cbrt(scaled.determinant()))).normalized(),
          {0.0113, -0.0098, 0.0111}};
}

SE3 T_ros() {
  Matrix3d R;
  R << -1, 0, 0, 0, 0, 1, 0, 1, 0;
  return {Quaterniond(R), Vector3d::Zero()};
}

calibration::RigCalibration published_calibration() {
  auto calibration = calibration::catalogue_calibration("bonn");
  check(calibration.has_value(), "the catalogue holds the calibration of Bonn RGB-D Dynamic");
  return *std::move(calibration);
}

Result<void> read_frames(const std::filesystem::path& folder, const recording::ReadOptions& options,
                         recording::Recording& recording) {
  const auto color = reading::read_image_list(folder / "rgb.txt", recording.warnings);
  if (!color) return tl::unexpected(color.error());
  const auto depth = reading::read_image_list(folder / "depth.txt", recording.warnings);
  if (!depth) return tl::unexpected(depth.error());
  return reading::pair_images({"rgb.txt", *color}, {"depth.txt", *depth}, options, recording);
}

Result<void> read_truth(const std::filesystem::path& folder, recording::Recording& recording) {
  if (auto read = reading::read_ground_truth_beside(folder, recording); !read) return read;
  if (recording.ground_truth.empty() || !recording.truth_label.empty()) return {};
  for (StampedPose& pose : recording.ground_truth) pose.T_world_camera = camera_in_model(pose.T_world_camera);
  recording.notes.emplace_back(
      "ground truth: the published poses are of the markers; taken to the colour camera and to the world of "
      "the published model by the page's matrices");
  return {};
}

}  // namespace

SE3 camera_in_model(const SE3& T_mocap_markers) {
  return T_ros().inverse() * T_mocap_markers * T_ros() * T_markers_camera();
}

bool is_bonn(const std::filesystem::path& folder) {
  const auto is_there = [&](const char* name) {
    std::error_code ignored;
    return std::filesystem::exists(folder / name, ignored);
  };
  return recording::named_recording(folder, "").name.starts_with("rgbd_bonn") && is_there("rgb.txt") &&
         is_there("depth.txt") && !is_there("calibration.toml");
}

Result<recording::Recording> open_bonn_rgbd(const std::filesystem::path& folder,
                                            const recording::ReadOptions& options) {
  recording::Recording recording = recording::named_recording(folder, "bonn");
  if (const auto valid = recording::check_read_options(options); !valid) return tl::unexpected(valid.error());
  auto calibration = recording::choose_calibration(
      folder, options, [] { return Result<calibration::RigCalibration>(published_calibration()); },
      recording);
  if (!calibration) return tl::unexpected(calibration.error());
  if (const auto read = read_frames(folder, options, recording); !read) return tl::unexpected(read.error());
  if (const auto read = read_truth(folder, recording); !read) return tl::unexpected(read.error());
  if (const auto read = reading::read_imu_beside(folder, recording); !read)
    return tl::unexpected(read.error());
  return reading::with_png_images(std::move(recording), std::move(*calibration), kUnitsPerMetre);
}

}  // namespace fusebench::formats::bonn
