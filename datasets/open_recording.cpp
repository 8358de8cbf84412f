#include "datasets/open_recording.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/base/nearest_name.hpp"
#include "datasets/recording/formats/bonn/bonn_rgbd.hpp"
#include "datasets/recording/formats/eth3d/eth3d_slam.hpp"
#include "datasets/recording/formats/euroc/euroc_folder.hpp"
#include "datasets/recording/formats/icl/icl_nuim.hpp"
#include "datasets/recording/formats/open3d/open3d_folder.hpp"
#include "datasets/recording/formats/open_loris/open_loris.hpp"
#include "datasets/recording/formats/record3d/record3d_export.hpp"
#include "datasets/recording/formats/replica/replica_folder.hpp"
#include "datasets/recording/formats/rosbag/rosbag_recording.hpp"
#include "datasets/recording/formats/scannet/scannet_folder.hpp"
#include "datasets/recording/formats/sens/sens_recording.hpp"
#include "datasets/recording/formats/seven_scenes/seven_scenes.hpp"
#include "datasets/recording/formats/stray/stray_scanner.hpp"
#include "datasets/recording/formats/tum/tum_rgbd.hpp"
#include "datasets/recording/formats/zr300/zr300.hpp"
#include "datasets/recording/reading/side_files.hpp"

namespace fusebench::datasets {

namespace {

/// A row per format; the first that fits a folder or file is taken. Formats whose folders may also hold TUM's
/// lists come before TUM.
struct RecordingFormat {
  std::string_view name;
  std::vector<std::string_view> files;  ///< that a folder of this format must hold
  Result<recording::Recording> (*open)(const std::filesystem::path& place,
                                       const recording::ReadOptions& options);
  /// Replaces the list of files where names alone do not tell; the files are then for messages.
  bool (*recognise)(const std::filesystem::path& place) = nullptr;
};

const std::vector<RecordingFormat>& formats() {
  using namespace formats;
  static const std::vector<RecordingFormat> kFormats = {
      {"eth3d", {"associated.txt", "calibration.txt"}, eth3d::open_eth3d_slam},
      {"icl", {"associations.txt or scene_*.depth"}, icl::open_icl_nuim, icl::is_icl_nuim},
      {"bonn", {"rgb.txt", "depth.txt in rgbd_bonn_*"}, bonn::open_bonn_rgbd, bonn::is_bonn},
      {"tum", {"rgb.txt", "depth.txt or associations.txt"}, tum::open_tum_rgbd, tum::is_tum},
      {"openloris", {"color.txt", "aligned_depth.txt", "sensors.yaml"}, open_loris::open_open_loris},
      {"zr300", {"TIMESTAMP.txt"}, zr300::open_zr300},
      {"zr300_raw", {"COLOR.txt", "DEPTH.txt"}, zr300::open_zr300_raw},
      {"7scenes",
       {"frame-*.color.png", "frame-*.depth.png"},
       seven_scenes::open_seven_scenes,
       seven_scenes::is_seven_scenes},
      {"euroc", {"mav0/cam0/data.csv", "mav0/depth0/data.csv"}, euroc::open_euroc, euroc::is_euroc},
      {"sens", {"*.sens"}, sens::open_sens, sens::is_sens},
      {"stray", {"odometry.csv", "camera_matrix.csv"}, stray::open_stray, stray::is_stray},
      {"record3d", {"metadata.json", "rgb/", "depth/"}, record3d::open_record3d, record3d::is_record3d},
      {"open3d", {"intrinsic.json", "color/", "depth/"}, open3d::open_open3d, open3d::is_open3d},
      {"scannet",
       {"intrinsic/intrinsic_depth.txt", "color/", "depth/"},
       scannet::open_scannet,
       scannet::is_scannet},
      {"replica",
       {"results/frame*.jpg", "results/depth*.png", "cam_params.json"},
       replica::open_replica,
       replica::is_replica},
      {"rosbag", {"*.bag"}, rosbag::open_rosbag, rosbag::is_rosbag},
  };
  return kFormats;
}

bool fits(const RecordingFormat& format, const std::filesystem::path& place) {
  if (format.recognise != nullptr) return format.recognise(place);
  return std::ranges::all_of(format.files, [&](std::string_view file) {
    std::error_code ignored;
    return std::filesystem::exists(place / file, ignored);
  });
}

tl::unexpected<Error> unknown_format(std::string_view name) {
  std::vector<std::string_view> names;
  for (const RecordingFormat& format : formats()) names.push_back(format.name);
  return fail(ErrorCode::configuration, fmt::format("format = {} (allowed {})", name, fmt::join(names, ", ")),
              did_you_mean(name, names));
}

/// Files of recorders that another program turns into a folder that is read (docs/datasets.md).
struct PackedRecording {
  std::string_view extension;
  std::string_view what;
  std::string_view remedy;
};
constexpr std::array<PackedRecording, 2> kPacked = {
    {{".mkv", "files of Azure Kinect's recorder (.mkv) are not read",
      "Open3D's azure_kinect_mkv_reader.py exports it as a folder that is"},
     {".r3d", "files of Record3D (.r3d) are packed with LZFSE and are not read",
      "export it from the app as EXR + RGB, a folder that is"}}};

Error unrecognised(const std::filesystem::path& place) {
  const auto packed = std::ranges::find(kPacked, place.extension().string(), &PackedRecording::extension);
  if (packed != kPacked.end()) {
    return {ErrorCode::configuration, fmt::format("{}: {}", place.string(), packed->what),
            std::string(packed->remedy)};
  }
  if (formats::rosbag::is_rosbag2(place)) return formats::rosbag::refusal_of_rosbag2(place);
  std::vector<std::string> known;
  for (const RecordingFormat& format : formats())
    known.push_back(fmt::format("{} (files {})", format.name, fmt::join(format.files, ", ")));
  return {ErrorCode::data_missing,
          fmt::format("{}: not a recording of a supported format; supported are {}", place.string(),
                      fmt::join(known, "; ")),
          "pass the folder that contains these files, or --format; docs/datasets.md describes the formats, "
          "docs/own-camera.md recordings of your own camera"};
}

/// Optional files of a recording are in its folder.
std::filesystem::path folder_of(const std::filesystem::path& place) {
  std::error_code ignored;
  return std::filesystem::is_directory(place, ignored) ? place : place.parent_path();
}

void note_ground_truth_offset(recording::Recording& recording) {
  const Vector3d offset_m = recording::ground_truth_offset_m(recording);
  if (offset_m.isZero(0)) return;
  recording.notes.push_back(
      fmt::format("camera in the motion-capture body: ({:.3f}, {:.3f}, {:.3f}) m; a synthetic IMU and "
                  "undetected failures take account of it, ATE and RPE do not",
                  offset_m.x(), offset_m.y(), offset_m.z()));
}

}  // namespace

std::optional<std::string_view> recognise_format(const std::filesystem::path& place) {
  for (const RecordingFormat& format : formats()) {
    if (fits(format, place)) return format.name;
  }
  return std::nullopt;
}

Result<recording::Recording> open_recording(const std::filesystem::path& place, const OpenOptions& options) {
  std::error_code ignored;
  if (!std::filesystem::exists(place, ignored)) {
    return fail(ErrorCode::data_missing, fmt::format("{}: no such folder or file", place.string()));
  }
  for (const RecordingFormat& format : formats()) {
    if (options.format.empty() ? fits(format, place) : format.name == options.format) {
      auto recording = format.open(place, options.read);
      if (!recording) return recording;
      reading::note_simulation(folder_of(place), *recording);
      note_ground_truth_offset(*recording);
      if (const auto read = reading::read_exact_truth_beside(folder_of(place), *recording); !read) {
        return tl::unexpected(read.error());
      }
      return recording;
    }
  }
  if (!options.format.empty()) return unknown_format(options.format);
  return tl::unexpected(unrecognised(place));
}

}  // namespace fusebench::datasets
