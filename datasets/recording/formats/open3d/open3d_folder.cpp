#include "datasets/recording/formats/open3d/open3d_folder.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/base/io/input_file.hpp"
#include "core/base/io/stamped_rows.hpp"
#include "datasets/recording/reading/image_recording.hpp"
#include "datasets/recording/reading/json_file.hpp"
#include "datasets/recording/reading/numbered_frames.hpp"
#include "datasets/recording/reading/side_files.hpp"

namespace fusebench::formats::open3d {

namespace {

namespace fs = std::filesystem;

constexpr double kUnitsPerMetre = 1000;
constexpr double kSameScale = 1e-3;
/// What is used, and what does not change how images are read.
constexpr std::array<std::string_view, 15> kRecorderKeys = {
    "width",        "height",       "intrinsic_matrix", "depth_scale",   "fps",
    "color_format", "depth_format", "device_name",      "serial_number", "stream_length_usec",
    "color_mode",   "depth_mode",   "class_name",       "version_major", "version_minor"};
constexpr std::array<std::string_view, 2> kIntrinsics = {"intrinsic.json", "camera_intrinsic.json"};
constexpr std::array<reading::NumberedName, 2> kColor = {{{"", ".jpg"}, {"", ".png"}}};
constexpr std::array<reading::NumberedName, 1> kDepth = {{{"", ".png"}}};

std::optional<fs::path> intrinsics_file(const fs::path& folder) {
  for (const std::string_view name : kIntrinsics) {
    if (io::is_named(folder / name)) return folder / name;
  }
  return std::nullopt;
}

Result<calibration::RigCalibration> published_calibration(const fs::path& folder) {
  const fs::path file = intrinsics_file(folder).value_or(folder / kIntrinsics.front());
  const auto document = reading::read_json(file);
  if (!document) return tl::unexpected(document.error());
  const auto camera = reading::json_camera(*document, {"width", "height", "intrinsic_matrix"}, file);
  if (!camera) return tl::unexpected(camera.error());
  calibration::RigCalibration calibration;
  calibration.color.pinhole = *camera;
  calibration.color.timing = calibration::kUnknownTiming;
  calibration.source = file.filename().string() + " of the recording";
  return calibration;
}

/// Nothing if it is not there.
Result<std::optional<double>> depth_scale(const nlohmann::json& document, const fs::path& file) {
  if (!document.contains("depth_scale")) return std::optional<double>();
  const auto scale = reading::json_number(document, "depth_scale", file);
  if (!scale) return tl::unexpected(scale.error());
  if (calibration::is_units_per_metre(*scale)) return std::optional(*scale);
  return calibration::no_units_per_metre(ErrorCode::data_corrupt,
                                         fmt::format("{}: depth_scale", file.string()), *scale);
}

/// Properties of the recording that its files give beside the camera's matrix.
struct Published {
  double units_per_metre = kUnitsPerMetre;
  std::optional<double> rate_hz;
};

/// The recorder's depth_scale is the sensor's (an L515 has 4000). That of config.json is the reconstruction
/// system's, whose default of 1000 is often copied along with it.
Result<Published> read_published(const fs::path& folder, recording::Recording& recording) {
  std::optional<double> of_recorder;
  Published published;
  if (const auto file = intrinsics_file(folder)) {
    const auto document = reading::read_json(*file);
    if (!document) return tl::unexpected(document.error());
    const auto scale = depth_scale(*document, *file);
    if (!scale) return tl::unexpected(scale.error());
    of_recorder = *scale;
    const auto rate_hz = reading::json_frame_rate(*document, *file, recording.warnings);
    if (!rate_hz) return tl::unexpected(rate_hz.error());
    published.rate_hz = *rate_hz;
    reading::warn_of_unused_keys(*document, kRecorderKeys, *file, recording.warnings);
  }
  std::optional<double> of_config;
  if (const fs::path file = folder / "config.json"; io::is_named(file)) {
    const auto document = reading::read_json(file);
    if (!document) return tl::unexpected(document.error());
    const auto scale = depth_scale(*document, file);
    if (!scale) return tl::unexpected(scale.error());
    of_config = *scale;
  }
  if (of_recorder && of_config && std::abs(*of_recorder / *of_config - 1) > kSameScale)
    recording.warnings.push_back(fmt::format(
        "{}: depth_scale is {} in {} and {} in config.json; the former is used, which the recorder "
        "wrote (--depth-units replaces it)",
        folder.string(), *of_recorder, intrinsics_file(folder)->filename().string(), *of_config));
  published.units_per_metre = of_recorder.value_or(of_config.value_or(kUnitsPerMetre));
  return published;
}

/// frame_times.txt by number.
Result<std::map<std::int64_t, std::int64_t>> read_times(const fs::path& file) {
  std::map<std::int64_t, std::int64_t> time_ns;
  const auto row = [&](const io::TextTable& table) -> Result<void> {
    const auto index = reading::frame_number(table.text(0));
    if (!index)
      return table.fail_here(fmt::format("expected the number of a frame, got '{}'", table.text(0)));
    const auto time = table.time_ns(1);
    if (!time) return tl::unexpected(time.error());
    const auto after = time_ns.upper_bound(*index);
    const bool rises = after == time_ns.end() && (time_ns.empty() || time_ns.rbegin()->second < *time);
    if (!rises || !time_ns.emplace(*index, *time).second)
      return table.fail_here("numbers and times must both rise from row to row");
    return {};
  };
  const auto read = io::for_each_row(file, "frame timestamp", row);
  if (!read) return tl::unexpected(read.error());
  return time_ns;
}

Result<void> add_frames(const fs::path& folder, double rate_hz, recording::Recording& recording) {
  const auto frames = reading::list_numbered({folder / "color", kColor}, {folder / "depth", kDepth},
                                             "color/<k>.jpg (or .png) and depth/<k>.png", recording);
  if (!frames) return tl::unexpected(frames.error());
  const fs::path times = folder / "frame_times.txt";
  if (!io::is_named(times)) {
    reading::add_numbered_frames(*frames, "Open3D's folder has no stamps", rate_hz, recording);
    return {};
  }
  const auto time_ns = read_times(times);
  if (!time_ns) return tl::unexpected(time_ns.error());
  for (const reading::NumberedFrame& frame : *frames) {
    const auto time = time_ns->find(frame.index);
    if (time == time_ns->end())
      return fail(ErrorCode::data_corrupt,
                  fmt::format("{}: has no time of frame {}", times.string(), frame.index));
    recording.frames.push_back(
        {time->second, time->second, time->second, time->second, frame.color_file, frame.depth_file});
  }
  return {};
}

}  // namespace

bool is_open3d(const fs::path& folder) {
  std::error_code ignored;
  return intrinsics_file(folder) && fs::is_directory(folder / "color", ignored) &&
         fs::is_directory(folder / "depth", ignored);
}

Result<recording::Recording> open_open3d(const fs::path& folder, const recording::ReadOptions& options) {
  recording::Recording recording = recording::named_recording(folder, "open3d");
  if (const auto valid = recording::check_read_options(options); !valid) return tl::unexpected(valid.error());
  auto calibration = recording::choose_calibration(
      folder, options, [&] { return published_calibration(folder); }, recording);
  if (!calibration) return tl::unexpected(calibration.error());
  const auto published = read_published(folder, recording);
  if (!published) return tl::unexpected(published.error());
  const double rate_hz = reading::frame_rate_hz(options, published->rate_hz);
  if (const auto added = add_frames(folder, rate_hz, recording); !added) return tl::unexpected(added.error());
  if (const auto read = reading::read_ground_truth_beside(folder, recording); !read)
    return tl::unexpected(read.error());
  if (const auto read = reading::read_imu_beside(folder, recording); !read)
    return tl::unexpected(read.error());
  return reading::with_png_images(std::move(recording), std::move(*calibration), published->units_per_metre);
}

}  // namespace fusebench::formats::open3d
