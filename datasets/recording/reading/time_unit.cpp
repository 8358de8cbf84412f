#include "datasets/recording/reading/time_unit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/upper_median.hpp"

namespace fusebench::reading {

namespace {

constexpr std::size_t kMaxRows = 10'000;
constexpr std::array kUnits = {io::TimeUnit::seconds, io::TimeUnit::milliseconds, io::TimeUnit::microseconds,
                               io::TimeUnit::nanoseconds};

/// The stamps as written. A double resolves nanoseconds since 1970 to 256 ns, enough for a spacing.
Result<std::vector<double>> raw_stamps(const std::filesystem::path& file, std::string_view columns) {
  Result<io::TextTable> table = io::TextTable::open(file, columns);
  if (!table) return tl::unexpected(table.error());
  std::vector<double> stamps;
  while (stamps.size() < kMaxRows) {
    const Result<bool> got = table->next();
    if (!got) return tl::unexpected(got.error());
    if (!*got) break;
    const Result<double> stamp = table->number(0);
    if (!stamp) return tl::unexpected(stamp.error());
    stamps.push_back(*stamp);
  }
  return stamps;
}

double median_spacing(const std::vector<double>& stamps) {
  std::vector<double> spacings;
  for (std::size_t i = 1; i < stamps.size(); ++i) spacings.push_back(stamps[i] - stamps[i - 1]);
  return upper_median(std::move(spacings));
}

}  // namespace

std::string DetectedUnit::note(std::string_view list) const {
  return fmt::format("{}: times are in {} (a row every {:.3g} ms)", list, io::to_string(unit),
                     1e3 * spacing_s);
}

std::optional<DetectedUnit> unit_of_spacing(double spacing, const SpacingRange& plausible) {
  for (const io::TimeUnit unit : kUnits) {
    const double spacing_s =
        spacing * std::pow(10.0, static_cast<int>(unit) - static_cast<int>(io::TimeUnit::seconds));
    if (spacing_s >= plausible.least_s && spacing_s <= plausible.most_s) return DetectedUnit{unit, spacing_s};
  }
  return std::nullopt;
}

Result<DetectedUnit> detect_time_unit(const std::filesystem::path& file, std::string_view columns,
                                      const SpacingRange& plausible) {
  const auto stamps = raw_stamps(file, columns);
  if (!stamps) return tl::unexpected(stamps.error());
  if (stamps->size() < 2) {
    return fail(ErrorCode::data_corrupt, fmt::format("{}: has {} rows, too few to tell the unit of its times",
                                                     file.string(), stamps->size()));
  }
  const double spacing = median_spacing(*stamps);
  if (const auto unit = unit_of_spacing(spacing, plausible)) return *unit;
  return fail(ErrorCode::data_corrupt,
              fmt::format("{}: rows are {} apart in time (median), which is {} to {} ms in none of the units "
                          "s, ms, us, ns",
                          file.string(), spacing, 1e3 * plausible.least_s, 1e3 * plausible.most_s),
              "the first column must be the time of each sample");
}

}  // namespace fusebench::reading
