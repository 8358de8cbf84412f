#include "datasets/recording/formats/icl/icl_povray.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "datasets/recording/formats/icl/icl_conventions.hpp"
#include "datasets/recording/formats/icl/icl_povray_files.hpp"
#include "datasets/recording/reading/image_recording.hpp"
#include "datasets/recording/reading/numbered_frames.hpp"
#include "datasets/recording/reading/side_files.hpp"

namespace fusebench::formats::icl {

namespace {

constexpr double kUnitsPerMetre = 1;
constexpr double kFarAway_m = 50;          // no camera of a room is that far from its origin
constexpr double kFocalTolerance = 0.002;  // the files have six digits, the published K has five

/// The frame that a file belongs to, by its name: scene_<digits>_<index>.
std::optional<std::int64_t> index_of(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  const std::size_t last = stem.rfind('_');
  if (!stem.starts_with("scene_") || last <= 5) return std::nullopt;
  const std::string_view text = stem;
  if (!reading::frame_number(text.substr(6, last - 6))) return std::nullopt;
  return reading::frame_number(text.substr(last + 1));
}

/// By kind of file and index. Two scenes in one folder would repeat indices, which is an error.
struct SceneFiles {
  reading::NumberedFiles color;
  reading::NumberedFiles depth;
  reading::NumberedFiles camera;
};

Result<SceneFiles> list_files(const std::filesystem::path& folder) {
  SceneFiles files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const auto index = index_of(entry.path());
    if (!index) continue;
    const std::string extension = entry.path().extension().string();
    auto* list = extension == ".png"     ? &files.color
                 : extension == ".depth" ? &files.depth
                 : extension == ".txt"   ? &files.camera
                                         : nullptr;
    if (list == nullptr || list->emplace(*index, entry.path()).second) continue;
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: two {} files of frame {}", folder.string(), extension, *index),
                "a folder holds one scene");
  }
  return files;
}

/// Warns if a camera file does not fit the intrinsics in use, or if its unit seems wrong.
void compare(const PovrayCamera& camera, const SE3& pose, const PinholeCamera& used,
             recording::Recording& recording) {
  const double fx = camera.direction.norm() / camera.right.norm() * used.width_px;
  const double fy = camera.direction.norm() / camera.up.norm() * used.height_px;
  if (used.width_px > 0 &&
      !(std::abs(fx / used.fx_px - 1) < kFocalTolerance && std::abs(fy / used.fy_px - 1) < kFocalTolerance)) {
    recording.warnings.push_back(
        fmt::format("{}: the camera files give focal lengths of {:.1f} and {:.1f} px, but {} and {} are used",
                    recording.name, fx, fy, used.fx_px, used.fy_px));
  }
  if (pose.translation.norm() > kFarAway_m) {
    recording.warnings.push_back(fmt::format(
        "{}: the first camera is {:.0f} m from the scene's origin; for a scene in centimetres, as that "
        "of Handa et al. 2012, --depth-units (units_per_metre in [depth] of calibration.toml) is 100",
        recording.name, pose.translation.norm()));
  }
}

Result<void> read_truth(const SceneFiles& files, const calibration::RigCalibration& calibration,
                        const recording::ReadOptions& options, recording::Recording& recording) {
  const double units = calibration.depth_units_per_metre.value_or(kUnitsPerMetre);
  Trajectory truth;
  for (const auto& [index, file] : files.camera) {
    const auto camera = read_povray_camera(file);
    if (!camera) return tl::unexpected(camera.error());
    const SE3 pose = pose_of(*camera, units);
    if (truth.empty()) compare(*camera, pose, calibration.color.pinhole, recording);
    truth.push_back({reading::frame_time_ns(index, reading::frame_rate_hz(options)), pose});
  }
  if (truth.empty()) return {};
  return reading::set_ground_truth(recording, std::move(truth),
                                   files.camera.begin()->second.parent_path() / "scene_*.txt");
}

reading::DepthReader ray_depth(PinholeCamera camera, double units_per_metre) {
  return [camera, units_per_metre](const std::filesystem::path& file, const images::ImageSize& expected,
                                   const std::optional<io::ContentHash>& opened) {
    PinholeCamera sized = camera;
    sized.width_px = expected.width_px;
    sized.height_px = expected.height_px;
    return read_povray_depth(file, sized, units_per_metre, opened);
  };
}

}  // namespace

bool is_icl_povray(const std::filesystem::path& folder) {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".depth" && index_of(entry.path())) return true;
  }
  return false;
}

Result<recording::Recording> open_icl_povray(const std::filesystem::path& folder,
                                             const recording::ReadOptions& options) {
  recording::Recording recording = recording::named_recording(folder, "icl");
  if (const auto valid = recording::check_read_options(options); !valid) return tl::unexpected(valid.error());
  auto calibration = recording::choose_calibration(
      folder, options, [] { return Result<calibration::RigCalibration>(icl_calibration()); }, recording);
  if (!calibration) return tl::unexpected(calibration.error());
  const auto files = list_files(folder);
  if (!files) return tl::unexpected(files.error());
  const auto frames =
      reading::pair_numbered(files->color, files->depth, "scene_<nn>_<k>.png and .depth", recording);
  if (!frames) return tl::unexpected(frames.error());
  reading::add_numbered_frames(*frames, "ICL-NUIM has no stamps", reading::frame_rate_hz(options), recording);
  if (const auto read = read_truth(*files, *calibration, options, recording); !read)
    return tl::unexpected(read.error());
  if (const auto read = reading::read_imu_beside(folder, recording); !read)
    return tl::unexpected(read.error());
  const double units = reading::settled_depth_units(*calibration, kUnitsPerMetre);
  const auto reader =
      ray_depth(calibration->depth ? calibration->depth->pinhole : calibration->color.pinhole, units);
  const auto attached = reading::attach_images(
      recording, {std::move(*calibration), reader, fmt::format("ray length {}", units)});
  if (!attached) return tl::unexpected(attached.error());
  return recording;
}

}  // namespace fusebench::formats::icl
