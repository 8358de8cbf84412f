// Recordings that are one file.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace fusebench::reading {

/// `place` itself, if it is a file whose name ends with `ending` (".sens"), or the one file of the folder
/// `place` that does; nothing if there is none or more than one.
[[nodiscard]] std::optional<std::filesystem::path> file_with_ending(const std::filesystem::path& place,
                                                                    std::string_view ending);

}  // namespace fusebench::reading
