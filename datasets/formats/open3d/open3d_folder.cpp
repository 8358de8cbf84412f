#include "datasets/formats/open3d/open3d_folder.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/io/input_file.hpp"
#include "core/io/stamped_rows.hpp"
#include "datasets/reading/image_recording.hpp"
#include "datasets/reading/json_file.hpp"
#include "datasets/reading/numbered_frames.hpp"
#include "datasets/reading/side_files.hpp"

namespace fusebench::formats::open3d {

namespace {

namespace fs = std::filesystem;

constexpr double kUnitsPerMetre = 1000;
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

Result<double> published_units(const fs::path& folder) {
  const fs::path file = folder / "config.json";
  if (!io::is_named(file)) return kUnitsPerMetre;
  const auto document = reading::read_json(file);
  if (!document) return tl::unexpected(document.error());
  if (!document->contains("depth_scale")) return kUnitsPerMetre;
  const auto units = reading::json_number(*document, "depth_scale", file);
  if (!units || *units > 0) return units;
  return fail(ErrorCode::data_corrupt,
              fmt::format("{}: depth_scale = {} (allowed: above 0)", file.string(), *units));
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

Result<void> add_frames(const fs::path& folder, const recording::ReadOptions& options,
                        recording::Recording& recording) {
  const auto color = reading::numbered_files(folder / "color", kColor);
  if (!color) return tl::unexpected(color.error());
  const auto depth = reading::numbered_files(folder / "depth", kDepth);
  if (!depth) return tl::unexpected(depth.error());
  const auto frames =
      reading::pair_numbered(*color, *depth, "color/<k>.jpg (or .png) and depth/<k>.png", recording);
  if (!frames) return tl::unexpected(frames.error());
  const fs::path times = folder / "frame_times.txt";
  if (!io::is_named(times)) {
    reading::add_numbered_frames(*frames, "Open3D's folder", options, recording);
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
  const auto units = published_units(folder);
  if (!units) return tl::unexpected(units.error());
  if (const auto added = add_frames(folder, options, recording); !added) return tl::unexpected(added.error());
  if (const auto read = reading::read_ground_truth_beside(folder, recording); !read)
    return tl::unexpected(read.error());
  if (const auto read = reading::read_imu_beside(folder, recording); !read)
    return tl::unexpected(read.error());
  return reading::with_png_images(std::move(recording), std::move(*calibration), *units);
}

}  // namespace fusebench::formats::open3d
