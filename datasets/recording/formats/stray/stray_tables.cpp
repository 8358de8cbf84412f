#include "datasets/recording/formats/stray/stray_tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/io/bounded_text.hpp"
#include "core/base/io/input_file.hpp"
#include "core/base/io/row_text.hpp"
#include "core/base/io/text_table.hpp"
#include "core/base/printable.hpp"
#include "core/base/upper_median.hpp"
#include "datasets/recording/reading/numbered_frames.hpp"
#include "datasets/recording/sensor_columns.hpp"

namespace fusebench::formats::stray {

namespace {

constexpr double kStandardGravity_mps2 = 9.80665;

/// Calls use for each row after the line of names, whose first columns must be `columns`; the rest of the
/// names goes to `others`.
Result<void> for_each_row(const std::filesystem::path& file, std::span<const std::string_view> columns,
                          std::vector<std::string>& others,
                          const std::function<Result<void>(const io::TextTable&)>& use) {
  std::ifstream stream = io::input_file(file);
  std::string first;
  static_cast<void>(io::next_line(stream, first));
  const std::vector<std::string> names = io::column_names(first);
  auto table = io::TextTable::open(file, names.empty() ? "timestamp" : io::as_columns(names));
  if (!table) return tl::unexpected(table.error());
  table->leave_out_line(1);
  if (names.size() < columns.size() || !std::ranges::equal(columns, std::span(names).first(columns.size())))
    return fail(ErrorCode::data_corrupt, fmt::format("{}:1: expected the line of names that begins with: {}",
                                                     file.string(), fmt::join(columns, ", ")));
  others.assign(names.begin() + std::ssize(columns), names.end());
  std::size_t rows = 0;
  for (; true; ++rows) {
    const auto got = table->next();
    if (!got) return tl::unexpected(got.error());
    if (!*got) break;
    if (auto used = use(*table); !used) return used;
  }
  if (rows > 0) return {};
  return fail(ErrorCode::data_corrupt, fmt::format("{}: has no rows", file.string()));
}

/// What the accelerations have to be multiplied by; nothing if gravity is not in them.
std::optional<double> specific_force_per_unit(const std::vector<ImuSample>& samples) {
  std::vector<double> lengths;
  for (const ImuSample& sample : samples) lengths.push_back(sample.specific_force_mps2.norm());
  const double median = upper_median(std::move(lengths));
  if (median > 0.8 && median < 1.25) return -kStandardGravity_mps2;
  if (median > 0.8 * kStandardGravity_mps2 && median < 1.25 * kStandardGravity_mps2) return -1.0;
  return std::nullopt;
}

constexpr std::array<std::string_view, 4> kIntrinsics = {"fx", "fy", "cx", "cy"};

/// Columns of odometry.csv behind those that every version of the app writes.
class OtherColumns {
 public:
  /// names, which are filled before the first row: of the columns from `first` on.
  OtherColumns(const std::vector<std::string>& names, std::size_t first) : names_(names), first_(first) {}

  /// Intrinsics of the row; nothing if it has none.
  Result<std::optional<PinholeCamera>> read(const io::TextTable& table) {
    note_unused(table);
    std::array<double, kIntrinsics.size()> k{};
    for (std::size_t i = 0; i < k.size(); ++i) {
      const auto found = std::ranges::find(names_, kIntrinsics[i]);
      const std::size_t column = first_ + static_cast<std::size_t>(found - names_.begin());
      if (found == names_.end() || !has_value(table, column)) return std::optional<PinholeCamera>();
      if (const auto read = table.numbers(column, std::span(&k[i], 1)); !read)
        return tl::unexpected(read.error());
    }
    if (!(k[0] > 0 && k[1] > 0)) return table.fail_here("focal lengths fx and fy must be above 0");
    return std::optional(PinholeCamera{0, 0, k[0], k[1], k[2], k[3]});
  }

  [[nodiscard]] const std::set<std::string>& unused() const { return unused_; }

 private:
  static bool has_value(const io::TextTable& table, std::size_t column) {
    return table.has(column) && !table.text(column).empty();
  }
  void note_unused(const io::TextTable& table) {
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (std::ranges::find(kIntrinsics, names_[i]) == kIntrinsics.end() && has_value(table, first_ + i))
        unused_.insert(names_[i]);
    }
  }

  const std::vector<std::string>& names_;
  std::size_t first_;
  std::set<std::string> unused_;
};

}  // namespace

Result<std::vector<StrayFrame>> read_stray_odometry(const std::filesystem::path& file,
                                                    std::vector<std::string>& warnings) {
  constexpr std::array<std::string_view, 9> kColumns = {"timestamp", "frame", "x",  "y", "z",
                                                        "qx",        "qy",    "qz", "qw"};
  std::vector<std::string> others;
  OtherColumns other_columns(others, kColumns.size());
  std::vector<StrayFrame> frames;
  const auto row = [&](const io::TextTable& table) -> Result<void> {
    const auto time_ns = table.time_ns(0);
    if (!time_ns) return tl::unexpected(time_ns.error());
    const auto index = reading::frame_number(table.text(1));
    if (!index)
      return table.fail_here(fmt::format("expected the number of a frame, got '{}'", table.text(1)));
    if (!frames.empty() && (*time_ns <= frames.back().timestamp_ns || *index <= frames.back().index))
      return table.fail_here("times and numbers of frames must both rise from row to row");
    const auto position_m = recording::read_position(table, 2, "");
    if (!position_m) return tl::unexpected(position_m.error());
    std::array<double, 4> q{};
    if (auto read = table.numbers(5, q); !read) return read;
    const Quaterniond rotation(q[3], q[0], q[1], q[2]);
    if (!(rotation.norm() > 0.5 && rotation.norm() < 2))
      return table.fail_here("the quaternion (qx, qy, qz, qw) is not of unit length");
    const auto camera = other_columns.read(table);
    if (!camera) return tl::unexpected(camera.error());
    frames.push_back({*index, *time_ns, {rotation.normalized(), *position_m}, *camera});
    return {};
  };
  if (const auto read = for_each_row(file, kColumns, others, row); !read) return tl::unexpected(read.error());
  if (!other_columns.unused().empty())
    warnings.push_back(
        fmt::format("{}: columns {} are not used", file.string(),
                    printable(fmt::format("{}", fmt::join(other_columns.unused(), ", ")), 200)));
  return frames;
}

Result<void> read_stray_imu(const std::filesystem::path& file, recording::Recording& recording) {
  constexpr std::array<std::string_view, 7> kColumns = {"timestamp", "a_x",     "a_y",    "a_z",
                                                        "alpha_x",   "alpha_y", "alpha_z"};
  std::vector<ImuSample> samples;
  const auto row = [&](const io::TextTable& table) -> Result<void> {
    const auto time_ns = table.time_ns(0);
    if (!time_ns) return tl::unexpected(time_ns.error());
    if (!samples.empty() && *time_ns < samples.back().timestamp_ns)
      return table.fail_here("time runs backwards");
    if (!samples.empty() && *time_ns == samples.back().timestamp_ns) return {};
    const auto acceleration = recording::read_specific_force(table, 1, "a");
    if (!acceleration) return tl::unexpected(acceleration.error());
    const auto rate_radps = recording::read_angular_velocity(table, 4, "alpha");
    if (!rate_radps) return tl::unexpected(rate_radps.error());
    samples.push_back({*time_ns, *rate_radps, *acceleration});
    return {};
  };
  std::vector<std::string> others;
  if (auto read = for_each_row(file, kColumns, others, row); !read) return read;
  if (!others.empty())
    recording.warnings.push_back(fmt::format("{}: columns {} are not used", file.string(),
                                             printable(fmt::format("{}", fmt::join(others, ", ")), 200)));
  const auto factor = specific_force_per_unit(samples);
  if (!factor) {
    recording.warnings.push_back(
        fmt::format("{}: not used: the accelerations have neither the length of gravity in g nor in m/s^2",
                    file.string()));
    return {};
  }
  for (ImuSample& sample : samples) sample.specific_force_mps2 *= *factor;
  recording.notes.push_back(fmt::format("imu.csv: accelerations are in {}, with Core Motion's sign",
                                        *factor == -1.0 ? "m/s^2" : "g"));
  recording.imu = std::move(samples);
  recording.imu_source = recording::ImuSource::recorded;
  return {};
}

}  // namespace fusebench::formats::stray
