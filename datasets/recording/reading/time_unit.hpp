// Detects the time unit of a list from its spacing, since headers are unreliable.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/error.hpp"
#include "core/base/io/text_table.hpp"

namespace fusebench::reading {

/// Between which intervals the samples of a sensor lie. The bounds are less than a factor of 1000 apart, so
/// at most one unit fits.
struct SpacingRange {
  double least_s;
  double most_s;
};
inline constexpr SpacingRange kImageSpacing{0.005, 0.25};
inline constexpr SpacingRange kImuSpacing{0.0005, 0.05};

struct DetectedUnit {
  io::TimeUnit unit = io::TimeUnit::seconds;
  double spacing_s = 0;  ///< the median

  /// "COLOR.txt: times are in microseconds (a row every 33.3 ms)", for notes.
  [[nodiscard]] std::string note(std::string_view list) const;
};

/// The unit in which that spacing, counted in it, is plausible; nothing if there is none.
[[nodiscard]] std::optional<DetectedUnit> unit_of_spacing(double spacing, const SpacingRange& plausible);

/// The unit in which the median spacing of the first column is plausible, looking at the first 10 000 rows.
/// columns: as for TextTable. Errors: data_missing, data_corrupt (a row, fewer than two rows, a spacing that
/// is plausible in no unit).
[[nodiscard]] Result<DetectedUnit> detect_time_unit(const std::filesystem::path& file,
                                                    std::string_view columns, const SpacingRange& plausible);

}  // namespace fusebench::reading
