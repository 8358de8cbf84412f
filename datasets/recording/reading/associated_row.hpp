// Lists that name a colour and a depth image in one row: "stamp file stamp file". More columns (a pose, as
// associate.py adds with a third list) are not used.
//
// The order of the two is not a convention: TUM's associate.py and ETH3D write colour first, ICL-NUIM depth
// first. So the images' folders, else their names, decide which is which, never the column.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/io/text_table.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::reading {

/// One row. The depth image is the one whose folder's name begins with "depth" (in any case), else the one
/// with "depth" in its name.
struct AssociatedRow {
  std::string color_stamp;
  std::string depth_stamp;
  std::filesystem::path color_file;  ///< the list's folder included
  std::filesystem::path depth_file;
  bool has_more_columns = false;
};

/// Calls use for every row, up to the first error; the table is for messages. A warning counts more columns
/// than four. Errors: data_missing (the list, an image), data_corrupt (a row, both or neither image in a
/// depth folder, no row at all), those of use.
[[nodiscard]] Result<void> for_each_associated_row(
    const std::filesystem::path& list,
    const std::function<Result<void>(const io::TextTable& table, const AssociatedRow& row)>& use,
    std::vector<std::string>& warnings);

/// Adds a frame for each row, at its times in seconds. Errors: those above; data_corrupt (a time, times of
/// colour that do not rise).
[[nodiscard]] Result<void> add_associated_frames(const std::filesystem::path& list,
                                                 recording::Recording& recording);

/// The first row, to recognise a format; nothing if there is no readable one. The images need not exist.
[[nodiscard]] std::optional<AssociatedRow> first_associated_row(const std::filesystem::path& list);

}  // namespace fusebench::reading
