// Lists of images with their times, as TUM, EuRoC, OpenLORIS and others write them: "time name".
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/io/text_table.hpp"

namespace fusebench::reading {

/// A name in the table's current row, relative to the folder of the recording, does not lead out of it: what
/// a recording from a stranger can have read is its own. Links are followed, wherever they lead. Error
/// data_corrupt.
[[nodiscard]] Result<void> check_stays_inside(const io::TextTable& table, const std::filesystem::path& name,
                                              const std::filesystem::path& recording);

struct ListedImage {
  std::int64_t timestamp_ns = 0;
  std::filesystem::path file;
};

/// "timestamp filename" in strictly increasing time; names are relative to `images`. A warning counts more
/// columns than these two. Errors name file:line: data_missing (the list or an image), data_corrupt (a row,
/// the order in time, an empty list).
[[nodiscard]] Result<std::vector<ListedImage>> read_image_list(const std::filesystem::path& list,
                                                               const std::filesystem::path& images,
                                                               io::TimeUnit unit,
                                                               std::vector<std::string>& warnings);

/// The same with names relative to the list's folder, in seconds. Stamps that can only be milli-, micro- or
/// nanoseconds since 1970 (io::unit_by_size()) are read as such, with a warning.
[[nodiscard]] Result<std::vector<ListedImage>> read_image_list(const std::filesystem::path& list,
                                                               std::vector<std::string>& warnings);

}  // namespace fusebench::reading
