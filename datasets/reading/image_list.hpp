// Lists of images with their times, as TUM, EuRoC, OpenLORIS and others write them: "time name".
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/base/error.hpp"
#include "core/io/text_table.hpp"

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

/// "timestamp filename" in strictly increasing time; names are relative to `images`. Errors name file:line:
/// data_missing (the list or an image), data_corrupt (a row, the order in time, an empty list).
[[nodiscard]] Result<std::vector<ListedImage>> read_image_list(const std::filesystem::path& list,
                                                               const std::filesystem::path& images,
                                                               io::TimeUnit unit = io::TimeUnit::seconds);

/// The same, in seconds, with names relative to the list's folder.
[[nodiscard]] Result<std::vector<ListedImage>> read_image_list(const std::filesystem::path& list);

}  // namespace fusebench::reading
