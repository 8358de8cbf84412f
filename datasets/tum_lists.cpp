#include "datasets/tum_lists.hpp"

#include <fmt/format.h>

#include <cmath>
#include <system_error>

#include "datasets/text_table.hpp"

namespace fusebench {

namespace {

/// Reads the time in column 0 of each row and demands that it increases.
class IncreasingTime {
 public:
  Result<std::int64_t> next(const TextTable& table) {
    const Result<std::int64_t> time_ns = table.time_ns(0);
    if (!time_ns) return time_ns;
    if (line_ > 0 && *time_ns == time_ns_) {
      return table.fail_here(fmt::format("timestamp {} is the same as that of line {}", table.text(0), line_),
                             "remove one of the two rows");
    }
    if (line_ > 0 && *time_ns < time_ns_) {
      return table.fail_here(fmt::format("time runs backwards by {} s (timestamp {} after line {})",
                                         seconds_between(*time_ns, time_ns_), table.text(0), line_),
                             "sort the file by its first column, or find out why the clock jumped");
    }
    time_ns_ = *time_ns;
    line_ = table.line();
    return time_ns;
  }

 private:
  std::int64_t time_ns_ = 0;
  int line_ = 0;
};

template <int kCount>
Result<Eigen::Matrix<double, kCount, 1>> numbers(const TextTable& table, std::size_t first_column) {
  Eigen::Matrix<double, kCount, 1> values;
  for (int i = 0; i < kCount; ++i) {
    const Result<double> value = table.number(first_column + static_cast<std::size_t>(i));
    if (!value) return tl::unexpected(value.error());
    values[i] = *value;
  }
  return values;
}

/// Calls row(table, time) for every row.
template <class Row>
Result<void> for_each_row(const std::filesystem::path& file, std::string_view columns, const Row& row) {
  Result<TextTable> table = TextTable::open(file, columns);
  if (!table) return tl::unexpected(table.error());
  IncreasingTime clock;
  std::size_t rows = 0;
  while (true) {
    const Result<bool> got = table->next();
    if (!got) return tl::unexpected(got.error());
    if (!*got) break;
    const Result<std::int64_t> time_ns = clock.next(*table);
    if (!time_ns) return tl::unexpected(time_ns.error());
    const Result<void> done = row(*table, *time_ns);
    if (!done) return done;
    ++rows;
  }
  if (rows > 0) return {};
  return fail(ErrorCode::data_corrupt, fmt::format("{}: has no rows (expected {})", file.string(), columns));
}

}  // namespace

Result<std::vector<ListedImage>> read_image_list(const std::filesystem::path& list) {
  std::vector<ListedImage> images;
  const auto row = [&](const TextTable& table, std::int64_t time_ns) -> Result<void> {
    const std::filesystem::path file = list.parent_path() / table.text(1);
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) {
      return fail(ErrorCode::data_missing,
                  fmt::format("{}:{}: image {} does not exist", list.string(), table.line(), file.string()),
                  "unpack the whole recording; names are relative to the list's folder");
    }
    images.push_back({time_ns, file});
    return {};
  };
  const Result<void> done = for_each_row(list, "timestamp filename", row);
  if (!done) return tl::unexpected(done.error());
  return images;
}

Result<Trajectory> read_tum_trajectory(const std::filesystem::path& file,
                                       std::vector<std::string>& warnings) {
  constexpr double kSmallestNorm = 1e-3;     // below it there is no direction left in four printed decimals
  constexpr double kToleratedExcess = 0.01;  // far above what rounding to four decimals does
  Trajectory trajectory;
  std::size_t not_unit = 0;
  int first_line = 0;
  const auto row = [&](const TextTable& table, std::int64_t time_ns) -> Result<void> {
    const auto v = numbers<7>(table, 1);
    if (!v) return tl::unexpected(v.error());
    const Quaterniond rotation((*v)[6], (*v)[3], (*v)[4], (*v)[5]);
    const double norm = rotation.norm();
    if (!(norm > kSmallestNorm && std::isfinite(norm))) {
      return table.fail_here(fmt::format("quaternion qx qy qz qw has norm {:g} (expected 1)", norm));
    }
    if (std::abs(norm - 1.0) > kToleratedExcess && not_unit++ == 0) first_line = table.line();
    trajectory.push_back({time_ns, {rotation.normalized(), v->head<3>()}});
    return {};
  };
  const Result<void> done = for_each_row(file, "timestamp tx ty tz qx qy qz qw", row);
  if (!done) return tl::unexpected(done.error());
  if (not_unit > 0) {
    warnings.push_back(
        fmt::format("{}:{}: {} of {} quaternions are off unit length by more than 1 % (normalised)",
                    file.string(), first_line, not_unit, trajectory.size()));
  }
  return trajectory;
}

Result<std::vector<AccelerometerSample>> read_tum_accelerometer(const std::filesystem::path& file) {
  std::vector<AccelerometerSample> samples;
  const auto row = [&](const TextTable& table, std::int64_t time_ns) -> Result<void> {
    const auto v = numbers<3>(table, 1);
    if (!v) return tl::unexpected(v.error());
    samples.push_back({time_ns, *v});
    return {};
  };
  const Result<void> done = for_each_row(file, "timestamp ax ay az", row);
  if (!done) return tl::unexpected(done.error());
  return samples;
}

}  // namespace fusebench
