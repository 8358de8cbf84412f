// Lists whose first column is a stamp, like the rgb.txt of a TUM recording.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.hpp"

namespace fusebench::trajectory_files {

/// The stamps of a list "timestamp filename", which counts seconds, to nanoseconds. Stamps that can only be
/// milli-, micro- or nanoseconds since 1970 are read as such, with a warning. Errors: data_missing,
/// data_corrupt (a row that is none, time that does not increase, no rows).
[[nodiscard]] Result<std::vector<std::int64_t>> read_stamps(const std::filesystem::path& file,
                                                            std::vector<std::string>& warnings);

}  // namespace fusebench::trajectory_files
