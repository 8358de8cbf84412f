#include "datasets/formats/tum/tum_rgbd.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/io/input_file.hpp"
#include "datasets/calibration/camera_presets.hpp"
#include "datasets/formats/tum/tum_lists.hpp"
#include "datasets/reading/image_list.hpp"
#include "datasets/reading/image_pairs.hpp"
#include "datasets/reading/image_recording.hpp"
#include "datasets/reading/side_files.hpp"

namespace fusebench::formats::tum {

namespace {

constexpr double kUnitsPerMetre = 5000;  // the images are already scaled by TUM's correction

Result<calibration::RigCalibration> camera_of_folder(const std::string& name) {
  calibration::RigCalibration calibration;
  if (const auto camera = calibration::camera_by_folder_name(name)) {
    calibration.color = *camera;
    return calibration;
  }
  std::vector<std::string_view> presets;
  for (const calibration::CameraPreset& preset : calibration::camera_presets())
    presets.push_back(preset.name);
  return fail(ErrorCode::configuration,
              fmt::format("the folder's name '{}' does not tell which camera recorded it", name),
              fmt::format("choose with --camera {} or --camera fx,fy,cx,cy[,k1,k2,p1,p2,k3], or put a "
                          "calibration.toml into the folder",
                          fmt::join(presets, "|")));
}

Result<void> read_lists(const std::filesystem::path& folder, const recording::ReadOptions& options,
                        recording::Recording& recording) {
  const auto color = reading::read_image_list(folder / "rgb.txt", recording.warnings);
  if (!color) return tl::unexpected(color.error());
  const auto depth = reading::read_image_list(folder / "depth.txt", recording.warnings);
  if (!depth) return tl::unexpected(depth.error());
  return reading::pair_images({"rgb.txt", *color}, {"depth.txt", *depth}, options, recording);
}

Result<void> read_accelerometer(const std::filesystem::path& folder, recording::Recording& recording) {
  const std::filesystem::path file = folder / "accelerometer.txt";
  if (!io::is_named(file)) return {};
  auto samples = read_tum_accelerometer(file, recording.warnings);
  if (!samples) return tl::unexpected(samples.error());
  recording.accelerometer = std::move(*samples);
  return {};
}

}  // namespace

Result<recording::Recording> open_tum_rgbd(const std::filesystem::path& folder,
                                           const recording::ReadOptions& options) {
  recording::Recording recording = recording::named_recording(folder, "tum");
  if (const auto valid = recording::check_read_options(options); !valid) return tl::unexpected(valid.error());
  auto calibration = recording::choose_calibration(
      folder, options, [&] { return camera_of_folder(recording.name); }, recording);
  if (!calibration) return tl::unexpected(calibration.error());
  if (const auto read = read_lists(folder, options, recording); !read) return tl::unexpected(read.error());
  if (const auto read = reading::read_ground_truth_beside(folder, recording); !read)
    return tl::unexpected(read.error());
  if (const auto read = read_accelerometer(folder, recording); !read) return tl::unexpected(read.error());
  if (const auto read = reading::read_imu_beside(folder, recording); !read)
    return tl::unexpected(read.error());
  return reading::with_png_images(std::move(recording), std::move(*calibration), kUnitsPerMetre);
}

}  // namespace fusebench::formats::tum
