#include "datasets/recording/formats/eth3d/eth3d_slam.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/io/input_file.hpp"
#include "core/base/io/stamped_rows.hpp"
#include "datasets/recording/reading/associated_row.hpp"
#include "datasets/recording/reading/image_recording.hpp"
#include "datasets/recording/reading/side_files.hpp"

namespace fusebench::formats::eth3d {

namespace {

constexpr double kUnitsPerMetre = 5000;
constexpr double kMax_px = 1e6;

/// One row of intrinsics; a second one is an error.
Result<calibration::RigCalibration> read_intrinsics(const std::filesystem::path& file) {
  auto table = io::TextTable::open(file, "fx fy cx cy");
  if (!table) return tl::unexpected(table.error());
  std::array<double, 4> k{};
  int rows = 0;
  while (true) {
    const Result<bool> got = table->next();
    if (!got) return tl::unexpected(got.error());
    if (!*got) break;
    if (++rows > 1) return table->fail_here("a second row; expected one row: fx fy cx cy");
    if (const auto read = table->numbers(0, k); !read) return tl::unexpected(read.error());
    if (!std::ranges::all_of(k, [](double value) { return value > 0 && value <= kMax_px; }))
      return table->fail_here(
          fmt::format("fx, fy, cx and cy must be above 0 and at most {:g} pixels", kMax_px));
  }
  if (rows == 0)
    return fail(ErrorCode::data_corrupt, fmt::format("{}: has no row (expected fx fy cx cy)", file.string()));
  calibration::RigCalibration calibration;
  calibration.color.pinhole = {0, 0, k[0], k[1], k[2], k[3]};  // the size is that of the images
  calibration.source = "calibration.txt of the recording";
  return calibration;
}

/// imu.txt, else imu.csv beside.
Result<void> take_imu(const std::filesystem::path& folder, const calibration::RigCalibration& calibration,
                      recording::Recording& recording) {
  const std::filesystem::path file = folder / "imu.txt";
  if (!io::is_named(file)) return reading::read_imu_beside(folder, recording);
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
  auto samples = reading::read_imu_table(file, io::TimeUnit::seconds);
  if (!samples) return tl::unexpected(samples.error());
  recording.imu = std::move(*samples);
  recording.imu_source = recording::ImuSource::recorded;
  return {};
}

}  // namespace

Result<recording::Recording> open_eth3d_slam(const std::filesystem::path& folder,
                                             const recording::ReadOptions& options) {
  recording::Recording recording = recording::named_recording(folder, "eth3d");
  if (const auto valid = recording::check_read_options(options); !valid) return tl::unexpected(valid.error());
  auto calibration = recording::choose_calibration(
      folder, options, [&] { return read_intrinsics(folder / "calibration.txt"); }, recording);
  if (!calibration) return tl::unexpected(calibration.error());
  if (const auto read = reading::add_associated_frames(folder / "associated.txt", recording); !read)
    return tl::unexpected(read.error());
  if (const auto read = reading::read_ground_truth_beside(folder, recording); !read)
    return tl::unexpected(read.error());
  if (const auto read = take_imu(folder, *calibration, recording); !read) return tl::unexpected(read.error());
  return reading::with_png_images(std::move(recording), std::move(*calibration), kUnitsPerMetre);
}

}  // namespace fusebench::formats::eth3d
