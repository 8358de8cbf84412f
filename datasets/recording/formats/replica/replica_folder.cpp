#include "datasets/recording/formats/replica/replica_folder.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/io/input_file.hpp"
#include "core/base/io/stamped_rows.hpp"
#include "datasets/recording/reading/image_recording.hpp"
#include "datasets/recording/reading/json_file.hpp"
#include "datasets/recording/reading/numbered_frames.hpp"
#include "datasets/recording/reading/side_files.hpp"

namespace fusebench::formats::replica {

namespace {

namespace fs = std::filesystem;

constexpr double kUnitsPerMetre = 6553.5;
constexpr double kMostPixels = 16384;
constexpr std::array<reading::NumberedName, 2> kColor = {{{"frame", ".jpg"}, {"frame", ".png"}}};
constexpr std::array<reading::NumberedName, 1> kDepth = {{{"depth", ".png"}}};
constexpr std::array<std::string_view, 7> kKeys = {"w", "h", "fx", "fy", "cx", "cy", "scale"};
constexpr const char* kPoseColumns = "m11 m12 m13 m14 m21 m22 m23 m24 m31 m32 m33 m34 m41 m42 m43 m44";

fs::path camera_file(const fs::path& folder) {
  const fs::path own = folder / "cam_params.json";
  return io::is_named(own) ? own : folder / ".." / "cam_params.json";
}

Result<calibration::RigCalibration> published_calibration(const fs::path& folder,
                                                          recording::Recording& recording) {
  const fs::path file = camera_file(folder);
  const auto document = reading::read_json(file);
  if (!document) return tl::unexpected(document.error());
  const auto camera = document->find("camera");
  if (camera == document->end() || !camera->is_object())
    return fail(ErrorCode::data_corrupt, fmt::format("{}: needs the key camera, an object", file.string()));
  std::array<double, kKeys.size()> values{};
  for (std::size_t i = 0; i < kKeys.size(); ++i) {
    const auto value = reading::json_number(*camera, std::string(kKeys[i]), file);
    if (!value) return tl::unexpected(value.error());
    values[i] = *value;
  }
  reading::warn_of_unused_keys(*camera, kKeys, file, recording.warnings);
  const auto [w, h, fx_px, fy_px, cx_px, cy_px, scale] = values;
  for (const double side : {w, h}) {
    if (!(side >= 1 && side <= kMostPixels && std::floor(side) == side))
      return fail(ErrorCode::data_corrupt,
                  fmt::format("{}: w = {}, h = {} (allowed: whole numbers from 1 to {})", file.string(), w, h,
                              kMostPixels));
  }
  if (!(fx_px > 0 && fy_px > 0))
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: fx = {}, fy = {} (allowed: above 0)", file.string(), fx_px, fy_px));
  if (!calibration::is_units_per_metre(scale))
    return calibration::no_units_per_metre(ErrorCode::data_corrupt, fmt::format("{}: scale", file.string()),
                                           scale);
  calibration::RigCalibration calibration;
  calibration.color.pinhole = {static_cast<int>(w), static_cast<int>(h), fx_px, fy_px, cx_px, cy_px};
  calibration.depth_units_per_metre = scale;
  calibration.source = "cam_params.json of the recording";
  return calibration;
}

Result<void> read_truth(const fs::path& folder, double rate_hz, recording::Recording& recording) {
  const fs::path file = folder / "traj.txt";
  if (!io::is_named(file)) return reading::read_ground_truth_beside(folder, recording);
  Trajectory truth;
  const auto row = [&](const io::TextTable& table) -> Result<void> {
    std::array<double, 16> m{};
    if (auto read = table.numbers(0, m); !read) return read;
    const auto pose = calibration::rigid_transform(m);
    if (!pose)
      return table.fail_here(
          fmt::format("the pose is no rigid transform ({})", calibration::kRigidTransformRule));
    truth.push_back({reading::frame_time_ns(std::ssize(truth), rate_hz), *pose});
    return {};
  };
  if (auto read = io::for_each_row(file, kPoseColumns, row); !read) return read;
  return reading::set_ground_truth(recording, std::move(truth), file);
}

}  // namespace

bool is_replica(const fs::path& folder) {
  return io::is_named(camera_file(folder)) && reading::has_numbered_file(folder / "results", kDepth.front());
}

Result<recording::Recording> open_replica(const fs::path& folder, const recording::ReadOptions& options) {
  recording::Recording recording = recording::named_recording(folder, "replica");
  if (const auto valid = recording::check_read_options(options); !valid) return tl::unexpected(valid.error());
  const auto frames =
      reading::list_numbered({folder / "results", kColor}, {folder / "results", kDepth},
                             "results/frame<k>.jpg (or .png) and results/depth<k>.png", recording);
  if (!frames) return tl::unexpected(frames.error());
  auto calibration = recording::choose_calibration(
      folder, options, [&] { return published_calibration(folder, recording); }, recording);
  if (!calibration) return tl::unexpected(calibration.error());
  const double rate_hz = reading::frame_rate_hz(options);
  reading::add_numbered_frames(*frames, "Replica has no stamps", rate_hz, recording);
  if (const auto read = read_truth(folder, rate_hz, recording); !read) return tl::unexpected(read.error());
  if (const auto read = reading::read_imu_beside(folder, recording); !read)
    return tl::unexpected(read.error());
  return reading::with_png_images(std::move(recording), std::move(*calibration), kUnitsPerMetre);
}

}  // namespace fusebench::formats::replica
