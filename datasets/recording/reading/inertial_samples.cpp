#include "datasets/recording/reading/inertial_samples.hpp"

#include <fmt/format.h>

#include <iterator>
#include <optional>

#include "datasets/recording/reading/time_unit.hpp"
#include "datasets/recording/sensor_columns.hpp"

namespace fusebench::reading {

namespace {

// Over a longer pause (12 samples of the 250 Hz accelerometer of a ZR300) a straight line is no measurement.
constexpr std::int64_t kMaxAccelerometerGap_ns = 50'000'000;
constexpr std::string_view kGyroscopeColumns = "timestamp gx gy gz [ax ay az]";
constexpr std::string_view kAccelerometerColumns = "timestamp ax ay az";

}  // namespace

std::vector<ImuSample> interpolate_accelerometer(
    std::span<const GyroscopeSample> gyroscope,
    std::span<const recording::AccelerometerSample> accelerometer) {
  std::vector<ImuSample> samples;
  samples.reserve(gyroscope.size());
  auto after = accelerometer.begin();
  for (const GyroscopeSample& gyro : gyroscope) {
    const std::int64_t time_ns = gyro.timestamp_ns;
    while (after != accelerometer.end() && after->timestamp_ns < time_ns) ++after;
    if (after == accelerometer.end()) break;
    if (after->timestamp_ns == time_ns) {
      samples.push_back({time_ns, gyro.angular_velocity_radps, after->specific_force_mps2});
      continue;
    }
    if (after == accelerometer.begin()) continue;
    const recording::AccelerometerSample& before = *std::prev(after);
    if (after->timestamp_ns - before.timestamp_ns > kMaxAccelerometerGap_ns) continue;
    const double fraction = seconds_between(before.timestamp_ns, time_ns) /
                            seconds_between(before.timestamp_ns, after->timestamp_ns);
    samples.push_back({time_ns, gyro.angular_velocity_radps,
                       (1 - fraction) * before.specific_force_mps2 + fraction * after->specific_force_mps2});
  }
  return samples;
}

Result<void> set_imu(const std::string& source, std::span<const GyroscopeSample> gyroscope,
                     std::span<const recording::AccelerometerSample> accelerometer,
                     recording::Recording& recording) {
  recording.imu = interpolate_accelerometer(gyroscope, accelerometer);
  if (recording.imu.empty()) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: no gyroscope sample lies between two accelerometer samples", source),
                "both sensors must be of one recording and clock");
  }
  recording.imu_source = recording::ImuSource::recorded;
  const std::size_t dropped = gyroscope.size() - recording.imu.size();
  if (dropped > 0) {
    recording.warnings.push_back(
        fmt::format("{}: {} of {} gyroscope samples have no accelerometer around them and are not used",
                    source, dropped, gyroscope.size()));
  }
  return {};
}

Result<void> for_each_new_sample(const std::filesystem::path& file, std::string_view columns,
                                 recording::Recording& recording, const io::StampedRow& keep) {
  const auto unit = detect_time_unit(file, columns, kImuSpacing);
  if (!unit) return tl::unexpected(unit.error());
  recording.notes.push_back(unit->note(file.filename().string()));
  std::optional<std::int64_t> last_ns;
  std::size_t repeated = 0;
  const auto row = [&](const io::TextTable& table, std::int64_t time_ns) -> Result<void> {
    const bool again = last_ns == time_ns;
    last_ns = time_ns;
    if (again) ++repeated;
    return again ? Result<void>{} : keep(table, time_ns);
  };
  const auto done = io::for_each_stamped_row(file, columns, io::TimeOrder::not_backwards, row, unit->unit);
  if (done && repeated > 0) {
    recording.warnings.push_back(fmt::format(
        "{}: {} rows repeat the stamp of the row before and are not used", file.string(), repeated));
  }
  return done;
}

Result<GyroscopeSample> gyroscope_sample(const io::TextTable& table, std::int64_t time_ns) {
  const auto rate_radps = recording::read_angular_velocity(table, 1, "g");
  if (!rate_radps) return tl::unexpected(rate_radps.error());
  return GyroscopeSample{time_ns, *rate_radps};
}

Result<recording::AccelerometerSample> accelerometer_sample(const io::TextTable& table, std::int64_t time_ns,
                                                            std::size_t column) {
  const auto force_mps2 = recording::read_specific_force(table, column, "a");
  if (!force_mps2) return tl::unexpected(force_mps2.error());
  return recording::AccelerometerSample{time_ns, *force_mps2};
}

Result<void> read_gyroscope_and_accelerometer(const std::filesystem::path& gyroscope_file,
                                              const std::filesystem::path& accelerometer_file,
                                              recording::Recording& recording) {
  std::vector<GyroscopeSample> gyroscope;
  const auto keep_gyroscope = [&](const io::TextTable& table, std::int64_t time_ns) -> Result<void> {
    const auto sample = gyroscope_sample(table, time_ns);
    if (!sample) return tl::unexpected(sample.error());
    gyroscope.push_back(*sample);
    return {};
  };
  if (auto read = for_each_new_sample(gyroscope_file, kGyroscopeColumns, recording, keep_gyroscope); !read)
    return read;
  std::vector<recording::AccelerometerSample> accelerometer;
  const auto keep_accelerometer = [&](const io::TextTable& table, std::int64_t time_ns) -> Result<void> {
    const auto sample = accelerometer_sample(table, time_ns);
    if (!sample) return tl::unexpected(sample.error());
    accelerometer.push_back(*sample);
    return {};
  };
  if (auto read =
          for_each_new_sample(accelerometer_file, kAccelerometerColumns, recording, keep_accelerometer);
      !read)
    return read;
  recording.notes.push_back(fmt::format("{}: {} accelerometer samples are interpolated to {} gyroscope times",
                                        accelerometer_file.filename().string(), accelerometer.size(),
                                        gyroscope.size()));
  return set_imu(gyroscope_file.string(), gyroscope, accelerometer, recording);
}

}  // namespace fusebench::reading
