#include "datasets/recording/formats/open_loris/open_loris.hpp"

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

#include "core/base/io/input_file.hpp"
#include "datasets/recording/formats/open_loris/transforms.hpp"
#include "datasets/recording/reading/image_list.hpp"
#include "datasets/recording/reading/image_pairs.hpp"
#include "datasets/recording/reading/image_recording.hpp"
#include "datasets/recording/reading/inertial_samples.hpp"
#include "datasets/recording/reading/realsense_imu.hpp"
#include "datasets/recording/reading/sensor_yaml.hpp"
#include "datasets/recording/reading/side_files.hpp"

namespace fusebench::formats::open_loris {

namespace {

constexpr double kUnitsPerMetre = 1000;
constexpr std::string_view kColor = "d400_color_optical_frame";
constexpr std::string_view kBase = "base_link";
constexpr std::string_view kImu = "d400_gyroscope";  // both sensors are in one place

/// The order of the four intrinsics is fx, cx, fy, cy: that of the rows of a camera matrix.
Result<calibration::CalibratedCamera> color_camera(const reading::SensorYaml& yaml) {
  const std::string sensor(kColor);
  const auto k = yaml.numbers(sensor + ".intrinsics.data", 4);
  if (!k) return tl::unexpected(k.error());
  const auto width = yaml.number(sensor + ".width");
  if (!width) return tl::unexpected(width.error());
  const auto height = yaml.number(sensor + ".height");
  if (!height) return tl::unexpected(height.error());
  constexpr double kMostPixels = 16384;
  if (!(*width >= 1 && *width <= kMostPixels && *height >= 1 && *height <= kMostPixels))
    return yaml.fail_at(sensor + ".width", fmt::format("{}x{} pixels (allowed 1x1 .. {}x{})", *width, *height,
                                                       kMostPixels, kMostPixels));
  if (!((*k)[0] > 0 && (*k)[2] > 0))
    return yaml.fail_at(sensor + ".intrinsics.data", "focal lengths must be above 0 (fx, cx, fy, cy)");
  calibration::CalibratedCamera camera;
  camera.pinhole = {static_cast<int>(*width), static_cast<int>(*height), (*k)[0], (*k)[2], (*k)[1], (*k)[3]};
  camera.timing = calibration::kUnknownTiming;
  const auto distortion =
      reading::yaml_distortion(yaml, sensor + ".distortion_model", sensor + ".distortion_coefficients.data");
  if (!distortion) return tl::unexpected(distortion.error());
  camera.distortion = *distortion;
  return camera;
}

Result<calibration::RigCalibration> published_calibration(const std::filesystem::path& folder) {
  const auto yaml = reading::SensorYaml::read(folder / "sensors.yaml");
  if (!yaml) return tl::unexpected(yaml.error());
  const auto color = color_camera(*yaml);
  if (!color) return tl::unexpected(color.error());
  calibration::RigCalibration calibration;
  calibration.color = *color;
  calibration.source = "sensors.yaml and trans_matrix.yaml of the recording";
  if (io::is_named(folder / "trans_matrix.yaml")) {
    const auto frames = read_transforms(folder / "trans_matrix.yaml");
    if (!frames) return tl::unexpected(frames.error());
    if (const auto T_imu_color = frames->transform(kImu, kColor)) {
      calibration.imu = calibration::ImuCalibration{*T_imu_color, reading::realsense_imu_noise()};
      calibration.source += fmt::format("; {}", reading::kRealsenseNoiseSource);
    }
  }
  return calibration;
}

Result<void> read_frames(const std::filesystem::path& folder, const recording::ReadOptions& options,
                         recording::Recording& recording) {
  const auto color = reading::read_image_list(folder / "color.txt", recording.warnings);
  if (!color) return tl::unexpected(color.error());
  const auto depth = reading::read_image_list(folder / "aligned_depth.txt", recording.warnings);
  if (!depth) return tl::unexpected(depth.error());
  return reading::pair_images({"color.txt", *color}, {"aligned_depth.txt", *depth}, options, recording);
}

/// The published poses are the robot's.
Result<void> read_truth(const std::filesystem::path& folder, recording::Recording& recording) {
  if (auto read = reading::read_ground_truth_beside(folder, recording); !read) return read;
  if (recording.ground_truth.empty() || !recording.truth_label.empty()) return {};
  const std::filesystem::path file = folder / "trans_matrix.yaml";
  const auto frames = read_transforms(file);
  if (!frames) return tl::unexpected(frames.error());
  const auto T_base_color = frames->transform(kBase, kColor);
  if (!T_base_color)
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: no chain of transforms from {} to {}", file.string(), kBase, kColor),
                "the published file has them under trans_matrix, with parent_frame, child_frame and matrix");
  for (StampedPose& pose : recording.ground_truth) pose.T_world_camera = pose.T_world_camera * *T_base_color;
  recording.notes.push_back(fmt::format(
      "ground truth: the published poses are of {}; taken to {} by trans_matrix.yaml", kBase, kColor));
  return {};
}

Result<void> read_imu(const std::filesystem::path& folder, recording::Recording& recording) {
  const std::filesystem::path gyroscope = folder / "d400_gyroscope.txt";
  const std::filesystem::path accelerometer = folder / "d400_accelerometer.txt";
  if (!io::is_named(gyroscope) || !io::is_named(accelerometer))
    return reading::read_imu_beside(folder, recording);
  return reading::read_gyroscope_and_accelerometer(gyroscope, accelerometer, recording);
}

}  // namespace

Result<recording::Recording> open_open_loris(const std::filesystem::path& folder,
                                             const recording::ReadOptions& options) {
  recording::Recording recording = recording::named_recording(folder, "openloris");
  if (const auto valid = recording::check_read_options(options); !valid) return tl::unexpected(valid.error());
  auto calibration = recording::choose_calibration(
      folder, options, [&] { return published_calibration(folder); }, recording);
  if (!calibration) return tl::unexpected(calibration.error());
  if (const auto read = read_frames(folder, options, recording); !read) return tl::unexpected(read.error());
  if (const auto read = read_truth(folder, recording); !read) return tl::unexpected(read.error());
  if (const auto read = read_imu(folder, recording); !read) return tl::unexpected(read.error());
  return reading::with_png_images(std::move(recording), std::move(*calibration), kUnitsPerMetre);
}

}  // namespace fusebench::formats::open_loris
