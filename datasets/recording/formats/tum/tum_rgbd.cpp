#include "datasets/recording/formats/tum/tum_rgbd.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/io/input_file.hpp"
#include "datasets/calibration/camera_presets.hpp"
#include "datasets/recording/formats/tum/tum_lists.hpp"
#include "datasets/recording/reading/associated_row.hpp"
#include "datasets/recording/reading/image_list.hpp"
#include "datasets/recording/reading/image_pairs.hpp"
#include "datasets/recording/reading/image_recording.hpp"
#include "datasets/recording/reading/side_files.hpp"

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

bool has_both_lists(const std::filesystem::path& folder) {
  return io::is_named(folder / "rgb.txt") && io::is_named(folder / "depth.txt");
}

/// The lists of pairs in a folder (associations.txt of ORB-SLAM, output of TUM's associate.py), by name:
/// those whose first row has two images with times. A list with more columns counts where none is plain,
/// since it may have been made from the plain one.
std::vector<std::filesystem::path> lists_of_pairs(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> plain;
  std::vector<std::filesystem::path> wider;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    const bool may_be = name.ends_with(".txt") && (name.find("assoc") != name.npos || name.starts_with("fr"));
    if (!may_be) continue;
    const auto row = reading::first_associated_row(entry.path());
    if (row && io::parse_time_ns(row->color_stamp) && io::parse_time_ns(row->depth_stamp))
      (row->has_more_columns ? wider : plain).push_back(entry.path());
  }
  std::vector<std::filesystem::path> lists = plain.empty() ? std::move(wider) : std::move(plain);
  std::ranges::sort(lists);
  return lists;
}

/// Without rgb.txt or depth.txt. Error data_missing: no list of pairs, or several.
Result<void> read_pairs(const std::filesystem::path& folder, const recording::ReadOptions& options,
                        recording::Recording& recording) {
  std::vector<std::filesystem::path> lists = lists_of_pairs(folder);
  // An error in its first row is named below.
  if (lists.empty() && io::is_named(folder / "associations.txt"))
    lists.push_back(folder / "associations.txt");
  constexpr const char* kNeeded =
      "needed are rgb.txt and depth.txt (\"seconds file\"), or one associations.txt (\"seconds file seconds "
      "file\", colour and depth in a row)";
  if (lists.empty()) {
    const char* const missing = io::is_named(folder / "rgb.txt") ? "depth.txt" : "rgb.txt";
    return fail(ErrorCode::data_missing, fmt::format("{}: no such file", (folder / missing).string()),
                kNeeded);
  }
  if (lists.size() > 1)
    return fail(ErrorCode::data_missing,
                fmt::format("{}: has several lists of pairs ({}, {}) and no rgb.txt and depth.txt",
                            folder.string(), lists[0].filename().string(), lists[1].filename().string()),
                kNeeded);
  if (auto added = reading::add_associated_frames(lists[0], recording); !added) return added;
  const std::string name = lists[0].filename().string();
  reading::make_stamps_regular(name, options, recording);
  recording.notes.push_back(fmt::format("images: pairs as listed in {}", name));
  return {};
}

Result<void> read_lists(const std::filesystem::path& folder, const recording::ReadOptions& options,
                        recording::Recording& recording) {
  if (!has_both_lists(folder)) return read_pairs(folder, options, recording);
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

bool is_tum(const std::filesystem::path& folder) {
  return has_both_lists(folder) || !lists_of_pairs(folder).empty();
}

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
