#include "datasets/eth3d_slam.hpp"

#include <fmt/format.h>

#include <array>
#include <system_error>
#include <utility>
#include <vector>

#include "core/stamped_rows.hpp"
#include "core/trajectory_file.hpp"
#include "datasets/associated_row.hpp"
#include "datasets/image_recording.hpp"
#include "datasets/side_files.hpp"

namespace fusebench {

namespace {

constexpr double kUnitsPerMetre = 5000;

/// One row of intrinsics; a second one is an error.
Result<RigCalibration> read_intrinsics(const std::filesystem::path& file) {
  auto table = TextTable::open(file, "fx fy cx cy");
  if (!table) return tl::unexpected(table.error());
  std::array<double, 4> k{};
  int rows = 0;
  while (true) {
    const Result<bool> got = table->next();
    if (!got) return tl::unexpected(got.error());
    if (!*got) break;
    if (++rows > 1) return table->fail_here("a second row; expected one row: fx fy cx cy");
    if (const auto read = table->numbers(0, k); !read) return tl::unexpected(read.error());
    if (!(k[0] > 0 && k[1] > 0 && k[2] > 0 && k[3] > 0))
      return table->fail_here("fx, fy, cx and cy must be above 0");
  }
  if (rows == 0)
    return fail(ErrorCode::data_corrupt, fmt::format("{}: has no row (expected fx fy cx cy)", file.string()));
  RigCalibration calibration;
  calibration.color.pinhole = {0, 0, k[0], k[1], k[2], k[3]};  // the size is that of the images
  calibration.source = "calibration.txt of the recording";
  return calibration;
}

Result<void> read_frames(const std::filesystem::path& folder, Recording& recording) {
  const auto take = [&](const TextTable& table, const AssociatedRow& row) -> Result<void> {
    const auto color_ns = parse_time_ns(row.color_stamp);
    if (!color_ns) return table.fail_here(color_ns.error().message, color_ns.error().hint);
    const auto depth_ns = parse_time_ns(row.depth_stamp);
    if (!depth_ns) return table.fail_here(depth_ns.error().message, depth_ns.error().hint);
    auto& frames = recording.frames;
    if (!frames.empty() && *color_ns <= frames.back().timestamp_ns) {
      return table.fail_here(fmt::format("time {} does not come after {} of the row before", row.color_stamp,
                                         stamp_text(frames.back().timestamp_ns)),
                             "sort the file by its first column, and remove rows that repeat a time");
    }
    frames.push_back({*color_ns, *depth_ns, *color_ns, *depth_ns, row.color_file, row.depth_file});
    return {};
  };
  return for_each_associated_row(folder / "associated.txt", take);
}

Result<std::vector<ImuSample>> read_imu(const std::filesystem::path& file) {
  std::vector<ImuSample> samples;
  const auto row = [&](const TextTable& table, std::int64_t time_ns) -> Result<void> {
    ImuSample sample;
    sample.timestamp_ns = time_ns;
    if (auto read = table.numbers(1, {sample.angular_velocity_radps.data(), 3}); !read) return read;
    if (auto read = table.numbers(4, {sample.specific_force_mps2.data(), 3}); !read) return read;
    samples.push_back(sample);
    return {};
  };
  const auto done = for_each_stamped_row(file, "timestamp wx wy wz ax ay az", TimeOrder::increasing, row);
  if (!done) return tl::unexpected(done.error());
  return samples;
}

/// imu.txt, else imu.csv beside.
Result<void> take_imu(const std::filesystem::path& folder, const RigCalibration& calibration,
                      Recording& recording) {
  const std::filesystem::path file = folder / "imu.txt";
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return read_imu_beside(folder, recording);
  if (!calibration.imu) {
    recording.warnings.push_back(
        fmt::format("{}: not used, since the recording does not say where its IMU sits; put a "
                    "calibration.toml with [color] "
                    "(the numbers of calibration.txt) and [imu] into the folder: T_imu_color is the inverse "
                    "of T_cam_imu in "
                    "ETH3D's camera_imu_calib_radtan.zip, for the IMU of the colour camera",
                    file.string()));
    return {};
  }
  auto samples = read_imu(file);
  if (!samples) return tl::unexpected(samples.error());
  const std::int64_t first_ns = recording.frames.front().timestamp_ns;
  const std::int64_t last_ns = recording.frames.back().timestamp_ns;
  if (samples->front().timestamp_ns > last_ns || samples->back().timestamp_ns < first_ns) {
    return fail(
        ErrorCode::data_corrupt,
        fmt::format("{}: inertial samples (times {} to {}) do not overlap the images (times {} to {})",
                    file.string(), stamp_text(samples->front().timestamp_ns),
                    stamp_text(samples->back().timestamp_ns), stamp_text(first_ns), stamp_text(last_ns)),
        "times are in seconds on the images' clock");
  }
  recording.imu = std::move(*samples);
  recording.imu_source = ImuSource::recorded;
  return {};
}

}  // namespace

Result<Recording> open_eth3d_slam(const std::filesystem::path& folder, const ReadOptions& options) {
  Recording recording = named_recording(folder, "eth3d");
  if (const auto valid = check_read_options(options); !valid) return tl::unexpected(valid.error());
  auto calibration = choose_calibration(
      folder, options, [&] { return read_intrinsics(folder / "calibration.txt"); }, recording);
  if (!calibration) return tl::unexpected(calibration.error());
  if (const auto read = read_frames(folder, recording); !read) return tl::unexpected(read.error());
  if (const auto read = read_ground_truth_beside(folder, recording); !read)
    return tl::unexpected(read.error());
  if (const auto read = take_imu(folder, *calibration, recording); !read) return tl::unexpected(read.error());
  const double units = calibration->depth_units_per_metre.value_or(kUnitsPerMetre);
  const auto attached =
      attach_images(recording, {std::move(*calibration), png_depth(units), fmt::format("png {}", units)});
  if (!attached) return tl::unexpected(attached.error());
  return recording;
}

}  // namespace fusebench
