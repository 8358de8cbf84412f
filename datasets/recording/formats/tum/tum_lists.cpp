#include "datasets/recording/formats/tum/tum_lists.hpp"

#include "core/base/io/stamped_rows.hpp"
#include "datasets/recording/sensor_columns.hpp"

namespace fusebench::formats::tum {

Result<std::vector<recording::AccelerometerSample>> read_tum_accelerometer(
    const std::filesystem::path& file, std::vector<std::string>& warnings) {
  std::vector<recording::AccelerometerSample> samples;
  const auto row = [&](const io::TextTable& table, std::int64_t time_ns) -> Result<void> {
    const auto force_mps2 = recording::read_specific_force(table, 1, "a");
    if (!force_mps2) return tl::unexpected(force_mps2.error());
    samples.push_back({time_ns, *force_mps2});
    return {};
  };
  const Result<void> done =
      io::for_each_stamped_row(file, "timestamp ax ay az ...", io::TimeOrder::increasing, row, warnings);
  if (!done) return tl::unexpected(done.error());
  return samples;
}

}  // namespace fusebench::formats::tum
