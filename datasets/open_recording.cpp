#include "datasets/open_recording.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/base/nearest_name.hpp"
#include "datasets/formats/eth3d/eth3d_slam.hpp"
#include "datasets/formats/icl/icl_nuim.hpp"
#include "datasets/formats/tum/tum_rgbd.hpp"
#include "datasets/formats/zr300/zr300.hpp"
#include "datasets/reading/side_files.hpp"

namespace fusebench::datasets {

namespace {

/// A row per format; the first that fits a folder is taken. Formats whose folders may also hold TUM's lists
/// come before TUM.
struct RecordingFormat {
  std::string_view name;
  std::vector<std::string_view> files;  ///< that a folder of this format must hold
  Result<recording::Recording> (*open)(const std::filesystem::path& folder,
                                       const recording::ReadOptions& options);
  /// Replaces the list of files where names alone do not tell; the files are then for messages.
  bool (*recognise)(const std::filesystem::path& folder) = nullptr;
};

const std::vector<RecordingFormat>& formats() {
  static const std::vector<RecordingFormat> kFormats = {
      {"eth3d", {"associated.txt", "calibration.txt"}, formats::eth3d::open_eth3d_slam},
      {"icl", {"associations.txt or scene_*.depth"}, formats::icl::open_icl_nuim, formats::icl::is_icl_nuim},
      {"tum", {"rgb.txt", "depth.txt"}, formats::tum::open_tum_rgbd},
      {"zr300", {"TIMESTAMP.txt"}, formats::zr300::open_zr300},
      {"zr300_raw", {"COLOR.txt", "DEPTH.txt"}, formats::zr300::open_zr300_raw},
  };
  return kFormats;
}

bool fits(const RecordingFormat& format, const std::filesystem::path& folder) {
  if (format.recognise != nullptr) return format.recognise(folder);
  return std::ranges::all_of(format.files, [&](std::string_view file) {
    std::error_code ignored;
    return std::filesystem::exists(folder / file, ignored);
  });
}

tl::unexpected<Error> unknown_format(std::string_view name) {
  std::vector<std::string_view> names;
  for (const RecordingFormat& format : formats()) names.push_back(format.name);
  return fail(ErrorCode::configuration, fmt::format("format = {} (allowed {})", name, fmt::join(names, ", ")),
              fmt::format("did you mean {}?", nearest_name(name, names)));
}

tl::unexpected<Error> unrecognised(const std::filesystem::path& folder) {
  std::vector<std::string> wanted;
  for (const RecordingFormat& format : formats()) {
    wanted.push_back(fmt::format("{} (files {})", format.name, fmt::join(format.files, ", ")));
  }
  return fail(ErrorCode::data_missing,
              fmt::format("{}: not a recording of a known format; looked for {}", folder.string(),
                          fmt::join(wanted, "; ")),
              "name the folder that holds these files, or say --format");
}

void note_ground_truth_offset(recording::Recording& recording) {
  const Vector3d offset_m = recording::ground_truth_offset_m(recording);
  if (offset_m.isZero(0)) return;
  recording.notes.push_back(
      fmt::format("camera in the body of the ground truth: ({:.3f}, {:.3f}, {:.3f}) m; a synthetic IMU and "
                  "silent failures take account of it, ATE and RPE do not",
                  offset_m.x(), offset_m.y(), offset_m.z()));
}

}  // namespace

std::optional<std::string_view> recognise_format(const std::filesystem::path& folder) {
  for (const RecordingFormat& format : formats()) {
    if (fits(format, folder)) return format.name;
  }
  return std::nullopt;
}

Result<recording::Recording> open_recording(const std::filesystem::path& folder, const OpenOptions& options) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored)) {
    return fail(ErrorCode::data_missing, fmt::format("{}: no such folder", folder.string()));
  }
  for (const RecordingFormat& format : formats()) {
    if (options.format.empty() ? fits(format, folder) : format.name == options.format) {
      auto recording = format.open(folder, options.read);
      if (!recording) return recording;
      reading::note_simulation(folder, *recording);
      note_ground_truth_offset(*recording);
      if (const auto read = reading::read_exact_truth_beside(folder, *recording); !read) {
        return tl::unexpected(read.error());
      }
      return recording;
    }
  }
  return options.format.empty() ? unrecognised(folder) : unknown_format(options.format);
}

}  // namespace fusebench::datasets
