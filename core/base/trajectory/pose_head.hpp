// What the beginning of a file of poses says about its columns and its stamps.
#pragma once

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/io/text_table.hpp"
#include "core/base/trajectory/pose_columns.hpp"

namespace fusebench::trajectory {

struct HeadRow {
  int line = 0;
  std::vector<std::string> fields;
  bool commas = false;

  /// NaN of what is no number.
  [[nodiscard]] double number(std::size_t column) const;
  [[nodiscard]] double norm(std::size_t first, std::size_t count) const;
};

/// Of a row or column of a rotation, or a quaternion, as printed.
[[nodiscard]] inline bool is_unit(double norm) { return std::abs(norm - 1) < 1e-2; }

struct PoseHead {
  /// By the last line of names before the rows that names a stamp and all of a pose.
  std::optional<NamedColumns> named = {};
  std::vector<std::string> names = {};
  int names_line = 0;
  bool names_are_comment = true;   ///< the line begins with '#'
  std::vector<HeadRow> rows = {};  ///< the first ones; none of a file that cannot be read as text

  [[nodiscard]] std::size_t columns() const { return rows.empty() ? 0 : rows.front().fields.size(); }
  /// Every row has a number as its stamp and a quaternion of unit length there, or is of a lost frame.
  [[nodiscard]] bool fits(const PoseColumns& columns) const;
  /// Without names: whole seconds, several rows within one, and nanoseconds that rise there.
  [[nodiscard]] bool has_split_stamps() const;
  [[nodiscard]] bool commas() const { return !rows.empty() && rows.front().commas; }
};

/// Reads up to 20 rows and the lines before them. A comment that does not name all of a pose, or has another
/// number of names than the first row has columns (a warning), is a comment; after a stamp as the first name,
/// rows may have more columns than are named. A file that cannot be opened, has no rows or is no text gives
/// no rows: readers of its rows report that.
///
/// Errors data_corrupt name file:line: a first line of names without '#' that does not name all of a pose, or
/// not each column; numbers with a decimal comma.
[[nodiscard]] Result<PoseHead> read_pose_head(const std::filesystem::path& file,
                                              std::vector<std::string>& warnings);

/// What is given about the unit of stamps, apart from names in the file.
struct GivenUnit {
  std::optional<io::TimeUnit> unit = {};
  bool of_this_file = false;               ///< and not of several files, of which some may count in seconds
  std::optional<io::TimeUnit> usual = {};  ///< of the format; else by the size of the first stamp
};

/// The unit of the stamps in a column: the named one, else the given one, else the usual one, else by size. A
/// unit in which the stamps cannot be (io::can_be_in(); of a unit given for several files: stamps with
/// decimals, unless their size is of that unit) is not used, but one that is given for this very file.
/// Warnings say which named or given unit was not used, and what was found by size unless it is the second.
[[nodiscard]] io::TimeUnit stamp_unit_of(const PoseHead& head, const PoseColumns& columns,
                                         const GivenUnit& given, const std::filesystem::path& file,
                                         std::vector<std::string>& warnings);

}  // namespace fusebench::trajectory
