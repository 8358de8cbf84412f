#include "datasets/recording/formats/record3d/record3d_export.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/io/input_file.hpp"
#include "datasets/images/image_files.hpp"
#include "datasets/recording/formats/record3d/record3d_metadata.hpp"
#include "datasets/recording/reading/image_recording.hpp"
#include "datasets/recording/reading/numbered_frames.hpp"
#include "datasets/recording/reading/side_files.hpp"

namespace fusebench::formats::record3d {

namespace {

namespace fs = std::filesystem;

constexpr float kFarthest_m = 1000;
constexpr std::string_view kTruthLabel =
    "pseudo ground truth: ARKit's poses of the same recording, not independent";
constexpr std::array<reading::NumberedName, 2> kColor = {{{"", ".jpg"}, {"", ".png"}}};
constexpr std::array<reading::NumberedName, 1> kDepth = {{{"", ".exr"}}};

/// The folder of metadata.json.
fs::path export_folder(const fs::path& folder) {
  return io::is_named(folder / "EXR_RGBD" / "metadata.json") ? folder / "EXR_RGBD" : folder;
}

calibration::RigCalibration calibration_of(const Record3dMetadata& metadata) {
  calibration::RigCalibration calibration;
  calibration.color.pinhole = metadata.camera;
  calibration.color.timing = calibration::kUnknownTiming;
  calibration.source = "metadata.json of the recording";
  return calibration;
}

/// Depth shows colour's view.
Result<void> add_depth_camera(const std::vector<reading::NumberedFrame>& frames,
                              calibration::RigCalibration& calibration) {
  const auto color = images::read_image_size(frames.front().color_file);
  if (!color) return tl::unexpected(color.error());
  const auto depth = images::read_float(frames.front().depth_file);
  if (!depth) return tl::unexpected(depth.error());
  reading::complete_depth_camera(calibration, *color, {depth->width, depth->height});
  return {};
}

/// Lists of metadata.json are by the number of the frame.
Result<void> add_frames(const std::vector<reading::NumberedFrame>& frames, const Record3dMetadata& metadata,
                        const fs::path& file, const recording::ReadOptions& options,
                        recording::Recording& recording) {
  const auto count = static_cast<std::size_t>(frames.back().index) + 1;
  const auto lacks = [&](const char* key, std::size_t length) {
    return fail(ErrorCode::data_corrupt, fmt::format("{}: {} has {} entries, but there is a frame {}",
                                                     file.string(), key, length, frames.back().index));
  };
  if (metadata.timestamps_ns.empty()) {
    reading::add_numbered_frames(frames, "Record3D's export has no stamps",
                                 reading::frame_rate_hz(options, metadata.fps), recording);
  } else if (metadata.timestamps_ns.size() < count) {
    return lacks("frameTimestamps", metadata.timestamps_ns.size());
  } else {
    for (const reading::NumberedFrame& frame : frames) {
      const std::int64_t t = metadata.timestamps_ns[static_cast<std::size_t>(frame.index)];
      recording.frames.push_back({t, t, t, t, frame.color_file, frame.depth_file});
    }
  }
  if (metadata.T_world_camera.empty()) return {};
  if (metadata.T_world_camera.size() < count) return lacks("poses", metadata.T_world_camera.size());
  Trajectory truth;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    truth.push_back({recording.frames[k].timestamp_ns,
                     metadata.T_world_camera[static_cast<std::size_t>(frames[k].index)]});
  }
  reading::label_truth(kTruthLabel, recording);
  return reading::set_ground_truth(recording, std::move(truth), file);
}

Result<DepthImage> read_depth(const fs::path& file, const images::ImageSize& expected,
                              const std::optional<io::ContentHash>& opened) {
  auto depth_m = images::read_float(file, expected, opened);
  if (!depth_m) return depth_m;
  for (float& z_m : depth_m->data) z_m = z_m > 0 && z_m <= kFarthest_m ? z_m : 0.0F;  // NaN is neither
  return depth_m;
}

}  // namespace

bool is_record3d(const fs::path& folder) {
  const fs::path place = export_folder(folder);
  std::error_code ignored;
  return io::is_named(place / "metadata.json") && fs::is_directory(place / "rgb", ignored) &&
         fs::is_directory(place / "depth", ignored);
}

Result<recording::Recording> open_record3d(const fs::path& folder, const recording::ReadOptions& options) {
  recording::Recording recording = recording::named_recording(folder, "record3d");
  if (const auto valid = recording::check_read_options(options); !valid) return tl::unexpected(valid.error());
  const fs::path place = export_folder(folder);
  const auto metadata = read_record3d_metadata(place / "metadata.json", recording.warnings);
  if (!metadata) return tl::unexpected(metadata.error());
  const auto frames = reading::list_numbered({place / "rgb", kColor}, {place / "depth", kDepth},
                                             "rgb/<k>.jpg (or .png) and depth/<k>.exr", recording);
  if (!frames) return tl::unexpected(frames.error());
  auto calibration = recording::choose_calibration(
      folder, options, [&] { return Result<calibration::RigCalibration>(calibration_of(*metadata)); },
      recording);
  if (!calibration) return tl::unexpected(calibration.error());
  if (const auto added = add_depth_camera(*frames, *calibration); !added)
    return tl::unexpected(added.error());
  if (const auto added = add_frames(*frames, *metadata, place / "metadata.json", options, recording); !added)
    return tl::unexpected(added.error());
  if (recording.ground_truth.empty()) {
    if (const auto read = reading::read_ground_truth_beside(folder, recording); !read)
      return tl::unexpected(read.error());
  }
  if (const auto read = reading::read_imu_beside(folder, recording); !read)
    return tl::unexpected(read.error());
  const auto attached = reading::attach_images(recording, {*calibration, read_depth, "exr metres"});
  if (!attached) return tl::unexpected(attached.error());
  return recording;
}

}  // namespace fusebench::formats::record3d
