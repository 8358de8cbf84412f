#include "datasets/recording/formats/zr300/zr300_lists.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/io/stamped_rows.hpp"
#include "datasets/recording/reading/inertial_samples.hpp"
#include "datasets/recording/reading/time_unit.hpp"
#include "datasets/recording/sensor_columns.hpp"

namespace fusebench::formats::zr300 {

namespace fs = std::filesystem;

namespace {

// Names are cut to whole microseconds, or to 15 digits.
constexpr std::int64_t kNameTolerance_ns = 1000;

constexpr std::string_view kTimestampColumns = "timestamp color depth";
constexpr std::string_view kImageColumns = "timestamp filename";
constexpr std::string_view kGyroColumns = "timestamp gx gy gz [ax ay az]";

/// The file of column `column`, which must exist.
Result<fs::path> image_file(const io::TextTable& table, std::size_t column, const fs::path& recording,
                            std::string_view folder, bool always_there) {
  const fs::path name = table.text(column);
  if (auto inside = reading::check_stays_inside(table, name, recording); !inside)
    return tl::unexpected(inside.error());
  const fs::path file =
      always_there || !name.has_parent_path() ? recording / folder / name.filename() : recording / name;
  std::error_code ignored;
  if (fs::is_regular_file(file, ignored)) return file;
  auto missing = table.fail_here(fmt::format("image {} does not exist", file.string()),
                                 "unpack the whole recording; names are relative to its folder");
  missing.value().code = ErrorCode::data_missing;
  return missing;
}

Result<fs::path> depth_file(const io::TextTable& table, std::size_t column, const fs::path& recording,
                            bool filtered) {
  return image_file(table, column, recording, filtered ? "filtered" : "depth", filtered);
}

Result<std::vector<reading::ListedImage>> read_one_list(
    const fs::path& list, recording::Recording& recording,
    const std::function<Result<fs::path>(const io::TextTable& table)>& file_of) {
  const auto unit = reading::detect_time_unit(list, kImageColumns, reading::kImageSpacing);
  if (!unit) return tl::unexpected(unit.error());
  recording.notes.push_back(unit->note(list.filename().string()));
  std::vector<reading::ListedImage> images;
  const auto row = [&](const io::TextTable& table, std::int64_t time_ns) -> Result<void> {
    auto file = file_of(table);
    if (!file) return tl::unexpected(file.error());
    images.push_back({time_ns, std::move(*file)});
    return {};
  };
  const auto done = io::for_each_stamped_row(list, kImageColumns, io::TimeOrder::increasing, row, unit->unit);
  if (!done) return tl::unexpected(done.error());
  return images;
}

/// The time in an image's name ("772307.png"), if it is one.
std::optional<std::int64_t> time_in_name(const fs::path& file, io::TimeUnit unit) {
  const auto time_ns = io::parse_time_ns(file.stem().string(), unit);
  return time_ns ? std::optional<std::int64_t>(*time_ns) : std::nullopt;
}

/// Rows that repeat a depth image give it once.
void drop_repeated(std::vector<reading::ListedImage>& images) {
  const auto same = [](const reading::ListedImage& a, const reading::ListedImage& b) {
    return a.file == b.file;
  };
  images.erase(std::unique(images.begin(), images.end(), same), images.end());
}

/// Gives depth images the times in their names if all names are times.
Result<void> take_depth_times(const fs::path& list, io::TimeUnit unit, Zr300Images& images,
                              recording::Recording& recording) {
  std::vector<std::int64_t> depth_ns;
  for (std::size_t i = 0; i < images.color.size(); ++i) {
    const auto color = time_in_name(images.color[i].file, unit);
    const auto depth = time_in_name(images.depth[i].file, unit);
    if (!color || !depth || std::abs(*color - images.color[i].timestamp_ns) > kNameTolerance_ns) return {};
    depth_ns.push_back(*depth);
  }
  std::size_t differ = 0;
  for (std::size_t i = 0; i < depth_ns.size(); ++i) {
    if (i > 0 && depth_ns[i] <= depth_ns[i - 1] && images.depth[i].file != images.depth[i - 1].file) {
      return fail(ErrorCode::data_corrupt,
                  fmt::format("{}: depth image {} is not later than {} of the row before, by their names",
                              list.string(), images.depth[i].file.filename().string(),
                              images.depth[i - 1].file.filename().string()),
                  "sort the file by time");
    }
    if (std::abs(depth_ns[i] - images.color[i].timestamp_ns) > kNameTolerance_ns) ++differ;
    images.depth[i].timestamp_ns = depth_ns[i];
  }
  if (differ > 0) {
    recording.notes.push_back(fmt::format("{}: {} of {} depth images have a time of their own in their names",
                                          list.filename().string(), differ, depth_ns.size()));
  }
  return {};
}

}  // namespace

Result<Zr300Images> read_zr300_timestamps(const fs::path& folder, bool filtered,
                                          recording::Recording& recording) {
  const fs::path list = folder / "TIMESTAMP.txt";
  const auto unit = reading::detect_time_unit(list, kTimestampColumns, reading::kImageSpacing);
  if (!unit) return tl::unexpected(unit.error());
  recording.notes.push_back(unit->note("TIMESTAMP.txt"));
  Zr300Images images;
  const auto row = [&](const io::TextTable& table, std::int64_t time_ns) -> Result<void> {
    auto color = image_file(table, 1, folder, "color", false);
    if (!color) return tl::unexpected(color.error());
    auto depth = depth_file(table, 2, folder, filtered);
    if (!depth) return tl::unexpected(depth.error());
    images.color.push_back({time_ns, std::move(*color)});
    images.depth.push_back({time_ns, std::move(*depth)});
    return {};
  };
  const auto done =
      io::for_each_stamped_row(list, kTimestampColumns, io::TimeOrder::increasing, row, unit->unit);
  if (!done) return tl::unexpected(done.error());
  if (const auto taken = take_depth_times(list, unit->unit, images, recording); !taken)
    return tl::unexpected(taken.error());
  drop_repeated(images.depth);
  return images;
}

Result<Zr300Images> read_zr300_image_lists(const fs::path& folder, bool filtered,
                                           recording::Recording& recording) {
  auto color = read_one_list(folder / "COLOR.txt", recording, [&](const io::TextTable& table) {
    return image_file(table, 1, folder, "color", false);
  });
  if (!color) return tl::unexpected(color.error());
  auto depth = read_one_list(folder / "DEPTH.txt", recording, [&](const io::TextTable& table) {
    return depth_file(table, 1, folder, filtered);
  });
  if (!depth) return tl::unexpected(depth.error());
  return Zr300Images{std::move(*color), std::move(*depth)};
}

Result<void> read_zr300_imu(const fs::path& folder, recording::Recording& recording) {
  const fs::path file = folder / "IMU.txt";
  std::vector<reading::GyroscopeSample> gyroscope;
  std::vector<recording::AccelerometerSample> accelerometer;
  const auto keep = [&](const io::TextTable& table, std::int64_t time_ns) -> Result<void> {
    const auto gyro = reading::gyroscope_sample(table, time_ns);
    if (!gyro) return tl::unexpected(gyro.error());
    gyroscope.push_back(*gyro);
    if (!table.has(4)) return {};
    const auto accel = reading::accelerometer_sample(table, time_ns, 4);
    if (!accel) return tl::unexpected(accel.error());
    accelerometer.push_back(*accel);
    return {};
  };
  if (const auto read = reading::for_each_new_sample(file, kGyroColumns, recording, keep); !read) return read;
  if (const std::size_t rows = gyroscope.size(), whole = accelerometer.size(); whole < rows) {
    recording.notes.push_back(fmt::format(
        "IMU.txt: {} of {} rows have no accelerometer, which is interpolated", rows - whole, rows));
  }
  return reading::set_imu(file.string(), gyroscope, accelerometer, recording);
}

Result<void> read_zr300_gyro_and_accel(const fs::path& folder, recording::Recording& recording) {
  return reading::read_gyroscope_and_accelerometer(folder / "GYRO.txt", folder / "ACCEL.txt", recording);
}

}  // namespace fusebench::formats::zr300
